// Leaves that keep 16 bits a coordinate: what rays meet is exactly the polyline of the rounded points, the same on both
// sides of every joint, and the rounding is small.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "geom/lattice_fabric.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/kernels/joint_rays.h"

namespace wale::test {
namespace {

constexpr double kQuantisedVertex = 5e-4;  // ply radii a coordinate: half a step, of 65532 across the largest leaf
constexpr double kQuantisedBytes = 0.75;   // of the bytes of leaves of floats; two thirds from two plies on
const LeafForm kQuantised(Joints::mitre, Vertices::quantised);

/// Points of vertices as the leaves hold them; `disagree` counts points that leaves hold differently.
struct Decoded {
  std::vector<float> positions;
  size_t known = 0, disagree = 0;
  double largest_error = 0;  ///< of a coordinate, metres
};

/// Header word and point of a leaf, read from its bytes by their documented layout alone.
float coordinate(const uint32_t* leaf, uint32_t axis, uint32_t i) {
  const uint32_t stride = leaf[W_LEAF_LAYOUT] >> 16 & 0x3fff, at = axis * stride + i;
  const uint32_t q = leaf[W_QUANTISED_LEAF_HEADER + at / 2] >> (at % 2 * 16) & 0xffff;
  const double steps = double(std::bit_cast<int32_t>(leaf[W_LEAF_ORIGIN + axis])) + q;
  return float(steps * double(std::bit_cast<float>(leaf[W_LEAF_STEP])));
}

Decoded decode(const std::vector<PlyPatch>& patches, const PlyTree& tree, const std::vector<float>& exact) {
  const std::vector<uint32_t> leaves = tree.leaves.read(test_device());
  Decoded out;
  out.positions = exact;
  std::vector<bool> known(exact.size() / 3);
  for (size_t i = 0; i < patches.size(); ++i) {
    const PlyPatch& patch = patches[i];
    const uint32_t* leaf = leaves.data() + size_t(tree.leaf_offset[i]) * 4;
    EXPECT_TRUE(leaf[W_LEAF_LAYOUT] & W_LAYOUT_QUANTISED);
    for (uint32_t p = 0; p < patch.plies; ++p)
      for (uint32_t k = 0; k < patch.intervals + 3; ++k) {
        const long in_ply = long(patch.first + k) - 1;
        if (in_ply < 0 || in_ply >= long(patch.count)) continue;  // made up
        const size_t v = size_t(patch.first_vertex) + p * patch.count + size_t(in_ply);
        for (uint32_t axis = 0; axis < 3; ++axis) {
          const float x = coordinate(leaf, axis, k * patch.plies + p);
          float& there = out.positions[3 * v + axis];
          if (known[v]) {
            out.disagree += std::memcmp(&x, &there, sizeof x) != 0;
          } else {
            there = x;
            out.largest_error = std::max(out.largest_error, std::abs(double(x) - double(exact[3 * v + axis])));
          }
        }
        out.known += !known[v];
        known[v] = true;
      }
  }
  return out;
}

Fabric knit(BaseMesh mesh, int plies) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  return knit_fabric(std::move(mesh), stockinette_pattern(0.004), spec);
}

std::vector<Fabric> fabrics() {
  std::vector<Fabric> out;
  out.push_back(knit(make_swatch(0.05, 0.04, 6, 6), 3));
  out.push_back(knit(make_tube(0.012, 0.03, 24, 4), 2));
  out.push_back(knit(make_draped_square(0.04, 0.01, 12), 5));
  return out;
}

bool same_bits(const Hit& a, const Hit& b) {
  return a.kind == b.kind && std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.u, &b.u, sizeof a.u) == 0 &&
         a.v == b.v && a.occluded == b.occluded;
}

