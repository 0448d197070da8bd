// integrator.joints: what each level is, against every segment in double and in how far its surface lies from the
// mitred one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "geom/base_mesh_generators.h"
#include "geom/lattice_fabric.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/kernels/joint_rays.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr Joints kLevels[] = {Joints::open, Joints::capsule, Joints::mitre};
const char* name_of(Joints joints) {
  return joints == Joints::open ? "open" : joints == Joints::capsule ? "capsule" : "mitre";
}

bool same_bits(const Hit& a, const Hit& b) {
  return a.kind == b.kind && std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.u, &b.u, sizeof a.u) == 0 &&
         a.v == b.v && a.occluded == b.occluded;
}

/// Rays at joints from a few radii away, and what leaves their hits.
std::vector<Ray> rays_at_joints(const BruteForce& oracle, size_t count) {
  const std::vector<JointPair> joints = joints_of(oracle);
  Stream random{11};
  std::vector<Ray> rays;
  while (rays.size() < count) {
    Ray ray = ray_at(oracle, joints[random.next() % joints.size()], random);
    ray.tmax = 1e30f;
    rays.push_back(ray);
  }
  return rays;
}

/// Rays past the outermost points of segments' ends along the axes, square to them: boxes must hold these.
std::vector<Ray> rays_at_rims(const BruteForce& oracle, size_t count) {
  Stream random{13};
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const OracleSegment& s = oracle.segment(random.next() % oracle.segments());
    const dvec3 e = s.end - s.start;
    if (!(glm::length(e) > 0.01 * s.radius)) continue;
    dvec3 axis(0);
    axis[int(random.next() % 3)] = random.next() & 1 ? 1 : -1;
    const dvec3 a = glm::normalize(e), square = axis - glm::dot(axis, a) * a;
    if (glm::length(square) < 0.1) continue;
    const dvec3 at = random.next() & 1 ? s.start + 1e-3 * e : s.end - 1e-3 * e;
    const dvec3 d = glm::normalize(glm::cross(axis, random.direction()));
    rays.push_back(make_ray(at + 0.99 * s.radius * glm::normalize(square) - 20 * s.radius * d, d, 0));
  }
  return rays;
}

struct Strand {
  const char* name;
  Strands strands;
  double radius;
};
std::vector<Strand> strands() {
  return {{"helix", helix(24, 8, 3.3, 2.5, 1.0f), 1.0},
          {"random bends", random_strands(60, 12, 1.0, 12, 0.4f, 7), 0.4},
          {"stockinette", stockinette(3, 4, 40), 0.0029}};
}

// Differences of hit and miss only where float coordinates decide: rays that graze.
void agrees(const Strand& s, const BruteForce& oracle, const Tracer& tracer, const std::vector<Ray>& rays,
            const std::vector<Hit>& hits, Joints joints) {
  size_t differ = 0, hit = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const OracleHit e = oracle.closest(rays[i], rays[i].skip == W_NONE ? -1 : long(tracer.segment(rays[i].skip)));
    const bool is_hit = hits[i].kind == W_HIT_PLY;
    hit += is_hit;
    ASSERT_EQ(is_hit, hits[i].occluded != 0);
    const bool grazes = (is_hit && std::abs(hits[i].u) > 0.999f) || (e.hit && (std::abs(e.h) > 0.999 || e.edge < 1e-3));
    const double rounding = 1e-3 * s.radius + std::ldexp(e.hit ? e.t : 0, -22);
    differ += !grazes && (is_hit != e.hit || (is_hit && std::abs(hits[i].t - e.t) > rounding));
  }
  EXPECT_LE(differ, 1 + rays.size() / 20000) << s.name << ", " << name_of(joints);
  EXPECT_GT(hit, rays.size() / 20) << s.name;
}

