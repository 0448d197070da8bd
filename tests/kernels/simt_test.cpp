// One ray per work-item down quantised nodes finds what vectors find in exact ones, to the last bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "geom/base_mesh_generators.h"
#include "geom/lattice_fabric.h"
#include "shared/visits.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

const std::string kSimt = "-DW_LANES=1 -DW_SIMT";

/// The vectors that this device runs.
std::string lanes() { return "-DW_LANES=" + std::to_string(test_device().traits().lanes); }

struct Case {
  const char* name;
  Strands strands;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"stockinette", stockinette(6, 8, 56)});
  all.push_back({"helix", helix(12, 20, 0.02, 0.01, 0.004f)});
  all.push_back({"tight bends", random_strands(60, 24, 0.02, 0.1, 0.01f, 7)});
  all.push_back({"long segments", random_strands(40, 12, 5, 10, 0.2f, 9)});
  Strands half = stockinette(4, 6, 56);
  for (PlyPatch& patch : half.patches) patch.tau = 0.7f;
  all.push_back({"half transparent", std::move(half)});
  Strands far = stockinette(3, 5, 40);
  for (size_t i = 0; i < far.positions.size(); i += 3) far.positions[i] += 700;
  all.push_back({"far away", std::move(far)});
  return all;
}

size_t different(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  if (a.size() != b.size()) return a.size() + b.size();
  size_t n = 0;
  for (size_t i = 0; i < a.size(); ++i) n += std::memcmp(&a[i], &b[i], sizeof(Hit)) != 0;
  return n;
}

size_t met(const std::vector<Hit>& hits) {
  size_t n = 0;
  for (const Hit& hit : hits) n += hit.kind != W_HIT_NONE;
  return n;
}

TEST(Simt, FindsWhatVectorsFind) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Tracer tracer(test_device(), c.strands);
    const auto expect_the_same = [&](const std::vector<Ray>& rays, const char* what) {
      const std::vector<Hit> wide = tracer.trace(rays, lanes());
      EXPECT_EQ(different(wide, tracer.trace(rays, kSimt)), 0u) << what << ": of " << rays.size();
      return wide;
    };
    std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 15000, 3);
    const std::vector<Hit> first = expect_the_same(rays, "from outside");
    EXPECT_GT(met(first), rays.size() / 20);
    std::vector<Ray> bounces = bounce_rays(rays, first, tracer.surfaces(rays, first), 5);
    expect_the_same(bounces, "off the plies");
    // As light that grazes a ply does, from the middle of its chord: outside of the box of the leaf that it starts on.
    for (size_t i = 0; i < bounces.size(); ++i)
      for (int k = 0; k < 3; ++k) bounces[i].o[k] -= float(i % 50) * c.strands.patches[0].radius * bounces[i].d[k];
    expect_the_same(bounces, "from far off the plies that they start on");
    for (size_t i = 0; i < rays.size(); i += 7) rays[i].d[1] = NAN;
    for (size_t i = 3; i < rays.size(); i += 5)
      if (first[i].kind == W_HIT_PLY) rays[i].tmax = first[i].t * (i % 2 ? 1.0f : 0.9999f);
    for (size_t i = 5; i < rays.size(); i += 11) rays[i].d[i % 3] = 0;  // not unit any more, but valid
    expect_the_same(rays, "cut short, along planes, not unit, not numbers");
    EXPECT_EQ(tracer.stack_overflows(), 0u);
  }
}

TEST(Simt, FindsWhatVectorsFindInFabricsOfEveryKind) {
  Device simt = test_device();
  simt.traits().traversal = Traversal::simt;
  simt.traits().lanes = 1;
  const BaseMesh mesh = make_tube(0.012, 0.02, 24, 4);
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  std::vector<Fabric> fabrics;
  fabrics.push_back(knit_fabric(mesh, stockinette_pattern(0.004), spec));
  spec.storage = Storage::procedural;
  spec.lattice = 1;
  fabrics.push_back(knit_lattice(mesh, stockinette_pattern(0.004), spec));
  ASSERT_TRUE(fabrics[1].procedural);
  spec = {};
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.detail = Detail::fibres;
  fabrics.push_back(knit_fabric(make_swatch(0.004, 0.004, 1, 1), stockinette_pattern(0.004), spec));
  ASSERT_GT(fabrics[2].report.fibres, 0u);
  for (const Fabric& fabric : fabrics) {
    const FabricTracer a(test_device(), fabric, 0.4f), b(simt, fabric, 0.4f);
    EXPECT_EQ(a.fabric().tree.quantised.bytes(), 0u);
    EXPECT_GT(b.fabric().tree.quantised.bytes(), 0u);
    const std::vector<Ray> rays = primary_rays(a.bounds(), 10000, 1);
    const std::vector<Hit> hits = a.trace(rays);
    EXPECT_GT(met(hits), rays.size() / 50);
    EXPECT_EQ(different(hits, b.trace(rays)), 0u);
    const std::vector<Ray> bounces = bounce_rays(rays, hits, a.surfaces(rays, hits), 2);
    EXPECT_EQ(different(a.trace(bounces), b.trace(bounces)), 0u);
  }
}

