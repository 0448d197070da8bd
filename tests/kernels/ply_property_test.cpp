// Invariants of rays and plies on random curves: no shape, size or place of a ply breaks them.
#include <cmath>
#include <numbers>

#include "tests/kernels/synthetic.h"
#include "tests/property.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

using std::numbers::pi;

constexpr const char* kLanes = "-DW_LANES=16";
constexpr size_t kRays = 3000;
constexpr int kSide = 0;  // W_PIECE_SIDE of kernels/geometry/ply_segment.clh

/// A smooth random curve in radii.
struct Shape {
  uint32_t seed;
  double bend;    ///< largest angle per joint, radians
  double length;  ///< of a segment, at most; the shortest is a third of it
  uint32_t plies;
};

Shape random_shape() {
  return {*rc::gen::arbitrary<uint32_t>().as("seed"), *number_between(0, 0.6).as("bend"),
          *number_between(0.9, 6).as("length"), *rc::gen::inRange(1u, 4u).as("plies")};
}

using Move = std::function<dvec3(dvec3)>;

Strands curve_of(const Shape& shape, double radius, const Move& move) {
  constexpr uint32_t kPoints = 24;
  std::mt19937 random(shape.seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<dvec3> points{{0, 0, 0}};
  dvec3 d(1, 0, 0), turn(0, 0, 1);
  for (uint32_t i = 1; i < kPoints; ++i) {
    points.push_back(points.back() + shape.length * (0.67 + 0.33 * uniform(random)) * d);
    // Bends go on for a while to one side, as yarn does.
    turn = glm::normalize(turn + 0.4 * dvec3(uniform(random), uniform(random), uniform(random)));
    const dvec3 side = glm::cross(turn, d);
    if (glm::length(side) < 0.1) continue;
    const double angle = shape.bend * (0.5 + 0.5 * uniform(random));
    d = glm::normalize(std::cos(angle) * d + std::sin(angle) * glm::normalize(side));
  }
  Strands s;
  s.add(shape.plies, kPoints, float(radius),
        [&](uint32_t ply, uint32_t i) { return move(points[i] + 2.1 * ply * dvec3(0, 0, 1)); });
  return s;
}

Move scaled(double factor) {
  return [factor](dvec3 x) { return factor * x; };
}

std::vector<Ray> outward_rays(Tracer& tracer, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                              uint32_t seed) {
  return bounce_rays(rays, hits, tracer.surfaces(rays, hits), seed);
}

// What leaves a ply outward meets its own segment never, and anything else only where the oracle says so.
TEST(PlyProperty, RaysThatLeaveOutwardNeverComeBackToTheirSegment) {
  check_property(40, [] {
    const Shape shape = random_shape();
    const double radius = std::pow(10, *number_between(-5, 3).as("log radius"));
    const dvec3 offset = radius * *number_between(0, 1000).as("distance in radii") * dvec3(0.6, -0.64, 0.48);
    const Strands strands = curve_of(shape, radius, [&](dvec3 x) { return radius * x + offset; });
    Tracer tracer(test_device(), strands);
    const BruteForce oracle(strands.patches, strands.positions);
    const std::vector<Ray> rays = primary_rays(tracer.tree().bounds, kRays, shape.seed);
    const std::vector<Hit> hits = tracer.trace(rays, kLanes);
    const std::vector<Ray> outward = outward_rays(tracer, rays, hits, shape.seed + 1);
    RC_ASSERT(outward.size() > 20u);
    const std::vector<Hit> again = tracer.trace(outward, kLanes);
    for (size_t i = 0; i < outward.size(); ++i) {
      const long start = long(tracer.segment(outward[i].skip));
      const OracleHit expected = oracle.closest(outward[i], start);
      if (again[i].kind != W_HIT_PLY) {
        RC_ASSERT(!expected.hit || std::abs(expected.h) > 0.99 || expected.edge < 1e-3 ||
                  expected.t < 2 * tolerance::kPointFloat * radius);
        continue;
      }
      RC_ASSERT(long(tracer.segment(again[i].code)) != start);
      RC_ASSERT(expected.hit || std::abs(again[i].u) > 0.99 || again[i].t < 2 * tolerance::kPointFloat * radius);
    }
  });
}

// On both sides of every joint the same azimuth, length and smooth normal.
TEST(PlyProperty, AzimuthAndLengthAreContinuousAcrossJoints) {
  check_property(25, [] {
    Shape shape = random_shape();
    shape.length = 2 + shape.length;  // so long that every mitre fits
    const Strands strands = curve_of(shape, 1, scaled(1));
    Tracer tracer(test_device(), strands);
    std::mt19937 random(shape.seed);
    std::uniform_real_distribution<double> uniform(-pi, pi);
    const auto vertex = [&](size_t i) {
      const float* v = strands.positions.data() + i * 3;
      return dvec3(v[0], v[1], v[2]);
    };
    constexpr double kStep = 1e-3;  // how far each of the two rays stays from the joint, radii
    std::vector<Ray> rays;
    for (size_t n = 0; n < kRays; ++n) {
      const size_t v = 1 + random() % 22;
      const dvec3 p = vertex(v), t = glm::normalize(p - vertex(v - 1));
      const dvec3 m = glm::normalize(t + glm::normalize(vertex(v + 1) - p));
      const dvec3 x = glm::normalize(glm::cross(m, std::abs(m.z) < 0.6 ? dvec3(0, 0, 1) : dvec3(1, 0, 0)));
      const double a = uniform(random);
      const dvec3 radial = std::cos(a) * x + std::sin(a) * glm::cross(m, x);
      for (const double side : {-kStep, kStep})
        rays.push_back(make_ray(p + side * m + 1.5 * radial, -radial, uint32_t(n)));
    }
    const std::vector<Hit> hits = tracer.trace(rays, kLanes);
    const std::vector<Surface> at = tracer.surfaces(rays, hits);
    size_t compared = 0;
    for (size_t i = 0; i < rays.size(); i += 2) {
      if (hits[i].kind != W_HIT_PLY || hits[i + 1].kind != W_HIT_PLY) continue;
      if (at[i].segment + 1 != at[i + 1].segment) continue;
      if (int(hits[i].v) != kSide || int(hits[i + 1].v) != kSide) continue;
      ++compared;
      // Over 2 kStep the frame and the length go on by themselves: the length stretched on the inside of the bend.
      RC_ASSERT(std::abs(std::remainder(at[i].phi - at[i + 1].phi, 2 * pi)) < tolerance::kAcrossJoint);
      RC_ASSERT(std::abs(at[i].length - at[i + 1].length) < tolerance::kAcrossJoint);
      for (int k = 0; k < 3; ++k)
        RC_ASSERT(std::abs(at[i].smooth_n[k] - at[i + 1].smooth_n[k]) < tolerance::kAcrossJoint);
    }
    RC_ASSERT(compared > kRays / 8);
  });
}

// Every length times a power of two: every distance times it, and nothing else changes, to the last bit.
TEST(PlyProperty, PowersOfTwoScaleHitsToTheLastBit) {
  check_property(25, [] {
    const Shape shape = random_shape();
    const int power = *rc::gen::inRange(-16, 17).as("power");
    const float factor = std::ldexp(1.0f, power);
    const Strands one = curve_of(shape, 1, scaled(1)), other = curve_of(shape, factor, scaled(factor));
    Tracer a(test_device(), one), b(test_device(), other);
    const std::vector<Ray> rays = primary_rays(a.tree().bounds, kRays, shape.seed);
    std::vector<Ray> moved = rays;
    for (Ray& ray : moved)
      for (int k = 0; k < 3; ++k) ray.o[k] *= factor;
    const std::vector<Hit> x = a.trace(rays, kLanes), y = b.trace(moved, kLanes);
    size_t hit = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      RC_ASSERT(x[i].kind == y[i].kind);
      if (x[i].kind == W_HIT_NONE) continue;
      ++hit;
      RC_ASSERT(x[i].t * factor == y[i].t);
      RC_ASSERT(x[i].u == y[i].u);
      RC_ASSERT(x[i].v == y[i].v);
      RC_ASSERT(a.segment(x[i].code) == b.segment(y[i].code));
    }
    RC_ASSERT(hit > 20u);
  });
}

