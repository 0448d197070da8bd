// Trees that follow a moved base mesh: bit for bit what they were when nothing moved, and the same hits as a tree built
// anew when it did. Leaves and boxes do not depend on the width of vectors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

Fabric knit(BaseMesh mesh, int plies) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  return knit_fabric(std::move(mesh), stockinette_pattern(0.004), spec);
}

/// A base mesh as update_fabrics() takes it.
struct Moved {
  std::vector<float> positions, normals;
};

Moved moved(const BaseMesh& mesh) {
  Moved out;
  for (size_t i = 0; i < mesh.position.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      out.positions.push_back(float(mesh.position[i][k]));
      out.normals.push_back(float(mesh.normal[i][k]));
    }
  return out;
}

/// Stretched by half along x, bent round the y axis with a radius of 1 cm, and thrown 2 m aside.
BaseMesh deformed(BaseMesh mesh) {
  constexpr double kRadius = 0.01;
  for (size_t i = 0; i < mesh.position.size(); ++i) {
    const dvec3 p = mesh.position[i], n = mesh.normal[i];
    const double a = 1.5 * p.x / kRadius, r = kRadius + p.z;
    const dvec3 across(std::cos(a), 0, -std::sin(a)), out(std::sin(a), 0, std::cos(a));
    const dvec3 at = dvec3(2, 0, 0) + r * out + dvec3(0, p.y, 0);
    const dvec3 normal = glm::normalize(n.x * across + dvec3(0, n.y, 0) + n.z * out);
    for (int k = 0; k < 3; ++k) {  // as the device will know them
      mesh.position[i][k] = float(at[k]);
      mesh.normal[i][k] = float(normal[k]);
    }
  }
  return mesh;
}

struct Words {
  std::vector<uint32_t> leaves, nodes;
  std::vector<float> frames;
};

Words words(const FabricTracer& tracer) {
  const FabricDevice& f = tracer.fabric();
  return {f.tree.leaves.read(test_device()), f.tree.nodes.read(test_device()), f.frames.read(test_device())};
}

/// Another tree holds its leaves in other places.
std::vector<uint32_t> leaves_without_places(const FabricTracer& tracer) {
  std::vector<uint32_t> leaves = words(tracer).leaves;
  for (const uint32_t offset : tracer.fabric().tree.leaf_offset) leaves[size_t(offset) * 4 + W_LEAF_PLACE] = 0;
  return leaves;
}

template <typename T>
size_t differing(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return std::numeric_limits<size_t>::max();
  size_t n = 0;
  for (size_t i = 0; i < a.size(); ++i) n += std::memcmp(&a[i], &b[i], sizeof(T)) != 0;
  return n;
}

// Flat pieces have open ends; tubes have closed yarns.
std::vector<Fabric> fabrics() {
  std::vector<Fabric> out;
  out.push_back(knit(make_swatch(0.05, 0.04, 6, 6), 3));
  out.push_back(knit(make_tube(0.012, 0.03, 24, 4), 2));
  out.push_back(knit(make_draped_square(0.04, 0.01, 12), 5));
  return out;
}

// Rays go up from their own leaf: a wrong place would lose hits.
TEST(Refit, LeavesAndNodesKnowWhereTheTreeHoldsThem) {
  for (const Fabric& fabric : fabrics()) {
    const FabricTracer tracer(test_device(), fabric);
    const Words w = words(tracer);
    size_t leaves = 0;
    for (uint32_t place = 0; place < w.nodes.size() / W_NODE_WORDS * W_NODE_WIDTH; ++place) {
      const uint32_t* node = w.nodes.data() + size_t(place / W_NODE_WIDTH) * W_NODE_WORDS;
      const uint32_t code = node[W_NODE_CHILD + place % W_NODE_WIDTH];
      if (code == W_NONE) continue;
      const bool leaf = code & W_CHILD_LEAF;
      leaves += leaf;
      ASSERT_EQ(place, leaf ? w.leaves[size_t(code & ~W_CHILD_LEAF) * 4 + W_LEAF_PLACE]
                            : w.nodes[size_t(code) * W_NODE_WORDS + W_NODE_PLACE]);
    }
    EXPECT_EQ(leaves, tracer.fabric().tree.leaf_offset.size());
    EXPECT_EQ(w.nodes[W_NODE_PLACE], W_NONE);
  }
}