TEST(Simt, FollowsAMovedMesh) {
  Device simt = test_device();
  simt.traits().traversal = Traversal::simt;
  simt.traits().lanes = 1;
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  const Fabric fabric = knit_fabric(make_swatch(0.03, 0.03, 4, 4), stockinette_pattern(0.004), spec);
  FabricTracer a(test_device(), fabric, -1, LocalStage::exact, true), b(simt, fabric, -1, LocalStage::exact, true);
  std::vector<float> positions, normals;
  for (size_t i = 0; i < fabric.mesh.position.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      positions.push_back(float(fabric.mesh.position[i][k] * 1.2 + 0.5));
      normals.push_back(float(fabric.mesh.normal[i][k]));
    }
  a.move(positions, normals);
  b.move(positions, normals);
  const std::vector<Ray> rays = primary_rays(a.bounds(), 10000, 1);
  const std::vector<Hit> hits = a.trace(rays);
  EXPECT_GT(met(hits), rays.size() / 5);
  EXPECT_EQ(different(hits, b.trace(rays)), 0u);
}

/// One plane of a quantised node, as the kernel finds it.
float plane(const uint32_t* node, int side, int axis, int slot) {
  const uint32_t exponents = node[W_QUANTISED_EXPONENTS];
  const float scale = std::bit_cast<float>((exponents >> (8 * axis) & 255) << 23);
  const uint32_t word = node[W_QUANTISED_PLANES + 12 * side + 4 * axis + slot / 4];
  return std::fma(float(word >> (8 * (slot % 4)) & 255), scale, std::bit_cast<float>(node[W_QUANTISED_ORIGIN + axis]));
}

TEST(Quantised, NodesHoldTheExactBoxesAndLittleMore) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Tracer tracer(test_device(), c.strands);
    const std::vector<uint32_t> wide = tracer.tree().nodes.read(test_device());
    const std::vector<uint32_t> nodes = tracer.quantised().nodes().read(test_device());
    const std::vector<uint32_t> boxes = tracer.quantised().leaf_boxes().read(test_device());
    ASSERT_EQ(wide.size() / W_NODE_WORDS, nodes.size() / W_QUANTISED_WORDS);
    ASSERT_EQ(boxes.size() / W_LEAF_BOX_WORDS, c.strands.patches.size());
    size_t leaves = 0;
    for (size_t n = 0; n < wide.size() / W_NODE_WORDS; ++n) {
      const uint32_t *from = wide.data() + n * W_NODE_WORDS, *node = nodes.data() + n * W_QUANTISED_WORDS;
      const uint32_t slots = node[W_QUANTISED_SLOTS];
      uint32_t next_node = node[W_QUANTISED_FIRST_NODE], next_leaf = node[W_QUANTISED_FIRST_LEAF];
      for (int slot = 0; slot < W_NODE_WIDTH; ++slot) {
        const uint32_t code = from[W_NODE_CHILD + slot];
        ASSERT_EQ(slots >> slot & 1, code != W_NONE);
        if (code == W_NONE) continue;
        const bool leaf = code & W_CHILD_LEAF;
        ASSERT_EQ(slots >> (16 + slot) & 1, !leaf);
        const uint32_t* box = boxes.data() + size_t(next_leaf) * W_LEAF_BOX_WORDS;
        if (leaf) {
          ASSERT_EQ(box[3], code & ~W_CHILD_LEAF);
          ++next_leaf;
          ++leaves;
        } else {
          ASSERT_EQ(next_node++, code);
        }
        for (int k = 0; k < 3; ++k) {
          const float lo = std::bit_cast<float>(from[16 * k + slot]),
                      hi = std::bit_cast<float>(from[48 + 16 * k + slot]);
          const float below = plane(node, 0, k, slot), above = plane(node, 1, k, slot);
          ASSERT_LE(below, lo);
          ASSERT_GE(above, hi);
          // One step, and the rounding of planes that lie far from 0.
          const float step = std::bit_cast<float>((node[W_QUANTISED_EXPONENTS] >> (8 * k) & 255) << 23);
          const float room = step + 2 * std::max(std::nextafter(std::abs(lo), 1e30f) - std::abs(lo),
                                                 std::nextafter(std::abs(hi), 1e30f) - std::abs(hi));
          ASSERT_LE(lo - below, room);
          ASSERT_LE(above - hi, room);
          if (!leaf) continue;
          ASSERT_EQ(box[k], from[16 * k + slot]);
          ASSERT_EQ(box[4 + k], from[48 + 16 * k + slot]);
        }
      }
    }
    EXPECT_EQ(leaves, c.strands.patches.size());
  }
}

TEST(Simt, ReadsTheLeavesThatVectorsReadAndFewSegmentsOfThem) {
  Tracer wide(test_device(), stockinette(12, 16, 56)), simt(test_device(), stockinette(12, 16, 56));
  const std::vector<Ray> rays = primary_rays(wide.tree().bounds, 10000, 3);
  wide.trace(rays, lanes() + " -DW_COUNT_VISITS");
  simt.trace(rays, kSimt + " -DW_COUNT_VISITS");
  const auto a = wide.events(), b = simt.events();
  EXPECT_GT(b[W_VISIT_LEAF], 0u);
  EXPECT_LE(b[W_VISIT_LEAF], a[W_VISIT_LEAF] + a[W_VISIT_LEAF] / 20) << "exact boxes keep the others out";
  EXPECT_LE(b[W_VISIT_NODE], a[W_VISIT_NODE] + a[W_VISIT_NODE] / 5) << "quantised boxes are little larger";
  EXPECT_LE(b[W_VISIT_SEGMENT], 5 * b[W_VISIT_LEAF]) << "of 15 in a leaf";
}

TEST(Simt, CountsWhatAFullStackLeavesOut) {
  Tracer tracer(test_device(), stockinette(12, 16, 56));
  const std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 2000, 3);
  tracer.trace(rays, kSimt + " -DW_SIMT_LEVELS=1");
  EXPECT_GT(tracer.stack_overflows(), 0u);
}

}  // namespace
}  // namespace wale::test
