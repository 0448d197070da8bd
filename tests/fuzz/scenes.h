#pragma once
#include "host/scene.h"

namespace wale::fuzz {

/// The folder that file names in fuzzed scenes are relative to: a few small files.
std::filesystem::path scene_folder();

/// Every number of the scene is finite, every index names what it should, and its materials can be made.
void expect_consistent(const Scene& scene);
void expect_consistent(const MaterialSpec& material);

}  // namespace wale::fuzz