TEST(JointLevels, AgreeWithBruteForceOverTheSamePrimitives) {
  for (const Strand& s : strands())
    for (const Joints joints : kLevels) {
      const BruteForce oracle(s.strands.patches, s.strands.positions, joints);
      Tracer tracer(test_device(), s.strands, joints);
      std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 5000, 3);
      const std::vector<Ray> aimed = rays_at_joints(oracle, 5000);
      rays.insert(rays.end(), aimed.begin(), aimed.end());
      const std::vector<Ray> rims = rays_at_rims(oracle, 5000);
      rays.insert(rays.end(), rims.begin(), rims.end());
      const std::vector<Hit> first = tracer.trace(rays, "-DW_LANES=16");
      agrees(s, oracle, tracer, rays, first, joints);
      const std::vector<Ray> bounce = bounce_rays(rays, first, tracer.surfaces(rays, first), 5);
      const std::vector<Hit> second = tracer.trace(bounce, "-DW_LANES=16");
      agrees(s, oracle, tracer, bounce, second, joints);
      // One ray at a time, by quantised nodes and in packets: the same bits.
      for (const char* options : {"-DW_LANES=1", "-DW_LANES=1 -DW_SIMT"}) {
        const std::vector<Hit> other = tracer.trace(bounce, options);
        for (size_t i = 0; i < bounce.size(); ++i) ASSERT_TRUE(same_bits(other[i], second[i])) << options << " " << i;
      }
      const std::vector<Hit> packets = tracer.trace_packets(rays);
      for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(packets[i].t, first[i].t) << s.name << ", " << name_of(joints) << " " << i;
        ASSERT_EQ(packets[i].code, first[i].code) << s.name << ", " << name_of(joints) << " " << i;
      }
    }
}

/// A ring of plies of radius 1 bent with curvature 1/R, `steps` segments a turn.
Strands ring(double R, uint32_t steps) {
  Strands s;
  s.add(1, steps + 3, 1.0f, [&](uint32_t, uint32_t i) {
    const double a = 2 * M_PI * (double(i) - 1) / steps;
    return dvec3(R * std::cos(a), R * std::sin(a), 0);
  }, true);
  return s;
}

/// Rays along the normal of the curved ply, on the outer side of its bend: how far from its surface they meet the
/// polyline.
constexpr int kGapRays = 20000;
constexpr double kShareOfGaps = 0.15;  // 1/sqrt(2700 lost rays) seven times, and that wedges are arcs
struct Gap {
  size_t lost = 0;        ///< rays that go in at a gap and meet nothing within two diameters
  double outside = 0, inside = 0;  ///< largest distance of a hit from the curved ply, radii
};
Gap gap_of(const Strands& s, double R, Joints joints) {
  Tracer tracer(test_device(), s, joints);
  std::vector<Ray> rays;
  Stream random{5};
  for (int i = 0; i < kGapRays; ++i) {
    const double a = 2 * M_PI * random.uniform(), b = M_PI * (random.uniform() - 0.5);
    const dvec3 out(std::cos(a), std::sin(a), 0), n = std::cos(b) * out + std::sin(b) * dvec3(0, 0, 1);
    rays.push_back(make_ray(R * out + 3.0 * n, -n, 0));
  }
  Gap gap;
  for (const Hit& hit : tracer.trace(rays, "-DW_LANES=16")) {
    if (hit.kind != W_HIT_PLY || hit.t > 2.5f) {
      ++gap.lost;
      continue;
    }
    gap.outside = std::max(gap.outside, 2.0 - double(hit.t));
    gap.inside = std::max(gap.inside, double(hit.t) - 2.0);
  }
  return gap;
}

// Bend b at each joint. The mitre's ridge stands out by 1/cos(b/2) - 1 outside of the bend. An open joint leaves a wedge
// of angle b round its vertex on the outer half of the ply, where rays along the curved ply's normal go in.
TEST(JointLevels, ErrorsOfABendInPlyRadii) {
  fmt::print("| bend, degrees | joints | rays lost | outside, radii | inside, radii |\n|---|---|---|---|---|\n");
  for (const uint32_t steps : {12u, 28u, 84u}) {
    const double R = 4, b = 2 * M_PI / steps, sag = R * (1 - std::cos(b / 2));
    Gap gaps[3];
    for (const Joints joints : kLevels) {
      const Gap gap = gaps[int(joints)] = gap_of(ring(R, steps), R, joints);
      fmt::print("| {:.1f} | {} | {:.2g} % | {:.3g} | {:.3g} |\n", b * 180 / M_PI, name_of(joints),
                 100.0 * double(gap.lost) / kGapRays, gap.outside, gap.inside);
    }
    EXPECT_GT(gaps[0].lost, 0u);
    EXPECT_EQ(gaps[1].lost, 0u);
    EXPECT_EQ(gaps[2].lost, 0u);
    // A capsule's spheres lie on the curved ply; the mitre stands out at joints; both fall short by the sag between.
    EXPECT_LT(gaps[1].outside, tolerance::kJointSurface);
    EXPECT_LE(gaps[1].inside, sag * (1 + tolerance::kJointSurface));
    EXPECT_LE(gaps[2].outside, 1 / std::cos(b / 2) - 1 + tolerance::kJointSurface);
    EXPECT_GT(gaps[2].outside, 0.5 * (1 / std::cos(b / 2) - 1));
    EXPECT_LE(gaps[2].inside, sag * (1 + tolerance::kJointSurface));
    // At azimuth b' from the outer side the wedge is b cos b' radii wide of b (R + cos b') in all.
    double expected = 0;
    for (int i = 0; i < 3600; ++i) {
      const double c = std::cos(M_PI * ((i + 0.5) / 3600 - 0.5));
      expected += c / (R + c) / 3600;
    }
    EXPECT_NEAR(double(gaps[0].lost) / kGapRays, expected, kShareOfGaps * expected);
  }
}

