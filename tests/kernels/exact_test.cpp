// The exact local stage on knitted fabrics against every segment in double: flat, closed to a tube, draped; 2, 3 and 5
// plies; primary rays and what bounces off the cloth.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <future>
#include <thread>

#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

struct Cloth {
  const char* name;
  int plies;
  BaseMesh (*mesh)(double size);
};

BaseMesh swatch(double size) { return make_swatch(size, size, 4, 4); }
BaseMesh tube(double size) { return make_tube(size / 6, size, 48, 8); }
BaseMesh draped(double size) { return make_draped_square(size, size / 4, 32); }

const Cloth kThree[] = {
    {"swatch, 3 plies", 3, swatch}, {"tube, 3 plies", 3, tube}, {"draped square, 3 plies", 3, draped}};
const Cloth kOthers[] = {{"tube, 2 plies", 2, tube}, {"draped square, 5 plies", 5, draped}};

/// Stockinette with stitches 2 mm wide on a cloth just large enough for about that many segments (a coarser polyline
/// where the cloth would have no four stitches).
Fabric knit(const Cloth& cloth, double segments) {
  FabricSpec spec;
  spec.name = cloth.name;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.plies = cloth.plies;
  if (segments < 10000) spec.tolerance = 0.1;
  double size = 0.02;
  for (int pass = 0; pass < 4; ++pass) {
    const double now = double(estimate_segments(cloth.mesh(size), stockinette_pattern(), spec));
    size = std::max(0.008, size * std::sqrt(segments / now));
  }
  return knit_fabric(cloth.mesh(size), stockinette_pattern(), spec);
}

std::vector<OracleHit> brute_force(const BruteForce& oracle, const FabricTracer& tracer, const std::vector<Ray>& rays) {
  std::vector<OracleHit> hits(rays.size());
  const size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<void>> parts;
  for (size_t part = 0; part < threads; ++part)
    parts.push_back(std::async(std::launch::async, [&, part] {
      for (size_t i = part; i < rays.size(); i += threads)
        hits[i] = oracle.closest(rays[i], rays[i].skip == W_NONE ? -1 : long(tracer.segment(rays[i].skip)));
    }));
  for (auto& part : parts) part.get();
  return hits;
}

struct Tally {
  size_t rays = 0, hits = 0;
  size_t grazing = 0;  ///< hit against miss, or another segment, where the ray only grazes one of them
  size_t rounded = 0;  ///< same segment, t apart by more than 1e-3 r, the lines' offsets equal but for rounding
  size_t wrong = 0;    ///< everything else
  double worst = 0;    ///< |dt| / r of the hits that agree
};

// Where float and double may part:
// - |h| so near 1 that the rounding of float coordinates decides, or an entry on the very edge of a joint;
// - the same segment, but at an angle so flat that the rounding of coordinates, 2^-23 of the distance, becomes more
// than
//   1e-3 r along the ray: dt = dh h / sqrt(1 - h^2).
// Each such ray is printed and none is left out of the count.
void compare(Tally& tally, const Cloth& cloth, const Fabric& fabric, const FabricTracer& tracer,
             const std::vector<Ray>& rays, const std::vector<Hit>& hits, const std::vector<OracleHit>& expected) {
  const double r = fabric.ply_radius;
  for (size_t i = 0; i < rays.size(); ++i, ++tally.rays) {
    const OracleHit& e = expected[i];
    const bool hit = hits[i].kind == W_HIT_PLY;
    tally.hits += hit;
    const double dt = hit && e.hit ? std::abs(hits[i].t - e.t) / r : 0;
    if (hit == e.hit && dt <= 1e-3 && hit == (hits[i].occluded != 0)) {
      tally.worst = std::max(tally.worst, dt);
      continue;
    }
    const uint32_t segment = hit ? tracer.segment(hits[i].code) : W_NONE;
    const bool same = hit && e.hit && segment == e.segment;
    const bool rounded = same && std::abs(hits[i].u - e.h) <= std::ldexp(e.t / r, -23) && dt < 1e-2;
    const bool grazes =
        !same && (std::max(hit ? std::abs(hits[i].u) : 0.0f, e.hit ? float(std::abs(e.h)) : 0.0f) > 0.999f ||
                  (e.hit && e.edge < 1e-3));
    ++(rounded ? tally.rounded : grazes ? tally.grazing : tally.wrong);
    fmt::print(
        "  {}, {} ray {}: device {} t {:.9g} h {:.6f} piece {} segment {}, double {} t {:.9g} h {:.6f} piece {} "
        "segment {} edge {:.3g} r, |dt| {:.3g} r: {}\n",
        cloth.name, rays[i].skip == W_NONE ? "primary" : "bounce", i, hit ? "hit" : "miss", hits[i].t, hits[i].u,
        hits[i].v, segment, e.hit ? "hit" : "miss", e.t, e.h, e.piece, e.segment, e.edge, dt,
        rounded  ? "rounded"
        : grazes ? "grazing"
                 : "wrong");
  }
}

