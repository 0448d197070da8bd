// Leaves in several buffers are the same leaves: hits, refits and cell stages as with one buffer, bit for bit.
#include <gtest/gtest.h>

#include <cstring>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "geom/lattice_fabric.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

Fabric knit(Storage storage) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.storage = storage;
  spec.lattice = storage == Storage::procedural ? 1 : 0;
  const BaseMesh mesh = make_tube(0.012, 0.02, 24, 4);
  return spec.lattice ? knit_lattice(mesh, stockinette_pattern(0.004), spec)
                      : knit_fabric(mesh, stockinette_pattern(0.004), spec);
}

/// The test device with room for `bytes` in one buffer.
Device device_with(uint64_t bytes) {
  Device device = test_device();
  device.traits().max_alloc_bytes = bytes;
  return device;
}

size_t different_bytes(const Hit& a, const Hit& b, bool codes) {
  return std::memcmp(&a.t, &b.t, sizeof a.t) != 0 || a.kind != b.kind || (codes && a.code != b.code) ||
         std::memcmp(&a.u, &b.u, sizeof a.u) != 0 || std::memcmp(&a.v, &b.v, sizeof a.v) != 0 ||
         a.occluded != b.occluded;
}

void expect_the_same(const FabricTracer& whole, const FabricTracer& split) {
  ASSERT_TRUE(split.fabric().tree.leaves.split());
  std::vector<Ray> rays = primary_rays(whole.bounds(), 20000, 3), others = rays;
  for (const bool bounced : {false, true}) {
    const std::vector<Hit> a = whole.trace(rays), b = split.trace(others);
    const std::vector<Surface> sa = whole.surfaces(rays, a), sb = split.surfaces(others, b);
    size_t hits = 0, different = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      hits += a[i].kind == W_HIT_PLY;
      // Numbers of leaves move on where one does not fit the rest of a buffer.
      different += different_bytes(a[i], b[i], false) +
                   (a[i].kind == W_HIT_PLY && std::memcmp(&sa[i], &sb[i], sizeof sa[i]) != 0);
    }
    EXPECT_GT(hits, rays.size() / 20);
    EXPECT_EQ(different, 0u) << "of " << rays.size() << (bounced ? " bounces" : "");
    rays = bounce_rays(rays, a, sa, 4);
    others = bounce_rays(others, b, sb, 4);
    ASSERT_EQ(rays.size(), others.size());
  }
}

TEST(SplitLeaves, HaveTheHitsOfWholeOnes) {
  const Fabric fabric = knit(Storage::stored);
  const FabricTracer whole(test_device(), fabric, 0.4f);
  for (const uint64_t parts : {2, 4}) {
    const Device device = device_with(whole.fabric().tree.leaves.bytes() / parts);
    const FabricTracer split(device, fabric, 0.4f);
    EXPECT_GE(split.fabric().tree.leaves.parts().size(), parts);
    for (const auto& part : split.fabric().tree.leaves.parts())
      EXPECT_LE(part.words.bytes(), device.traits().max_alloc_bytes);
    expect_the_same(whole, split);
  }
}

TEST(SplitLeaves, HaveTheHitsOfWholeOnesInTheCellStages) {
  const Fabric fabric = knit(Storage::stored);
  const FabricTracer whole(test_device(), fabric, -1, LocalStage::ring);
  const Device device = device_with(whole.fabric().tree.leaves.bytes() / 3);
  expect_the_same(whole, FabricTracer(device, fabric, -1, LocalStage::ring));
}

TEST(SplitLeaves, AreRefitted) {
  const Fabric fabric = knit(Storage::stored);
  FabricTracer whole(test_device(), fabric, -1, LocalStage::exact, true);
  const Device device = device_with(whole.fabric().tree.leaves.bytes() / 3);
  FabricTracer split(device, fabric, -1, LocalStage::exact, true);
  std::vector<float> positions, normals;
  for (size_t i = 0; i < fabric.mesh.position.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      positions.push_back(float(fabric.mesh.position[i][k] * (k == 1 ? 1.3 : 1.1)));
      normals.push_back(float(fabric.mesh.normal[i][k]));
    }
  whole.move(positions, normals);
  split.move(positions, normals);
  expect_the_same(whole, split);
}

TEST(SplitLeaves, AreRefusedWhereAllBuffersTogetherAreTooSmall) {
  const Fabric fabric = knit(Storage::stored);
  const size_t bytes = FabricTracer(test_device(), fabric).fabric().tree.leaves.bytes();
  const Device small = device_with(bytes / W_LEAF_BUFFERS / 2), none = device_with(64);
  EXPECT_THROW(FabricTracer(small, fabric), Error);
  EXPECT_THROW(FabricTracer(none, fabric), Error);
  EXPECT_LT(LeafBuffers::most_bytes(small.traits().max_alloc_bytes), bytes);
  EXPECT_EQ(LeafBuffers::most_bytes(64), 0u);
}

TEST(SplitLeaves, MostBytesAreHeld) {
  for (const uint64_t max_alloc : {10000u, 40000u, 65536u + 160u}) {
    const Device device = device_with(max_alloc);
    // The largest leaves, whose ends of buffers waste the most.
    const uint32_t words = W_LEAF_HEADER + 3 * (W_LEAF_LANES + 3 * 8);
    const std::vector<uint32_t> leaves(size_t(LeafBuffers::most_bytes(max_alloc) / (4 * words)), words);
    std::vector<uint32_t> numbers;
    const LeafBuffers buffers(device, leaves, 1u << 28, numbers);
    EXPECT_LE(buffers.parts().size(), size_t(W_LEAF_BUFFERS));
    EXPECT_EQ(numbers.size(), leaves.size());
  }
}

}  // namespace
}  // namespace wale::test