// Where plies do not bend, all levels meet rays alike; the bits may differ where spheres touch the side.
TEST(JointLevels, AStraightPlyIsTheSame) {
  Strands s;
  for (int row = 0; row < 8; ++row)
    s.add(1, 30, 0.45f, [&](uint32_t, uint32_t i) { return dvec3(i, 1.1 * row, 0); });
  Tracer mitre(test_device(), s), open(test_device(), s, Joints::open), capsule(test_device(), s, Joints::capsule);
  std::vector<Ray> rays;
  Stream random{3};
  for (int i = 0; i < 20000; ++i) {
    const dvec3 target(3 + 23 * random.uniform(), 8 * random.uniform(), 0), d = random.direction();
    if (std::abs(d.z) > 0.2) rays.push_back(make_ray(target - 5.0 * d, d, uint32_t(i)));
  }
  const std::vector<Hit> a = mitre.trace(rays, "-DW_LANES=16");
  const std::vector<Hit> others[] = {open.trace(rays, "-DW_LANES=16"), capsule.trace(rays, "-DW_LANES=16")};
  size_t differ[2] = {0, 0}, hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hits += a[i].kind == W_HIT_PLY;
    for (int k = 0; k < 2; ++k)
      differ[k] += a[i].kind != others[k][i].kind ||
                   std::abs(a[i].t - others[k][i].t) > float(tolerance::kJointSurface) * 0.45f;
  }
  EXPECT_GT(hits, rays.size() / 2);
  EXPECT_EQ(differ[0], 0u);
  EXPECT_EQ(differ[1], 0u);
}