// Any scale, rotation and displacement by the curve's own size: the same segments at the same distances.
TEST(PlyProperty, ScaleAndRigidMotionKeepHits) {
  check_property(40, [] {
    const Shape shape = random_shape();
    const double factor = std::pow(10, *number_between(-4, 4).as("log scale"));
    const double a = *number_between(0, 2 * pi).as("turn"), tilt = *number_between(-1, 1).as("tilt");
    const dvec3 axis = glm::normalize(dvec3(std::cos(7 * a), std::sin(7 * a), tilt));
    const auto turned = [&](dvec3 x) {  // Rodrigues
      return std::cos(a) * x + std::sin(a) * glm::cross(axis, x) + (1 - std::cos(a)) * glm::dot(axis, x) * axis;
    };
    const dvec3 shift = *number_between(0, 100).as("shift") * dvec3(0.36, 0.48, -0.8);
    const auto move = [&](dvec3 x) { return factor * (turned(x) + shift); };
    const Strands one = curve_of(shape, 1, scaled(1)), other = curve_of(shape, factor, move);
    Tracer before(test_device(), one), after(test_device(), other);
    const std::vector<Ray> rays = primary_rays(before.tree().bounds, kRays, shape.seed);
    std::vector<Ray> moved;
    for (const Ray& ray : rays)
      moved.push_back(
          make_ray(move(dvec3(ray.o[0], ray.o[1], ray.o[2])), turned(dvec3(ray.d[0], ray.d[1], ray.d[2])), ray.key));
    const std::vector<Hit> x = before.trace(rays, kLanes), y = after.trace(moved, kLanes);
    size_t hit = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      // Coordinates are rounded anew: near a silhouette or a joint they may decide otherwise.
      if (x[i].kind == W_HIT_NONE || y[i].kind == W_HIT_NONE) {
        RC_ASSERT(x[i].kind == y[i].kind || std::max(std::abs(x[i].u), std::abs(y[i].u)) > 0.99f);
        continue;
      }
      ++hit;
      if (std::max(std::abs(x[i].u), std::abs(y[i].u)) > 0.99f || before.segment(x[i].code) != after.segment(y[i].code))
        continue;
      RC_ASSERT(std::abs(x[i].u - y[i].u) < tolerance::kMoved);
      // Along a ray that meets the ply flat the offset's rounding grows.
      RC_ASSERT(std::abs(x[i].t - y[i].t / factor) < 100 * tolerance::kMoved);
    }
    RC_ASSERT(hit > 20u);
  });
}

}  // namespace
}  // namespace wale::test