TEST(Refit, OfAnUnmovedFabricChangesNoBit) {
  for (const Fabric& fabric : fabrics()) {
    FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, true);
    const Words before = words(tracer);
    const Moved far = moved(deformed(fabric.mesh)), back = moved(fabric.mesh);
    tracer.move(far.positions, far.normals);
    EXPECT_GT(differing(before.nodes, words(tracer).nodes), before.nodes.size() / 4);
    tracer.move(back.positions, back.normals);
    const Words after = words(tracer);
    EXPECT_EQ(differing(before.leaves, after.leaves), 0u);
    EXPECT_EQ(differing(before.nodes, after.nodes), 0u);
    EXPECT_EQ(differing(before.frames, after.frames), 0u);
  }
}

TEST(Refit, HitsAfterBendAndStretchAreThoseOfATreeBuiltAnew) {
  for (const Fabric& fabric : fabrics()) {
    FabricTracer refitted(test_device(), fabric, -1, LocalStage::exact, true);
    Fabric shape = fabric;
    shape.mesh = deformed(fabric.mesh);
    const Moved far = moved(shape.mesh);
    refitted.move(far.positions, far.normals);
    const FabricTracer fresh(test_device(), shape);
    EXPECT_EQ(differing(leaves_without_places(refitted), leaves_without_places(fresh)), 0u);
    EXPECT_EQ(differing(words(refitted).frames, words(fresh).frames), 0u);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(refitted.bounds().lo[k], fresh.bounds().lo[k], 1e-5);
    const std::vector<Ray> rays = primary_rays(fresh.bounds(), 40000, 5);
    const std::vector<Hit> a = refitted.trace(rays), b = fresh.trace(rays);
    size_t hit = 0, different = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      hit += b[i].kind == W_HIT_PLY;
      different += std::memcmp(&a[i], &b[i], sizeof(Hit)) != 0;
    }
    EXPECT_GT(hit, rays.size() / 10);
    EXPECT_EQ(different, 0u);
    EXPECT_EQ(refitted.stack_overflows(), 0u);
  }
}

TEST(Refit, CountsWhatUpdatesNeed) {
  const Fabric fabric = knit(make_swatch(0.03, 0.03, 2, 2), 3);
  const FabricTracer fixed(test_device(), fabric), updatable(test_device(), fabric, -1, LocalStage::exact, true);
  EXPECT_GE(updatable.fabric().bytes, fixed.fabric().bytes + fabric.anchors.size() * (sizeof(WAnchor) + 12 + 1));
}

TEST(Refit, ASegmentTakesFewBytes) {
  const Fabric fabric = knit(make_swatch(0.05, 0.05, 2, 2), 3);
  const FabricTracer tracer(test_device(), fabric);
  const FabricDevice& device = tracer.fabric();
  const double segments = double(device.segment_count);
  ASSERT_GT(segments, 10000);
  const double to_trace = double(device.tree.leaves.bytes() + device.tree.tree_bytes()) / segments;
  EXPECT_LE(to_trace, tolerance::kBytesToTrace);
  EXPECT_LE(to_trace + double(device.frames.bytes()) / segments, tolerance::kBytesToShade);
}

TEST(Refit, MeshesMovedToNoPlaceAreRefused) {
  const Fabric fabric = knit(make_swatch(0.02, 0.02, 2, 2), 3);
  FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, true);
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    Moved far = moved(fabric.mesh);
    far.positions[4] = wrong;
    EXPECT_THROW(tracer.move(far.positions, far.normals), Error) << wrong;
  }
}

TEST(Pack, LeavesAndBoxesDoNotDependOnTheWidthOfVectors) {
  Device device = Device::open();
  Strands strands = random_strands(30, 40, 1, 10, 0.2f, 7);
  for (uint32_t plies = 1; plies <= 8; ++plies)
    for (const bool ghosts : {false, true})
      strands.add(
          plies, 20, 0.3f,
          [&](uint32_t p, uint32_t i) {
            const double a = 2 * std::numbers::pi * i / 17;
            return dvec3(4 * std::cos(a), 4 * std::sin(a) + 0.3 * p, plies + 0.2 * std::sin(3 * a + p));
          },
          ghosts);
  std::vector<uint32_t> leaves[3], nodes[3];
  const unsigned widths[] = {1, 8, 16};
  for (int i = 0; i < 3; ++i) {
    device.traits().lanes = widths[i];
    const PlyTree tree = build_ply_tree(device, strands.patches, Buffer<float>(device, strands.positions));
    leaves[i] = tree.leaves.read(device);
    nodes[i] = tree.nodes.read(device);
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(differing(leaves[0], leaves[i]), 0u) << widths[i];
    EXPECT_EQ(differing(nodes[0], nodes[i]), 0u) << widths[i];
  }
}

}  // namespace
}  // namespace wale::test
