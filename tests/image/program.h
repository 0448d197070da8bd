#pragma once
// For tests that run the program itself: what only a fresh process can show, thread counts and other drivers.
#include <filesystem>
#include <string>

#include "host/image.h"

namespace wale::test {

/// A small scene with everything that a picture may depend on: plies that let light through, a ground, a sphere light
/// and an environment. `size` pixels a side, `wales` per 10 cm.
std::string everything_scene(int size, double wales);

/// Oclgrind's driver: a simulator that shares no code with PoCL and runs on any machine. Empty when not installed.
std::filesystem::path oclgrind();

/// Pixels in which any channel differs in any bit; all of them when the pictures do not have the same shape.
size_t different_pixels(const Image& a, const Image& b);

/// A picture read back with the means and their variances first, as they leave the film; a file's order is its own.
Image means_and_variances(const std::filesystem::path& file);

}  // namespace wale::test
