#pragma once
#include <filesystem>

#include "host/file_fence.h"
#include "host/json_document.h"
#include "host/scene.h"

// Files and generators that a checked document names.
namespace wale {

/// When a scene is looked at, the folder that its files are relative to, and which of them it may name.
struct SceneMoment {
  double frame;
  std::filesystem::path folder;
  FileFence* fence;  ///< null: any
};

/// Throws the user error of a sequence that cannot be one, or lies outside of the fence.
MeshSource mesh_of(const JsonNode& node, const SceneMoment& moment);
PatternSource pattern_of(const JsonNode& node);
Transform transform_of(const JsonNode& node);

}  // namespace wale