void check(const Cloth& cloth, double segments, size_t rays, double most_rounded = 1e-5) {
  const Fabric fabric = knit(cloth, segments);
  const FabricTracer tracer(test_device(), fabric);
  const BruteForce oracle(patches_of(fabric, -1), tracer.positions());
  ASSERT_EQ(oracle.segments(), tracer.fabric().segment_count);
  EXPECT_GT(double(oracle.segments()), 0.7 * segments);
  std::vector<Ray> primary = primary_rays(tracer.bounds(), rays, 3);
  const std::vector<Hit> first = tracer.trace(primary);
  std::vector<Ray> bounce = bounce_rays(primary, first, tracer.surfaces(primary, first), 5);
  // As many rays as asked for, in all.
  const size_t bounces = std::min(bounce.size(), rays / 2);
  bounce.resize(bounces);
  primary.resize(rays - bounces);
  Tally tally;
  compare(tally, cloth, fabric, tracer, primary, first, brute_force(oracle, tracer, primary));
  compare(tally, cloth, fabric, tracer, bounce, tracer.trace(bounce), brute_force(oracle, tracer, bounce));
  fmt::print("| {} | {} | {} | {} | {:.1f} % | {} | {} | {} | {:.2g} |\n", cloth.name, oracle.segments(),
             primary.size(), bounce.size(), 100.0 * double(tally.hits) / double(tally.rays), tally.grazing,
             tally.rounded, tally.wrong, tally.worst);
  EXPECT_GT(bounce.size(), rays / 5) << cloth.name;
  EXPECT_EQ(tally.wrong, 0u) << cloth.name;
  EXPECT_LE(double(tally.grazing), 1e-5 * double(tally.rays)) << cloth.name;
  EXPECT_LE(double(tally.rounded), most_rounded * double(tally.rays)) << cloth.name;
  EXPECT_EQ(tracer.stack_overflows(), 0u);
}

constexpr const char* kHeader =
    "| fabric | segments | primary | bounce | hit | grazing | rounded | wrong | worst other dt / r "
    "|\n|---|---|---|---|---|---|---|---|---|\n";

TEST(Exact, AgreesWithBruteForceOnKnittedFabrics) {
  fmt::print("{}", kHeader);
  for (const Cloth& cloth : kThree) check(cloth, 5000, 100000);
  for (const Cloth& cloth : kOthers) check(cloth, 5000, 100000);
}

TEST(Exact, AgreesWithBruteForceOnLargeFabrics) {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  if (!wanted || std::strcmp(wanted, "1") != 0) GTEST_SKIP() << "long test: ./wale test --long";
  fmt::print("{}", kHeader);
  for (const Cloth& cloth : kThree) check(cloth, 20000, 1000000);
  for (const Cloth& cloth : kOthers) check(cloth, 20000, 1000000);
  // 170 mm of cloth with plies of 0.1 mm: a float at that distance is 1.4e-4 r wide, so that flat angles are rounded
  // more often, by 3e-3 r at most.
  for (const Cloth& cloth : kThree) check(cloth, 1e6, 100000, 5e-4);
}

}  // namespace
}  // namespace wale::test