TEST(JointLevels, ProceduralLeavesAreTheirStoredForm) {
  BaseMesh mesh = make_tube(0.02, 0.02, 24, 3);
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.lattice = 1;
  spec.storage = Storage::stored;
  const Fabric kept = knit_lattice(mesh, stockinette_pattern(0.004), spec);
  spec.storage = Storage::procedural;
  const Fabric warped = knit_lattice(mesh, stockinette_pattern(0.004), spec);
  std::vector<float> distances[3];
  for (const Joints joints : kLevels) {
    const FabricTracer stored(test_device(), kept, 0.4f, LocalStage::exact, false, joints);
    const FabricTracer procedural(test_device(), warped, 0.4f, LocalStage::exact, false, joints);
    ASSERT_EQ(procedural.fabric().tight_joints, 0u);
    ASSERT_EQ(procedural.fabric().vertex_count, 0u);
    const std::vector<Ray> rays = primary_rays(stored.bounds(), 6000, 1);
    const std::vector<Hit> a = stored.trace(rays), b = procedural.trace(rays);
    for (size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << name_of(joints) << " " << i;
    for (const Hit& hit : a) distances[int(joints)].push_back(hit.t);
  }
  EXPECT_NE(distances[0], distances[2]);
  EXPECT_NE(distances[1], distances[2]);
}

// Distances of what camera rays meet on a knit, against mitres: the price list of joints at this cloth's tolerance.
TEST(JointLevels, OnAKnitInPlyRadii) {
  fmt::print("| tolerance, radii | segments a stitch | joints | > 0.01 radii off | > 0.1 | > 1 | mean |off|, radii |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  for (const double tolerance : {0.05, 0.2}) {
    FabricSpec spec;
    spec.scale.kind = FabricScale::Kind::uv_metres;
    spec.tolerance = tolerance;
    const Fabric fabric = knit_fabric(make_swatch(0.012, 0.012, 8, 8), stockinette_pattern(0.004), spec);
    const double stitches = 0.012 * 0.012 / (fabric.report.stitch_metres.x * fabric.report.stitch_metres.y);
    const double stitch = double(fabric.report.segments) / spec.plies / stitches;  // segments of a ply
    std::vector<Hit> hits[3];
    std::vector<Ray> rays;
    for (const Joints joints : kLevels) {
      const FabricTracer tracer(test_device(), fabric, -1, LocalStage::exact, false, joints);
      if (rays.empty()) rays = primary_rays(tracer.bounds(), 20000, 3);
      hits[int(joints)] = tracer.trace(rays);
    }
    double deep[2] = {};
    for (const Joints joints : {Joints::open, Joints::capsule}) {
      size_t met = 0, over[3] = {};
      double sum = 0;
      for (size_t i = 0; i < hits[2].size(); ++i) {
        if (hits[2][i].kind != W_HIT_PLY) continue;
        ++met;
        const Hit& other = hits[int(joints)][i];
        const double off = other.kind == W_HIT_PLY ? std::abs(other.t - hits[2][i].t) / fabric.ply_radius : 10;
        over[0] += off > 0.01, over[1] += off > 0.1, over[2] += off > 1;
        sum += std::min(off, 10.0);
      }
      deep[int(joints)] = double(over[2]) / double(met);
      fmt::print("| {} | {:.1f} | {} | {:.2g} % | {:.2g} % | {:.2g} % | {:.2g} |\n", tolerance, stitch, name_of(joints),
                 100.0 * double(over[0]) / double(met), 100.0 * double(over[1]) / double(met),
                 100.0 * deep[int(joints)], sum / double(met));
    }
    EXPECT_GT(deep[0], 0.005);             // gaps show
    EXPECT_LT(deep[1], 0.1 * deep[0]);  // spheres close them
  }
}

// A tree that follows its mesh keeps its joints.
TEST(JointLevels, RefitKeepsThem) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  const Fabric fabric = knit_fabric(make_swatch(0.012, 0.012, 8, 8), stockinette_pattern(), spec);
  BaseMesh moved_mesh = fabric.mesh;
  for (dvec3& p : moved_mesh.position) p.z += 0.001 * std::sin(500 * p.x);
  compute_normals(moved_mesh);
  std::vector<float> positions, normals;
  for (size_t v = 0; v < moved_mesh.position.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      positions.push_back(float(moved_mesh.position[v][k]));
      normals.push_back(float(moved_mesh.normal[v][k]));
    }
  for (const Joints joints : kLevels) {
    FabricTracer followed(test_device(), fabric, -1, LocalStage::exact, true, joints);
    followed.move(positions, normals);
    const std::vector<uint32_t> leaves = followed.fabric().tree.leaves.read(test_device());
    size_t cuts = 0, spheres = 0, lanes = 0;
    for (size_t i = 0; i < fabric.patches.size(); ++i) {
      const uint32_t* leaf = leaves.data() + size_t(followed.fabric().tree.leaf_offset[i]) * 4;
      lanes += leaf[W_LEAF_LAYOUT] >> 8 & 255;
      cuts += size_t(std::popcount(leaf[W_LEAF_CUTS]));
      spheres += size_t(std::popcount(leaf[W_LEAF_SPHERES]));
    }
    if (joints == Joints::mitre) {
      EXPECT_LT(cuts, lanes);
    } else {
      EXPECT_EQ(cuts, 2 * lanes);
    }
    EXPECT_GE(spheres, joints == Joints::capsule ? lanes : 0);
    EXPECT_LT(spheres, joints == Joints::open ? 1 : lanes + lanes / 4);
    // Rays at joints agree with the segments in double: boxes hold them.
    BruteForce oracle(patches_of(fabric, -1), followed.fabric().warp->points().read(test_device()), joints);
    const std::vector<Ray> rays = rays_at_joints(oracle, 3000);
    const std::vector<Hit> hits = followed.trace(rays);
    size_t differ = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const OracleHit e = oracle.closest(rays[i]);
      const bool hit = hits[i].kind == W_HIT_PLY;
      const bool grazes = (hit && std::abs(hits[i].u) > 0.999f) || (e.hit && (std::abs(e.h) > 0.999 || e.edge < 1e-3));
      differ += !grazes && hit != e.hit;
    }
    EXPECT_LE(differ, 1u) << name_of(joints);
  }
}

}  // namespace
}  // namespace wale::test
