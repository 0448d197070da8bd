#pragma once
// The program itself, run as a user would, for what only a fresh process can show: thread counts and other drivers.
#include <filesystem>
#include <string>
#include <vector>

#include "host/image.h"

namespace wale::test {

/// A small scene with everything that a picture may depend on: plies that let light through, a ground, a sphere light
/// and an environment. `size` pixels a side, `wales` per 10 cm.
std::string everything_scene(int size, double wales);

/// Runs the program with further environment variables ("NAME=value"); what it prints goes to `log`. Returns its exit
/// status.
int run_program(const std::vector<std::string>& environment, const std::vector<std::string>& arguments,
                const std::filesystem::path& log);

/// Pixels in which any channel differs in any bit; all of them when the pictures do not have the same shape.
size_t different_pixels(const Image& a, const Image& b);

}  // namespace wale::test
