// Rays aimed at what could leak: the planes where segments meet, the joins of patches and of closed yarns, on knitted
// fabrics that are bent and stretched and on synthetic strands.
//
// A leak: the ray meets the ply although its radius is taken 1e-4 smaller (the clearance), with |h| < 0.99, as double
// says of the few segments round the joint, and the kernels find nothing so near. There must be none. The rest, grazing
// rays and rays through the last 1e-4 radii of a corner, may differ from the oracle once in 1e6 rays; each is printed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/kernels/joint_rays.h"
#include "tests/kernels/parallel.h"

namespace wale::test {
namespace {

constexpr double kClearance = 1e-4;  // ply radii
constexpr double kClearH = 0.99;
constexpr double kGrazingShare = 1e-6;
constexpr size_t kBatch = 500000;

/// Nearest entry into the segments from two before the joint to two behind it.
SegmentEntry<double> local_entry(const BruteForce& oracle, JointPair joint, const Ray& ray, double shrink) {
  SegmentEntry<double> best;
  const auto take = [&](long i) {
    if (i < 0) return;
    const SegmentEntry<double> entry = segment_entry<double>(oracle.segment(size_t(i)), ray, shrink);
    if (entry.hit() && entry.t < best.t) best = entry;
  };
  const long before = oracle.before(joint.before), after = oracle.after(joint.after);
  for (const long i : {before, long(joint.before), long(joint.after), after}) take(i);
  return best;
}

struct Tally {
  std::atomic<size_t> rays{0}, inside{0}, clear{0}, leaks{0}, grazing{0}, started_inside{0};
};

template <typename Trace>
void aim(const char* name, const BruteForce& oracle, size_t rays, uint64_t seed, const Trace& trace, Tally& all) {
  const std::vector<JointPair> joints = joints_of(oracle);
  ASSERT_GT(joints.size(), 100u) << name;
  Tally tally;
  for (size_t first = 0; first < rays; first += kBatch) {
    const size_t count = std::min(kBatch, rays - first);
    std::vector<Ray> batch(count);
    std::vector<uint32_t> joint(count);
    parallel_for(count, [&](size_t i) {
      Stream random{seed * 0x632be59bd9b4e019ull + (first + i) * 0xd1342543de82ef95ull};
      joint[i] = uint32_t(random.next() % joints.size());
      batch[i] = ray_at(oracle, joints[joint[i]], random);
    });
    const std::vector<Hit> hits = trace(batch);
    parallel_for(count, [&](size_t i) {
      const JointPair at = joints[joint[i]];
      const SegmentEntry<double> sure = local_entry(oracle, at, batch[i], kClearance);
      const bool clear = sure.hit() && std::abs(sure.h) < kClearH;
      const SegmentEntry<double> entry = clear ? sure : local_entry(oracle, at, batch[i], 0);
      ++tally.rays;
      if (!entry.hit()) return;
      ++tally.inside;
      tally.clear += clear;
      // What is nearer than the shrunken ply is the ply itself or another in front of it. t is a float.
      const double room = std::ldexp(entry.t, -23) + (clear ? 0 : 0.1 * oracle.segment(at.before).radius);
      const bool found = hits[i].kind == W_HIT_PLY && hits[i].t <= entry.t + room;
      if (found) return;
      // A ray that starts between the ply and the shrunken ply starts inside: its entry lies behind it.
      if (clear) {
        const SegmentEntry<double> whole = local_entry(oracle, at, batch[i], 0);
        if (!whole.hit() || whole.t > entry.t) {
          ++tally.started_inside;
          return;
        }
      }
      ++(clear ? tally.leaks : tally.grazing);
      if (tally.leaks + tally.grazing > 200) return;
      const Ray& r = batch[i];
      fmt::print(
          "  {} {}: o {:a} {:a} {:a} d {:a} {:a} {:a}: oracle t {:.9g} h {:.6f} edge {:.2g} r, kernel {} t {:.9g}\n",
          clear ? "LEAK" : "grazing", name, r.o[0], r.o[1], r.o[2], r.d[0], r.d[1], r.d[2], entry.t, entry.h,
          entry.edge, hits[i].kind == W_HIT_PLY ? "hit" : "miss", hits[i].t);
    });
  }
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, joints.size(), tally.rays.load(), tally.inside.load(),
             tally.clear.load(), tally.started_inside.load(), tally.leaks.load(), tally.grazing.load());
  EXPECT_GT(double(tally.clear), 0.5 * double(rays)) << name;
  EXPECT_EQ(tally.leaks, 0u) << name;
  all.rays += tally.rays;
  all.grazing += tally.grazing;
}

/// Bent and stretched unevenly, so that segments of one ply differ in length.
BaseMesh stretched(BaseMesh mesh) {
  for (dvec3& p : mesh.position) p = {1.3 * p.x + 0.15 * p.z, 0.8 * p.y, p.z * (1 + 12 * p.z)};
  compute_normals(mesh);
  return mesh;
}

void aim_everywhere(size_t rays) {
  fmt::print(
      "| plies | joints | rays | meet the ply | with clearance | start inside | leaks | grazing "
      "|\n|---|---|---|---|---|---|---|---|\n");
  Tally all;
  struct Cloth {
    const char* name;
    BaseMesh mesh;
    int plies;
  };
  const Cloth cloths[] = {{"tube, stretched", stretched(make_tube(0.006, 0.025, 40, 9)), 3},
                          {"pillow, stretched", stretched(make_pillow(0.02, 0.02, 0.008, 9, 9)), 2},
                          {"draped square", make_draped_square(0.03, 0.008, 24), 5}};
  const size_t each = rays / (std::size(cloths) + 2);
  for (const Cloth& cloth : cloths) {
    FabricSpec spec;
    spec.name = cloth.name;
    spec.scale.kind = FabricScale::Kind::uv_metres;
    spec.plies = cloth.plies;
    const Fabric fabric = knit_fabric(cloth.mesh, stockinette_pattern(), spec);
    const FabricTracer tracer(test_device(), fabric);
    const BruteForce oracle(patches_of(fabric, -1), tracer.positions());
    aim(
        cloth.name, oracle, each, 1, [&](const std::vector<Ray>& batch) { return tracer.trace(batch); }, all);
  }
  const std::pair<const char*, Strands> strands[] = {{"helix", helix(20, 12, 3.3, 2.0, 1.0f)},
                                                     {"random bends", random_strands(60, 14, 1.0, 14, 0.4f, 3)}};
  const std::string lanes = fmt::format("-DW_LANES={}", test_device().traits().lanes);
  for (const auto& [name, strand] : strands) {
    Tracer tracer(test_device(), strand);
    const BruteForce oracle(strand.patches, strand.positions);
    aim(
        name, oracle, each, 2, [&](const std::vector<Ray>& batch) { return tracer.trace(batch, lanes); }, all);
  }
  EXPECT_LE(double(all.grazing), kGrazingShare * double(all.rays));
}

TEST(Watertight, JointsSeamsAndBorders) { aim_everywhere(2000000); }

TEST(Watertight, JointsSeamsAndBordersOften) {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  if (!wanted || std::strcmp(wanted, "1") != 0) GTEST_SKIP() << "long test: ./wale test --long";
  aim_everywhere(100000000);
}

}  // namespace
}  // namespace wale::test
