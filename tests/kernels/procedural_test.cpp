// Leaves that keep no points: their hits are those of the stored form of the same lattice, bit for bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "geom/base_mesh_generators.h"
#include "geom/lattice_fabric.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

Fabric knit(BaseMesh mesh, Storage storage, int plies = 3, int cells = 1) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  spec.storage = storage;
  spec.lattice = cells;
  return knit_lattice(std::move(mesh), stockinette_pattern(0.004), spec);
}

size_t long_or(size_t rays) {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  return wanted && std::strcmp(wanted, "1") == 0 ? 1'000'000 : rays;
}

// Bits of t, of the offset h and of the piece; codes name leaves and differ.
bool same_bits(const Hit& a, const Hit& b) {
  return a.kind == b.kind && std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.u, &b.u, sizeof a.u) == 0 &&
         a.v == b.v && a.occluded == b.occluded;
}

void compare(const Device& device, const BaseMesh& mesh, int plies, int cells, size_t rays_wanted) {
  const FabricTracer stored(device, knit(mesh, Storage::stored, plies, cells), 0.4f);
  const FabricTracer procedural(device, knit(mesh, Storage::procedural, plies, cells), 0.4f);
  ASSERT_EQ(procedural.fabric().tight_joints, 0u);
  ASSERT_EQ(procedural.fabric().segment_count, stored.fabric().segment_count);
  EXPECT_EQ(procedural.fabric().vertex_count, 0u);

  std::vector<Ray> rays = primary_rays(stored.bounds(), rays_wanted, 1), others = rays;
  for (int bounce = 0; bounce < 2; ++bounce) {
    const std::vector<Hit> a = stored.trace(rays), b = procedural.trace(others);
    const std::vector<Surface> sa = stored.surfaces(rays, a), sb = procedural.surfaces(others, b);
    size_t hits = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(same_bits(a[i], b[i])) << "ray " << i << ": t " << a[i].t << " and " << b[i].t;
      if (a[i].kind != W_HIT_PLY) continue;
      ++hits;
      ASSERT_EQ(std::memcmp(&sa[i], &sb[i], sizeof sa[i]), 0) << "ray " << i;
    }
    EXPECT_GT(hits, rays_wanted / 20);
    if (bounce) break;
    const std::vector<Ray> next = bounce_rays(rays, a, sa, 2), same = bounce_rays(others, b, sb, 2);
    rays = next;
    others = same;
    ASSERT_EQ(rays.size(), others.size());
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(std::memcmp(rays[i].d, others[i].d, sizeof rays[i].d), 0);
  }
  EXPECT_EQ(procedural.stack_overflows(), 0u);
}

// A square of cloth with gentle folds.
BaseMesh sheet(double side) {
  BaseMesh mesh = make_swatch(side, side, 12, 12);
  for (dvec3& p : mesh.position) p.z = 0.05 * side * std::sin(6 * p.x / side) * std::cos(5 * p.y / side);
  compute_normals(mesh);
  return mesh;
}

TEST(Procedural, HitsOfASheetAreThoseOfItsStoredForm) { compare(test_device(), sheet(0.04), 3, 1, long_or(20000)); }
TEST(Procedural, HitsOfATubeAreThoseOfItsStoredForm) {
  compare(test_device(), make_tube(0.02, 0.03, 24, 3), 3, 2, long_or(20000));
}
TEST(Procedural, EveryNumberOfPliesHasTheSameHits) {
  for (const int plies : {1, 2, 4, 5, 6}) compare(test_device(), sheet(0.02), plies, 1, 4000);
}
TEST(Procedural, EveryWidthHasTheSameHits) {
  Device device = test_device();
  device.traits().build_options = " -DW_PORTABLE";
  for (const unsigned lanes : {1u, 16u}) {
    device.traits().lanes = lanes;
    compare(device, make_tube(0.02, 0.01, 24, 3), 3, 1, 500);
  }
}
TEST(Procedural, ASegmentTakesFewBytes) {
  const FabricTracer tracer(test_device(), knit(sheet(0.08), Storage::procedural));
  const FabricDevice& device = tracer.fabric();
  ASSERT_EQ(device.tight_joints, 0u);
  ASSERT_GT(device.segment_count, 50000u);
  EXPECT_LE(double(device.tree.tree_bytes() + device.lattice.bytes()),
            tolerance::kProceduralBytes * double(device.segment_count));
}

TEST(Procedural, ClothBentTooFarIsStored) {
  const BaseMesh mesh = make_pillow(0.02, 0.02, 0.006, 6, 6);
  const FabricTracer stored(test_device(), knit(mesh, Storage::stored));
  const FabricTracer procedural(test_device(), knit(mesh, Storage::procedural));
  EXPECT_GT(procedural.fabric().tight_joints, 0u);
  EXPECT_EQ(procedural.fabric().vertex_count, stored.fabric().vertex_count);
  const std::vector<Ray> rays = primary_rays(stored.bounds(), 2000, 1);
  const std::vector<Hit> a = stored.trace(rays), b = procedural.trace(rays);
  for (size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << i;
}

}  // namespace
}  // namespace wale::test
