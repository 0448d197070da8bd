#pragma once
// Small scenes about a cloth, for the hard cases.
#include <filesystem>

#include "geom/base_mesh.h"
#include "tests/image/picture.h"

namespace wale::test {

/// A new name in a folder that goes when the program ends.
std::filesystem::path fixture_file(const std::string& suffix);

/// Adds a fabric of stockinette, stitches 2 mm wide, on a mesh that is written to a temporary OBJ file and so takes the
/// way of a user's mesh. UVs are metres. Returns it for changes.
FabricScene& add_cloth(Scene& scene, const BaseMesh& mesh, const Rgb& color = {1, 1, 1});

/// White cloth in a constant environment of radiance 1, seen along -z on a square of `view` metres about the origin:
/// every pixel is 1.
Scene white_furnace(const BaseMesh& mesh, double view, int pixels);

/// Cloth so thick that its openings are filled, of plies that let nothing through.
Scene closed_cloth(const BaseMesh& mesh);

}  // namespace wale::test
