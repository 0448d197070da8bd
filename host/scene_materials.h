#pragma once
#include <filesystem>
#include <string>

#include "host/json_document.h"
#include "host/scene.h"

namespace wale {

/// Before the schema is checked: where a ply material names a "file", the keys of that file (relative to `folder`) join
/// the material's own, which go before them, also where they exclude one of the file's. Throws a user error when a
/// file is no material, or names a file in turn; a file that does not exist is left for the schema to report.
void join_material_files(JsonNode& scene, const std::filesystem::path& folder);

/// The same for one material and the document of its file.
void join_material(const std::string& name, JsonNode& node, JsonNode base);

/// A checked node of the scene's "materials".
MaterialSpec material_of(const std::string& name, const JsonNode& node);

/// Number of the material that `user` names, which must be a ply material or one of surfaces; without a name, of the
/// default of that sort, which is made once. `path` of the user, for its errors.
int find_material(Scene& scene, const JsonNode& user, const std::string& path, bool ply);

}  // namespace wale