TEST(QuantisedVertices, LeavesThatShareAJointHoldTheSamePoint) {
  for (const Fabric& fabric : fabrics()) {
    const FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, false, kQuantised);
    const Decoded d = decode(patches_of(fabric, -1), tracer.fabric().tree, tracer.positions());
    EXPECT_EQ(d.disagree, 0u) << fabric.name;
    EXPECT_GT(d.known, tracer.fabric().segment_count);
    EXPECT_GT(d.largest_error, 0);
    EXPECT_LT(d.largest_error, kQuantisedVertex * fabric.ply_radius);
  }
}

// The same words as a tree of floats over the decoded points: all that follows from the points is the same.
TEST(QuantisedVertices, HitsAreThoseOfTheDecodedPointsToTheLastBit) {
  const std::pair<const char*, Strands> all[] = {{"helix", helix(24, 8, 3.3, 2.5, 1.0f)},
                                                 {"random bends", random_strands(60, 12, 1.0, 12, 0.4f, 7)},
                                                 {"stockinette", stockinette(3, 4, 40)}};
  for (const auto& [name, strands] : all)
    for (const Joints joints : {Joints::open, Joints::capsule, Joints::mitre}) {
      Tracer quantised(test_device(), strands, LeafForm(joints, Vertices::quantised));
      const Decoded d = decode(strands.patches, quantised.tree(), strands.positions);
      EXPECT_EQ(d.disagree, 0u) << name;
      Strands rounded = strands;
      rounded.positions = d.positions;
      Tracer full(test_device(), rounded, joints);
      EXPECT_EQ(full.tree().nodes.read(test_device()).size(), quantised.tree().nodes.read(test_device()).size());
      std::vector<Ray> rays = primary_rays(full.tree().bounds, 5000, 3);
      const BruteForce oracle(rounded.patches, rounded.positions, joints);
      const std::vector<JointPair> pairs = joints_of(oracle);
      Stream random{17};
      for (int i = 0; i < 5000; ++i) {
        rays.push_back(ray_at(oracle, pairs[random.next() % pairs.size()], random));
        rays.back().tmax = 1e30f;
      }
      const std::vector<Hit> expected = full.trace(rays, "-DW_LANES=16");
      size_t hits = 0;
      for (const char* options : {"-DW_LANES=16", "-DW_LANES=1", "-DW_LANES=1 -DW_SIMT"}) {
        const std::vector<Hit> found = quantised.trace(rays, options);
        for (size_t i = 0; i < rays.size(); ++i) {
          hits += found[i].kind == W_HIT_PLY;
          ASSERT_TRUE(same_bits(found[i], expected[i])) << name << options << " " << i;
        }
      }
      EXPECT_GT(hits, rays.size() / 4) << name;
      const std::vector<Hit> packets = quantised.trace_packets(rays);
      for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(packets[i].t, expected[i].t) << name << i;
      const std::vector<Hit> own = quantised.trace(rays, "-DW_LANES=16");  // leaves have other numbers
      const std::vector<Surface> a = quantised.surfaces(rays, own), b = full.surfaces(rays, expected);
      for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(expected[i].kind != W_HIT_PLY || std::memcmp(&a[i], &b[i], sizeof a[i]) == 0) << name << i;
    }
}

// Against every segment in long double, over the points as the leaves hold them; aimed at joints: none may leak.
TEST(QuantisedVertices, AgreeWithBruteForceAndAreWatertight) {
  for (const Fabric& fabric : fabrics()) {
    const FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, false, kQuantised);
    const std::vector<PlyPatch> patches = patches_of(fabric, -1);
    const Decoded d = decode(patches, tracer.fabric().tree, tracer.positions());
    const BruteForce oracle(patches, d.positions);
    const std::vector<JointPair> pairs = joints_of(oracle);
    Stream random{23};
    std::vector<Ray> rays;
    while (rays.size() < 2000) {
      Ray ray = ray_at(oracle, pairs[random.next() % pairs.size()], random);
      ray.tmax = 1e30f;
      rays.push_back(ray);
    }
    const std::vector<Hit> hits = tracer.trace(rays);
    size_t met = 0, differ = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const OracleHit e = oracle.closest(rays[i]);
      const bool hit = hits[i].kind == W_HIT_PLY;
      met += hit;
      const bool grazes = (hit && std::abs(hits[i].u) > 0.999f) || (e.hit && (std::abs(e.h) > 0.999 || e.edge < 1e-3));
      const double rounding = 1e-3 * fabric.ply_radius + std::ldexp(e.hit ? e.t : 0, -22);
      differ += !grazes && (hit != e.hit || (hit && std::abs(hits[i].t - e.t) > rounding));
    }
    EXPECT_GT(met, rays.size() / 2);
    EXPECT_EQ(differ, 0u);
  }
}

