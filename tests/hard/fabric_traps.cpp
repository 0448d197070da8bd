// Tiles and meshes of unequal size, tiles and cloths at their limits.
#include <fmt/format.h>

#include <cmath>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "tests/hard/fixtures_meshes.h"
#include "tests/hard/fixtures_scenes.h"
#include "tests/hard/look_fabric.h"
#include "tests/hard/look_picture.h"
#include "tests/hard/look_refusal.h"
#include "tests/hard/trap.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

/// White cloth on a sheet of `size` metres in a white furnace, `wales` stitches per metre.
Scene furnace_at_gauge(double wales, double size) {
  Scene scene = white_furnace(make_swatch(size, size, 4, 4), size, 16);
  scene.fabrics[0].spec.scale = {FabricScale::Kind::gauge, {1, 1}, {wales, 0}};
  return scene;
}

Scene tile_of_one_segment() {
  Scene scene = white_furnace(make_swatch(kSheet, kSheet, 4, 4), 0.005, 16);
  Pattern pattern = straight_yarn(0.002, 0.0007);
  pattern.curves[0].points = {pattern.curves[0].points.front(), pattern.curves[0].points.back()};
  const auto file = fixture_file(".json");
  write_pattern_json(pattern, file);
  scene.fabrics[0].pattern = {file, "", {}};
  return scene;
}

double stitch_area() {
  const Pattern pattern = stockinette_pattern();
  return pattern.period.x * pattern.period.y / (pattern.stitches.x * pattern.stitches.y);
}

/// One triangle that carries ten thousand stitches, of one ply and a coarse polyline.
Scene stitches_on_a_triangle() {
  Scene scene = white_furnace(one_triangle(std::sqrt(2e4 * stitch_area())), 0.02, 16);
  scene.fabrics[0].spec.plies = 1;
  scene.fabrics[0].spec.tolerance = 0.5;
  return scene;
}

/// A sheet of ten thousand triangles to a stitch.
Scene triangles_under_a_stitch() {
  constexpr double kSize = 0.0042;
  const int n = int(std::sqrt(5e3 * kSize * kSize / stitch_area()));
  return white_furnace(make_swatch(kSize, kSize, n, n), 0.004, 16);
}

Finding look_at_furnace(const Scene& scene, const std::function<std::string(const Fabric&)>& check) {
  Finding found = look_at_constant(scene, 1.0, 256);
  const World world = build_scene(scene);
  found.broken += check(world.fabrics[0]);
  const Agreement agree = compare_with_brute_force(world.fabrics[0], 2000);
  found.trials += agree.rays;
  if (agree.wrong) found.broken += fmt::format(" {} of {} rays differ from brute force", agree.wrong, agree.rays);
  return found;
}

Trap furnace(
    const std::string& name, const std::string& breaks, const std::function<std::vector<Scene>()>& scenes,
    const std::function<std::string(const Fabric&)>& check = [](const Fabric&) { return ""; }) {
  return {name,
          breaks,
          "white cloth in a white furnace is white, rays meet what brute force in double meets",
          "of the furnace's radiance",
          tolerance::kFurnacePicture,
          0,
          [scenes, check] {
            std::vector<Finding> found;
            for (const Scene& scene : scenes()) found.push_back(look_at_furnace(scene, check));
            return worst_of(found);
          }};
}

std::string expect_stitches(const Fabric& fabric, double least, double most) {
  double area = 0;
  for (const auto& t : fabric.mesh.triangle)
    area += 0.5 * glm::length(glm::cross(fabric.mesh.position[t[1]] - fabric.mesh.position[t[0]],
                                         fabric.mesh.position[t[2]] - fabric.mesh.position[t[0]]));
  const double each =
      area / double(fabric.mesh.triangle.size()) / (fabric.report.stitch_metres.x * fabric.report.stitch_metres.y);
  return each >= least && each <= most ? "" : fmt::format(" {} stitches a triangle", each);
}

Scene plain(const BaseMesh& mesh) { return white_furnace(mesh, 0.01, 8); }

}  // namespace

std::vector<Trap> fabric_traps() {
  return {
      furnace("cloth of straight segments", "a curve of two points has no bend to fit a spline to",
              [] { return std::vector{tile_of_one_segment()}; }),
      furnace(
          "ten thousand stitches on a triangle", "float weights cannot tell neighbouring samples apart",
          [] { return std::vector{stitches_on_a_triangle()}; },
          [](const Fabric& f) { return expect_stitches(f, 9990, 10010); }),
      furnace(
          "ten thousand triangles under a stitch", "every sample lies in another triangle",
          [] { return std::vector{triangles_under_a_stitch()}; },
          [](const Fabric& f) { return expect_stitches(f, 0, 1.05e-4); }),
      furnace("gauge at its limits", "stitches of 10 um and of 1 m meet constants with a length",
              [] {
                return std::vector{furnace_at_gauge(1e5, 6e-5), furnace_at_gauge(1, 6)};
              }),
      {"cloth that cannot be knitted", "tiles wider than the cloth and cloth without area leave nothing to trace",
       "each is refused with one line", "wrong answers", 0, 0,
       [] {
         const auto build = [](const BaseMesh& mesh) { return [mesh] { build_scene(plain(mesh)); }; };
         BaseMesh far = one_triangle(0.006);
         far.position[1].x = 1e300;
         return look_at_answers({{"tile wider than the mesh", build(one_triangle(0.0005)), "larger than the cloth"},
                                 {"vertices on a line", build(line_of_triangles()), "area"},
                                 {"vertex at 1e300 m", build(far), "can be placed"},
                                 {"a mesh of one triangle", build(one_triangle(0.006)), ""}});
       }},
  };
}

}  // namespace wale::test
