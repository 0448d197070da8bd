// Rays that leave a ply outward: none meets the ply it left, and none passes a neighbour that it should meet. What
// starts inside another ply that overlaps is counted: policy ignores the ply a ray starts in.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/kernels/joint_rays.h"
#include "tests/kernels/parallel.h"

namespace wale::test {
namespace {

constexpr size_t kPrimary = 200000;

struct Tally {
  size_t rays = 0, meet = 0;
  size_t self = 0;      ///< a hit on the ply that the ray left, where the oracle has none so near
  size_t missed = 0;    ///< the oracle meets a ply, and the kernels nothing or something farther
  size_t grazing = 0;   ///< either of the two where one of the entries is closer than 1e-4 radii to no entry at all
  size_t overlaps = 0;  ///< starts inside another ply
};

/// x lies inside the segment's cylinder, by more than the rounding of a hit.
bool inside(const OracleSegment& s, dvec3 x) {
  const dvec3 e = s.end - s.start, y = x - s.start;
  const double ll = glm::dot(e, e), z = glm::dot(y, e);
  if (!(z > 0 && z < ll)) return false;
  return glm::dot(y, y) - z * z / ll < s.radius * s.radius * (1 - 1e-3);
}

/// The ray turned or moved by about 1e-5 radii meets something else: its own answer is the rounding's.
bool undecided(const BruteForce& oracle, const Ray& ray, long from, double radius, const OracleHit& expected) {
  for (const double shift : {-3e-5, 3e-5})
    for (int k = 0; k < 3; ++k) {
      Ray moved = ray;
      moved.l[k] = float(moved.l[k] + shift * radius);
      const OracleHit e = oracle.closest(moved, from);
      if (e.hit != expected.hit || std::abs(e.t - expected.t) > 0.05 * radius) return true;
    }
  return false;
}

void leave(const char* name, BaseMesh mesh, int plies, size_t rays) {
  FabricSpec spec;
  spec.name = name;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = plies;
  spec.tolerance = 0.1;
  const Fabric fabric = knit_fabric(std::move(mesh), stockinette_pattern(), spec);
  const FabricTracer tracer(test_device(), fabric);
  const BruteForce oracle(patches_of(fabric, -1), tracer.positions());
  const double r = fabric.ply_radius;
  const std::vector<JointPair> joints = joints_of(oracle);
  Tally tally;
  for (uint32_t round = 0; tally.rays < rays; ++round) {
    // Every other one starts at a joint, where a neighbour is at hand.
    std::vector<Ray> primary = primary_rays(tracer.bounds(), std::min(kPrimary, 2 * rays), 100 + round);
    for (size_t i = 0; i < primary.size(); i += 2) {
      Stream random{(uint64_t(round) << 32 | i) * 0xd1342543de82ef95ull};
      primary[i] = ray_at(oracle, joints[random.next() % joints.size()], random);
    }
    const std::vector<Hit> first = tracer.trace(primary);
    std::vector<Ray> out = bounce_rays(primary, first, tracer.surfaces(primary, first), round);
    out.resize(std::min(out.size(), rays - tally.rays));
    const std::vector<Hit> hits = tracer.trace(out);
    std::vector<uint8_t> overlap(out.size()), grazing(out.size());
    std::vector<OracleHit> expected(out.size());
    parallel_for(out.size(), [&](size_t i) {
      const long from = long(tracer.segment(out[i].skip));
      expected[i] = oracle.closest(out[i], from);
      const dvec3 x = dvec3(out[i].o[0], out[i].o[1], out[i].o[2]) + dvec3(out[i].l[0], out[i].l[1], out[i].l[2]);
      overlap[i] = oracle.any_near(x, [&](const OracleSegment& s) { return long(s.id) != from && inside(s, x); });
      const bool same = (hits[i].kind == W_HIT_PLY) == expected[i].hit &&
                        (!expected[i].hit || std::abs(double(hits[i].t) - expected[i].t) < 1e-2 * r);
      grazing[i] = !same && undecided(oracle, out[i], from, r, expected[i]);
    });
    for (size_t i = 0; i < out.size(); ++i, ++tally.rays) {
      const OracleHit& e = expected[i];
      const bool hit = hits[i].kind == W_HIT_PLY;
      tally.meet += hit;
      tally.overlaps += overlap[i];
      if (grazing[i]) {
        ++tally.grazing;
        continue;
      }
      const bool nearer = hit && (!e.hit || hits[i].t < e.t - 1e-2 * r),
                 farther = e.hit && (!hit || hits[i].t > e.t + 1e-2 * r);
      tally.self += nearer;
      tally.missed += farther;
      if (nearer || farther)
        fmt::print(
            "  {} ray {}: kernel {} t {:.6g} r segment {} h {:.6f}, oracle {} t {:.6g} r segment {} h {:.6f} edge "
            "{:.2g}, from {}\n",
            name, i, hit, hits[i].t / r, hit ? tracer.segment(hits[i].code) : 0, hits[i].u, e.hit, e.t / r, e.segment,
            e.h, e.edge, tracer.segment(out[i].skip));
    }
  }
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", name, oracle.segments(), tally.rays, tally.meet,
             tally.overlaps, tally.self, tally.missed, tally.grazing);
  EXPECT_GT(tally.meet, rays / 5);
  EXPECT_EQ(tally.self, 0u) << name;
  EXPECT_EQ(tally.missed, 0u) << name;
  EXPECT_LE(double(tally.grazing), 2e-5 * double(tally.rays)) << name;
}

void leave_all(size_t rays) {
  fmt::print("| fabric | segments | rays | meet a ply | start in an overlap | self-hits | missed | undecided |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  leave("tube, 3 plies", make_tube(0.002, 0.008, 24, 6), 3, rays / 3);
  leave("draped square, 2 plies", make_draped_square(0.01, 0.003, 16), 2, rays / 3);
  leave("swatch, 5 plies", make_swatch(0.008, 0.008, 2, 2), 5, rays - 2 * (rays / 3));
}

TEST(Reintersection, RaysLeaveTheirPly) { leave_all(300000); }

TEST(Reintersection, RaysLeaveTheirPlyOften) {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  if (!wanted || std::strcmp(wanted, "1") != 0) GTEST_SKIP() << "long test: ./wale test --long";
  leave_all(10000000);
}

}  // namespace
}  // namespace wale::test