struct Moved {
  std::vector<float> positions, normals;
};
Moved moved(const BaseMesh& mesh) {
  Moved out;
  for (size_t v = 0; v < mesh.position.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      out.positions.push_back(float(mesh.position[v][k]));
      out.normals.push_back(float(mesh.normal[v][k]));
    }
  return out;
}

/// Three times as large: leaves no longer fit the steps that they were built with.
BaseMesh inflated(BaseMesh mesh) {
  for (dvec3& p : mesh.position) {
    p = dvec3(3.0 * p.x, 3.0 * p.y, 3.0 * p.z + 0.001 * std::sin(300 * p.x)) + dvec3(1, 0, 0);
    for (int k = 0; k < 3; ++k) p[k] = float(p[k]);  // as the device will know them
  }
  compute_normals(mesh);
  for (dvec3& n : mesh.normal)
    for (int k = 0; k < 3; ++k) n[k] = float(n[k]);
  return mesh;
}

TEST(QuantisedVertices, RefitIsTheSameAsATreeBuiltAnew) {
  for (const Fabric& fabric : fabrics()) {
    FabricTracer refitted(test_device(), fabric, -1, LocalStage::exact, true, kQuantised);
    const std::vector<uint32_t> before = refitted.fabric().tree.leaves.read(test_device());
    Fabric shape = fabric;
    shape.mesh = inflated(fabric.mesh);
    const Moved far = moved(shape.mesh), back = moved(fabric.mesh);
    refitted.move(far.positions, far.normals);
    const FabricTracer fresh(test_device(), shape, -1, LocalStage::exact, false, kQuantised);
    std::vector<uint32_t> a = refitted.fabric().tree.leaves.read(test_device());
    std::vector<uint32_t> b = fresh.fabric().tree.leaves.read(test_device());
    for (const uint32_t offset : fresh.fabric().tree.leaf_offset)  // another tree holds them in other places
      a[size_t(offset) * 4 + W_LEAF_PLACE] = b[size_t(offset) * 4 + W_LEAF_PLACE] = 0;
    EXPECT_EQ(a, b);
    const size_t first = size_t(fresh.fabric().tree.leaf_offset[0]) * 4;
    EXPECT_GT(std::bit_cast<float>(a[first + W_LEAF_STEP]), std::bit_cast<float>(before[first + W_LEAF_STEP]));
    const std::vector<Ray> rays = primary_rays(fresh.bounds(), 10000, 5);
    const std::vector<Hit> found = refitted.trace(rays), expected = fresh.trace(rays);
    size_t hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      hits += expected[i].kind == W_HIT_PLY;
      ASSERT_TRUE(same_bits(found[i], expected[i])) << i;
    }
    EXPECT_GT(hits, rays.size() / 10);
    refitted.move(back.positions, back.normals);
    EXPECT_EQ(refitted.fabric().tree.leaves.read(test_device()), before);
  }
}

