#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/scene.h"

namespace wale::fit {

/// Files that a scene reads at its frame: tiles, meshes, images of colours and of lights. Of a sequence those of the
/// frames that the shutter sees and of the rest, there or not.
std::vector<std::filesystem::path> files_of(const Scene& scene);

/// What scene_identity() leaves out of its document and no file of files_of() says: levels of the accuracy options,
/// of every fabric by itself, and what plies are made of, with the materials' files joined.
std::string model_words(const Scene& scene);

/// Hash of a file's size and bytes behind what gave `seed`; one that is not there counts as empty.
uint64_t hash_file(const std::filesystem::path& file, uint64_t seed);

}  // namespace wale::fit
