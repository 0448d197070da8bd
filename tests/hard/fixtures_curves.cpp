#include "tests/hard/fixtures_curves.h"

#include <cmath>
#include <numbers>

namespace wale::test {
namespace {

using std::numbers::pi;

HardCurve single(std::vector<dvec3> points) { return {{std::move(points)}}; }

dvec3 on_circle(double radius, double angle, double rise = 0) {
  return {radius * std::cos(angle), radius * std::sin(angle), rise};
}

}  // namespace

HardCurve one_segment() { return single({{0, 0, 0}, {3, 1, 0.5}}); }

HardCurve zero_length_segment() {
  return single({{-6, 0, 0}, {-2, 0, 0}, {0, 1, 0}, {0, 1, 0}, {2, 3, 0.5}, {5, 7, 1}});
}

HardCurve repeated_points() {
  std::vector<dvec3> points;
  for (int i = 0; i < 5; ++i)
    for (int copy = 0; copy < 3; ++copy) points.push_back(dvec3(3 * i, std::sin(1.3 * i), 0.4 * i));
  return single(points);
}

HardCurve fold() { return single({{0, 0, 0}, {6, 0, 0}, {1, 0, 0}, {8, 0, 0}}); }

HardCurve spike() {
  const double turn = 170 * pi / 180;
  return single({{-8, 0, 0}, {0, 0, 0}, {8 * std::cos(turn), 8 * std::sin(turn), 0}, {-8, 9, 3}});
}

HardCurve bend_tighter_than_radius() {
  std::vector<dvec3> points = {{-6, -0.5, 0}, {-2, -0.5, 0}};
  for (int i = 0; i <= 8; ++i) points.push_back(on_circle(0.5, -0.5 * pi + pi * i / 8));
  points.push_back({-2, 0.5, 0});
  points.push_back({-6, 0.5, 0.3});
  return single(points);
}

HardCurve loop_inside_itself() {
  std::vector<dvec3> points;
  for (int i = 0; i <= 72; ++i) points.push_back(on_circle(0.7, 2 * pi * i / 24, 2.0 * i / 24));
  return single(points);
}

HardCurve nearly_too_tight() {
  std::vector<dvec3> points;
  for (int i = 0; i <= 60; ++i) points.push_back(on_circle(1.05, 2 * pi * i / 20, 2.2 * i / 20));
  return single(points);
}

HardCurve unequal_lengths() {
  std::vector<dvec3> points = {{0, 0, 0}};
  const double lengths[] = {40, 0.1, 1, 0.001, 1, 40, 0.001, 0.1, 1, 0.1, 40, 1};
  for (size_t i = 0; i < std::size(lengths); ++i) {
    // Bends so small that the shortest segment still holds its mitres, but for the one of 0.001 that goes straight on.
    const double angle = i < 4 ? 0.01 : 0.02;
    points.push_back(points.back() + lengths[i] * dvec3(std::cos(angle), std::sin(angle), i > 7 ? 0.02 : 0.0));
  }
  return single(points);
}

HardCurve open_ends() {
  HardCurve curve;
  for (int ply = 0; ply < 4; ++ply)
    curve.plies.push_back({{3.0 * ply, 0, 0}, {3.0 * ply + 1.5, 0.1, 0}, {3.0 * ply + 2.5, 0, 0.1}});
  return curve;
}

HardCurve eight_plies() {
  HardCurve curve;
  for (int ply = 0; ply < 8; ++ply) {
    std::vector<dvec3> points;
    for (int i = 0; i <= 20; ++i) {
      const double along = 1.5 * i, turn = 0.2 * i + 2 * pi * ply / 8;
      points.push_back(dvec3(along, 2.7 * std::cos(turn) + 3 * std::sin(0.2 * along), 2.7 * std::sin(turn)));
    }
    curve.plies.push_back(points);
  }
  return curve;
}

HardCurve overlapping_plies() {
  HardCurve curve;
  for (int ply = 0; ply < 3; ++ply) {
    std::vector<dvec3> points;
    for (int i = 0; i <= 16; ++i) {
      const double turn = 0.3 * i + 2 * pi * ply / 3, out = 0.5 / std::sqrt(3.0);
      points.push_back(dvec3(1.2 * i, out * std::cos(turn), out * std::sin(turn)));
    }
    curve.plies.push_back(points);
  }
  return curve;
}

HardCurve straight(size_t segments, double length) {
  std::vector<dvec3> points;
  for (size_t i = 0; i <= segments; ++i) points.push_back(dvec3(length * double(i), 0, 0));
  return single(points);
}

HardCurve helix_curve() {
  std::vector<dvec3> points;
  for (int i = 0; i <= 60; ++i) points.push_back(on_circle(3.3, 2 * pi * i / 20, 2.5 * i / 20));
  return single(points);
}

Strands strands_of(const HardCurve& curve, double scale, dvec3 offset) {
  Strands s;
  s.add(uint32_t(curve.plies.size()), uint32_t(curve.plies[0].size()), float(scale),
        [&](uint32_t ply, uint32_t i) { return offset + scale * curve.plies[ply][i]; });
  return s;
}

dvec3 vertex_of(const Strands& strands, size_t vertex) {
  const float* v = strands.positions.data() + vertex * 3;
  return {v[0], v[1], v[2]};
}

std::vector<Ray> aimed_rays(const Strands& strands, size_t count, double distance, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto direction = [&] { return glm::normalize(dvec3(normal(random), normal(random), normal(random))); };
  std::vector<Ray> rays;
  for (size_t n = 0; n < count; ++n) {
    const PlyPatch& patch = strands.patches[random() % strands.patches.size()];
    const size_t v =
        patch.first_vertex + (random() % patch.plies) * patch.count + patch.first + random() % patch.intervals;
    const dvec3 a = vertex_of(strands, v), b = vertex_of(strands, v + 1);
    const double r = patch.radius;
    const dvec3 d = direction();
    const dvec3 target = a + uniform(random) * (b - a) + 0.95 * r * std::cbrt(uniform(random)) * direction();
    rays.push_back(make_ray(target - distance * r * d, d, uint32_t(n)));
  }
  return rays;
}

Pattern tile_of(const HardCurve& curve, double radius) {
  Pattern p;
  p.name = "hard";
  p.yarn_radius = radius;
  p.stitches = ivec2(1, 1);
  PatternCurve out;
  double low = 0, high = 0;
  for (const dvec3& x : curve.plies[0]) {
    out.points.push_back(radius * x);
    low = std::min(low, radius * x.y);
    high = std::max(high, radius * x.y);
  }
  const dvec3 first = out.points.front(), last = out.points.back();
  p.period = dvec2(last.x - first.x, high - low + 3 * radius);
  for (dvec3& x : out.points) {
    const double share = (x.x - first.x) / p.period.x;
    x -= dvec3(first.x, share * (last.y - first.y), share * (last.z - first.z));
  }
  p.curves.push_back(out);
  return p;
}

}  // namespace wale::test