TEST(QuantisedVertices, SplitBuffersHoldTheSameLeaves) {
  const Fabric fabric = knit(make_tube(0.012, 0.02, 24, 4), 3);
  const FabricTracer whole(test_device(), fabric, 0.4f, LocalStage::exact, false, kQuantised);
  Device small = test_device();
  small.traits().max_alloc_bytes = whole.fabric().tree.leaves.bytes() / 3;
  const FabricTracer split(small, fabric, 0.4f, LocalStage::exact, false, kQuantised);
  ASSERT_TRUE(split.fabric().tree.leaves.split());
  const std::vector<Ray> rays = primary_rays(whole.bounds(), 10000, 3);
  const std::vector<Hit> a = whole.trace(rays), b = split.trace(rays);
  for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << i;
}

TEST(QuantisedVertices, CellStagesMeetWhatTheyMeetOfFloats) {
  const Fabric fabric = knit(make_swatch(0.02, 0.02, 4, 4), 3);
  const FabricTracer ring(test_device(), fabric, -1, LocalStage::ring, false, kQuantised);
  const FabricTracer full_ring(test_device(), fabric, -1, LocalStage::ring);
  const std::vector<Ray> rays = primary_rays(ring.bounds(), 10000, 3);
  const std::vector<Hit> b = ring.trace(rays), c = full_ring.trace(rays);
  size_t same = 0, hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hits += b[i].kind == W_HIT_PLY;
    same += b[i].kind == c[i].kind &&
            (b[i].kind != W_HIT_PLY || std::abs(b[i].t - c[i].t) < 0.01 * double(fabric.ply_radius));
  }
  EXPECT_GT(hits, rays.size() / 10);
  EXPECT_GT(double(same), 0.99 * double(rays.size()));
}

TEST(QuantisedVertices, PointsThatAreNoNumbersAreRefused) {
  const Fabric fabric = knit(make_swatch(0.02, 0.02, 2, 2), 3);
  FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, true, kQuantised);
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    Moved far = moved(fabric.mesh);
    far.positions[4] = wrong;
    EXPECT_THROW(tracer.move(far.positions, far.normals), Error) << wrong;
  }
  Strands strands = random_strands(30, 40, 1, 10, 0.2f, 7);
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    Strands far = strands;
    far.positions[301] = wrong;
    EXPECT_THROW(Tracer(test_device(), far, kQuantised), Error) << wrong;
  }
}

// Far from the scene's origin floats are coarser than 16 bits of a leaf: nothing more is lost there.
TEST(QuantisedVertices, FarFromTheOriginNothingIsLost) {
  Strands strands = helix(24, 8, 3.3, 2.5, 1.0f);
  for (float& x : strands.positions) x += 1e6f;
  const Tracer tracer(test_device(), strands, kQuantised);
  const Decoded d = decode(strands.patches, tracer.tree(), strands.positions);
  EXPECT_EQ(d.largest_error, 0);
  EXPECT_EQ(d.disagree, 0u);
}

TEST(QuantisedVertices, WhatTheyTakeAndHowFarTheyAreOff) {
  fmt::print("| plies | bytes a segment, leaves | quantised | largest error of a coordinate, ply radii |\n|---|---|---|---|\n");
  for (const int plies : {1, 2, 3, 5}) {
    const Fabric fabric = knit(make_swatch(0.05, 0.05, 2, 2), plies);
    const FabricTracer full(test_device(), fabric);
    const FabricTracer quantised(test_device(), fabric, -1, LocalStage::exact, false, kQuantised);
    const double segments = double(full.fabric().segment_count);
    const double bytes = double(full.fabric().tree.leaves.bytes()) / segments;
    const double fewer = double(quantised.fabric().tree.leaves.bytes()) / segments;
    const Decoded d = decode(patches_of(fabric, -1), quantised.fabric().tree, quantised.positions());
    fmt::print("| {} | {:.1f} | {:.1f} | {:.2g} |\n", plies, bytes, fewer, d.largest_error / fabric.ply_radius);
    EXPECT_LT(fewer, kQuantisedBytes * bytes) << plies;
    EXPECT_LT(d.largest_error, kQuantisedVertex * fabric.ply_radius) << plies;
  }
}

}  // namespace
}  // namespace wale::test
