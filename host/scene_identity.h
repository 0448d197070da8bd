#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace wale {

struct Scene;

/// Names of attributes of a rendered EXR: which scene it shows, and at which level of every accuracy option.
constexpr const char* kSceneAttribute = "wale:scene";
constexpr const char* kAccuracyAttribute = "wale:accuracy";

/// Sixteen hexadecimal digits that are equal for scene files which show the same: of the document with its overrides,
/// without what accuracy options set, size, samples, seed, view and what serves speed alone. Files that it names count
/// by their names.
std::string scene_identity(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// "local_stage exact, curves 0.05, ...": its level of every accuracy option.
std::string accuracy_settings(const Scene& scene);

}  // namespace wale
