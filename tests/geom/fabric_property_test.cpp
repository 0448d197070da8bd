// Random layouts of the UVs of a flat sheet: what a fabric must not depend on, and what it must follow.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "geom/fabric.h"
#include "geom/stored_length.h"
#include "geom/warp.h"
#include "shared/wale_types.h"
#include "tests/property.h"

namespace wale::test {
namespace {

using Dmat2 = glm::dmat2;

FabricSpec metric_spec() {
  FabricSpec spec;
  spec.name = "random";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = 2;
  spec.tolerance = 0.2;
  return spec;
}

/// A flat sheet of about 10 x 8 mm whose UVs are `turn` times its place, plus `shift`.
BaseMesh sheet(const Dmat2& turn, dvec2 shift) {
  BaseMesh mesh = make_swatch(*number_between(0.009, 0.012), *number_between(0.007, 0.01), *rc::gen::inRange(1, 6),
                              *rc::gen::inRange(1, 6));
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) mesh.uv[t][k] = turn * dvec2(mesh.position[mesh.triangle[t][k]]) + shift;
  return mesh;
}

Dmat2 random_rotation() {
  const double a = *number_between(-std::numbers::pi, std::numbers::pi);
  return Dmat2(std::cos(a), std::sin(a), -std::sin(a), std::cos(a));
}

dvec2 random_shift(double reach) { return {*number_between(-reach, reach), *number_between(-reach, reach)}; }

void expect_whole(const Fabric& fabric) {
  size_t vertices = 0, segments = 0, listed = 0;
  for (const PlyRun& run : fabric.runs) {
    RC_ASSERT(run.first_vertex == vertices);
    vertices += size_t(run.count) * run.plies;
    segments += size_t(run.plies) * (run.count - (run.ghost_ends ? 3 : 1));
  }
  for (const Patch& patch : fabric.patches) listed += size_t(patch.intervals) * fabric.runs[patch.run].plies;
  RC_ASSERT(vertices == fabric.anchors.size());
  RC_ASSERT(segments == fabric.report.segments);
  RC_ASSERT(segments == listed);
  for (const Anchor& a : fabric.anchors) {
    RC_ASSERT(a.triangle < fabric.mesh.triangle.size());
    RC_ASSERT(std::isfinite(a.b1 + a.b2 + a.height + a.length));
    RC_ASSERT(std::abs(a.nx * a.nx + a.ny * a.ny + a.nz * a.nz - 1) < 1e-5f);
  }
}

dvec3 place(const Fabric& fabric, const Anchor& a) {
  return warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height);
}

/// Visits (first vertex, segment length in space, rest length).
template <typename Visit>
void each_segment(const Fabric& fabric, Visit&& visit) {
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; p < run.plies; ++p)
      for (uint32_t k = 0; k + 1 < run.count; ++k) {
        const Anchor& a = fabric.anchors[run.first_vertex + p * run.count + k];
        const Anchor& b = (&a)[1];
        visit(a, glm::length(place(fabric, b) - place(fabric, a)),
              length_between(a.length, b.length, fabric.ply_radius));
      }
}

// UVs that are the sheet turned, mirrored and moved: the cloth keeps every length of the flat knit.
TEST(FabricProperty, CongruentUvKeepsRestLengths) {
  check_property(12, [] {
    const bool mirror = *rc::gen::arbitrary<bool>();
    const Dmat2 turn = random_rotation() * Dmat2(mirror ? -1 : 1, 0, 0, 1);
    const Fabric fabric = knit_fabric(sheet(turn, random_shift(10)), stockinette_pattern(), metric_spec());
    expect_whole(fabric);
    RC_ASSERT(fabric.report.mirrored == mirror);
    each_segment(fabric, [](const Anchor&, double length, double rest) {
      // Chord against arc, and lengths stored as floats that wrap after many radii.
      RC_ASSERT(std::abs(length - rest) < 0.02 * rest + 1e-8);
    });
  });
}

// The knit is flat: how its UVs are stretched over space changes no sample, no frame and no length.
TEST(FabricProperty, StretchInSpaceLeavesTheFlatKnitAlone) {
  check_property(12, [] {
    const BaseMesh mesh = sheet(random_rotation(), random_shift(1));
    BaseMesh sheared = mesh;
    const double stretch = *number_between(0.5, 2), shear = *number_between(-1, 1);
    for (dvec3& p : sheared.position) p = dvec3(stretch * p.x + shear * p.y, p.y, 0);
    compute_normals(sheared);
    const Fabric a = knit_fabric(mesh, stockinette_pattern(), metric_spec());
    const Fabric b = knit_fabric(sheared, stockinette_pattern(), metric_spec());
    expect_whole(b);
    RC_ASSERT(a.runs.size() == b.runs.size());
    RC_ASSERT(a.anchors.size() == b.anchors.size());
    for (size_t i = 0; i < a.anchors.size(); ++i)
      RC_ASSERT(std::memcmp(&a.anchors[i].height, &b.anchors[i].height, 5 * sizeof(float)) == 0);
  });
}

// Whole tiles of displacement are none.
TEST(FabricProperty, WholeTilesOfDisplacementChangeNothing) {
  check_property(12, [] {
    const Pattern pattern = stockinette_pattern();
    const BaseMesh mesh = sheet(random_rotation(), random_shift(0.01));
    BaseMesh moved = mesh;
    const dvec2 shift = pattern.period * dvec2(*rc::gen::inRange(-1000, 1001), *rc::gen::inRange(-1000, 1001));
    for (auto& t : moved.uv)
      for (dvec2& uv : t) uv += shift;
    const Fabric a = knit_fabric(mesh, pattern, metric_spec()), b = knit_fabric(moved, pattern, metric_spec());
    RC_ASSERT(a.runs.size() == b.runs.size());
    RC_ASSERT(a.anchors.size() == b.anchors.size());
    double worst = 0;
    for (size_t i = 0; i < a.anchors.size(); ++i)
      worst = std::max(worst, glm::length(place(a, a.anchors[i]) - place(b, b.anchors[i])));
    RC_ASSERT(worst < 1e-3 * a.ply_radius);
  });
}

}  // namespace
}  // namespace wale::test
