// Explicit fibres in the tracer: against every segment in double, and rays from the axis.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

Fabric knit(const BaseMesh& mesh, int fibres, double hairs = 0) {
  FabricSpec spec;
  spec.name = "fibres";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = 2;
  spec.detail = Detail::fibres;
  spec.fibres.fibres = fibres;
  spec.fibres.packing = 0.4;
  spec.fibres.twist = 0.35;
  spec.fibres.migration_min = 0.8;
  spec.flyaways.hairs = spec.flyaways.loops = hairs;
  return knit_fabric(mesh, stockinette_pattern(), spec);
}

TEST(FibreTrace, AgreesWithBruteForce) {
  for (const BaseMesh& mesh : {make_swatch(0.008, 0.008, 4, 4), make_tube(0.002, 0.008, 24, 6)}) {
    const Fabric fabric = knit(mesh, 7, 1000);
    EXPECT_GT(fabric.report.flyaways, 50u);
    const FabricTracer tracer(test_device(), fabric);
    const BruteForce oracle(patches_of(fabric, -1), tracer.positions());
    ASSERT_EQ(oracle.segments(), tracer.fabric().segment_count);
    ASSERT_EQ(oracle.segments(), fabric.report.segments);
    const std::vector<Ray> rays = primary_rays(tracer.bounds(), 20000, 3);
    const std::vector<Hit> hits = tracer.trace(rays);
    size_t met = 0, wrong = 0, grazing = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const OracleHit e = oracle.closest(rays[i], -1);
      const bool hit = hits[i].kind == W_HIT_PLY;
      met += hit;
      if (hit == e.hit && (!hit || std::abs(hits[i].t - e.t) < 2e-3 * fabric.fibre_radius)) continue;
      // A float coordinate of 10 mm is 1e-9 m wide, 2e-5 fibre radii: what grazes closer than that is rounding's to
      // say.
      const double h = std::max(hit ? std::abs(double(hits[i].u)) : 0.0, e.hit ? std::abs(e.h) : 0.0);
      ++(h > 0.999 || (e.hit && e.edge < 1e-3) ? grazing : wrong);
    }
    EXPECT_GT(met, rays.size() / 10);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LE(grazing, rays.size() / 2000);
    EXPECT_EQ(tracer.stack_overflows(), 0u);
  }
}

// A path goes on from the axis of the fibre that it met. Nothing of that fibre may stand in its way near by, at joints
// and caps too.
TEST(FibreTrace, RaysFromTheAxisMeetNoFrontFaceOfTheirOwnTube) {
  const Fabric fabric = knit(make_swatch(0.008, 0.008, 4, 4), 5, 1000);
  const FabricTracer tracer(test_device(), fabric);
  const std::vector<Ray> primary = primary_rays(tracer.bounds(), 60000, 9);
  const std::vector<Hit> first = tracer.trace(primary);
  const std::vector<Surface> at = tracer.surfaces(primary, first);
  const std::vector<float> at_vertex = tracer.positions();
  const auto vertex = [&](uint32_t i) { return dvec3(at_vertex[3 * i], at_vertex[3 * i + 1], at_vertex[3 * i + 2]); };
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  std::vector<uint32_t> from;
  size_t near_joint = 0;
  for (size_t i = 0; i < primary.size(); ++i) {
    if (first[i].kind != W_HIT_PLY) continue;
    near_joint += at[i].u < 0.02f || at[i].u > 0.98f;
    const dvec3 edge = vertex(at[i].segment + 1) - vertex(at[i].segment);
    for (int k = 0; k < 4; ++k) {
      dvec3 d(normal(random), normal(random), normal(random));
      if (k == 0) d = edge;  // down the fibre, through its joints
      Ray ray = make_ray({0, 0, 0}, glm::normalize(d), uint32_t(i));
      const dvec3 axis = double(at[i].u) * edge;
      for (int c = 0; c < 3; ++c) ray.o[c] = at[i].anchor[c], ray.l[c] = float(axis[c]);
      ray.skip = first[i].code;
      rays.push_back(ray);
      from.push_back(at[i].segment);
    }
  }
  EXPECT_GT(rays.size(), 5000u);
  EXPECT_GT(near_joint, 50u);
  const std::vector<Hit> hits = tracer.trace(rays);
  size_t own = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].kind != W_HIT_PLY || hits[i].t > 2 * fabric.fibre_radius) continue;
    const uint32_t segment = tracer.segment(hits[i].code);
    own += segment + 1 >= from[i] && segment <= from[i] + 1;
  }
  EXPECT_EQ(own, 0u);
}

}  // namespace
}  // namespace wale::test
