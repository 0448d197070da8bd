// Yarns of every tile in scenes/patterns touch as real ones do, measured on the files by brute force: all pairs of
// segments in all tiles that may be near.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "geom/pattern.h"
#include "geom/stitch.h"
#include "geom/yarn_spline.h"

namespace wale {
namespace {

// What the cloth is asked for (docs/patterns.md), yarn diameters.
constexpr double kLeast = 0.95, kTouch = 1.0;
// Points of one yarn with less of it between them are neighbours: a bend of the yarn, no contact.
constexpr double kNeighbours = 2;

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const auto& file : std::filesystem::directory_iterator(WALE_SOURCE_DIR "/scenes/patterns"))
    if (file.path().extension() == ".json") out.push_back(file.path().stem());
  std::sort(out.begin(), out.end());
  return out;
}

struct Line {
  dvec3 a, b;
  size_t yarn;
  double arc;  // of the yarn up to a
};

struct Yarns {
  std::vector<Line> lines;
  std::vector<double> length;  // of one lap
  std::vector<ivec2> shift;
  dvec2 period{0, 0};
};

// Centrelines in yarn diameters: the spline that is rendered, in `parts` pieces per span; 1: the points of the file.
Yarns centrelines(const Pattern& tile, int parts) {
  Yarns out;
  const double diameter = 2 * tile.yarn_radius;
  out.period = tile.period / diameter;
  for (const YarnChain& chain : tile_yarns(tile, match_partners(tile))) {
    const YarnSpline spline(tile, chain, dvec3(1 / diameter));
    double arc = 0;
    dvec3 a = spline.position(0, 0);
    for (int span = 0; span < spline.spans(); ++span)
      for (int k = 1; k <= parts; ++k) {
        const dvec3 b = spline.position(span, double(k) / parts);
        out.lines.push_back({a, b, out.length.size(), arc});
        arc += glm::distance(a, b);
        a = b;
      }
    out.length.push_back(arc);
    out.shift.push_back(chain.shift);
  }
  return out;
}

struct Near {
  double distance = INFINITY, s = 0, t = 0;
};

void point_to_line(const dvec3& p, const dvec3& a, const dvec3& b, double s_or_t, bool first, Near& best) {
  const dvec3 d = b - a;
  const double u = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0), far = glm::distance(p, a + u * d);
  if (far < best.distance) best = first ? Near{far, s_or_t, u} : Near{far, u, s_or_t};
}

// Of two segments: the least of the four from an end and, where it lies within both, the common perpendicular.
Near nearest(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  Near best;
  point_to_line(a, c, d, 0, true, best);
  point_to_line(b, c, d, 1, true, best);
  point_to_line(c, a, b, 0, false, best);
  point_to_line(d, a, b, 1, false, best);
  const dvec3 u = b - a, v = d - c, w = a - c, n = glm::cross(u, v);
  if (const double nn = glm::dot(n, n); nn > 0) {
    const double s = glm::dot(glm::cross(v, w), n) / nn, t = glm::dot(glm::cross(u, w), n) / nn;
    if (s > 0 && s < 1 && t > 0 && t < 1)
      if (const double far = std::abs(glm::dot(w, n)) / std::sqrt(nn); far < best.distance) best = {far, s, t};
  }
  return best;
}

// Yarn between two places of one yarn, of which the second lies `image` periods away; infinite where it never leads
// there.
double arc_between(const Yarns& y, const Line& f, const Line& g, const Near& near, ivec2 image) {
  if (f.yarn != g.yarn) return INFINITY;
  const ivec2 shift = y.shift[f.yarn];
  const int laps = shift.x ? image.x / shift.x : image.y / shift.y;
  if (laps * shift != image) return INFINITY;
  return std::abs(g.arc + near.t * glm::distance(g.a, g.b) + laps * y.length[f.yarn] - f.arc -
                  near.s * glm::distance(f.a, f.b));
}

// Least distance of two places that are no neighbours, of all tiles.
double closest(const Yarns& y) {
  constexpr double kReach = 1.5;
  dvec2 low(INFINITY), high(-INFINITY);
  double longest = 0;
  for (const Line& l : y.lines) {
    low = glm::min(low, dvec2(l.a)), high = glm::max(high, dvec2(l.a));
    longest = std::max(longest, glm::distance(l.a, l.b));
  }
  const ivec2 images(glm::ceil((high - low + kReach + 2 * longest) / y.period));
  double best = kReach;
  for (int ix = -images.x; ix <= images.x; ++ix)
    for (int iy = -images.y; iy <= images.y; ++iy) {
      const dvec3 by(dvec2(ix, iy) * y.period, 0);
      for (size_t i = 0; i < y.lines.size(); ++i)
        for (size_t j = i; j < y.lines.size(); ++j) {
          const Line &f = y.lines[i], &g = y.lines[j];
          if ((i == j && ix == 0 && iy == 0) || glm::distance(f.a, g.a + by) > best + 2 * longest) continue;
          const Near near = nearest(f.a, f.b, g.a + by, g.b + by);
          if (near.distance < best && arc_between(y, f, g, near, {ix, iy}) >= kNeighbours) best = near.distance;
        }
    }
  return best;
}

class BundledContact : public testing::TestWithParam<std::string> {};

TEST_P(BundledContact, YarnsTouchAndNoneIsPressedIn) {
  const Pattern tile = read_pattern(std::filesystem::path(WALE_SOURCE_DIR "/scenes/patterns") / (GetParam() + ".json"));
  const double points = closest(centrelines(tile, 1)), curve = closest(centrelines(tile, 4));
  std::printf("  %-20s closest %.4f yarn diameters, %.4f of the curves through the points\n", GetParam().c_str(),
              points, curve);
  EXPECT_GE(points, kLeast);
  EXPECT_LE(points, kTouch);
  EXPECT_GE(curve, kLeast);
  EXPECT_LE(curve, kTouch);
}

TEST(BundledContact, AllSixteen) { EXPECT_GE(names().size(), 16u); }

INSTANTIATE_TEST_SUITE_P(Tiles, BundledContact, testing::ValuesIn(names()), [](const auto& p) { return p.param; });

// A yarn across a tile, bent like a hair pin of two limbs 0.6 apart, in pieces of 0.3.
Yarns hair_pin(double limb) {
  Yarns y;
  y.period = {9, 9};
  const std::vector<dvec3> corners = {{0, 0, 0},          {3, 0, 0},   {3, 0.6, 0}, {3 - limb, 0.6, 0},
                                      {3 - limb, 4.5, 0}, {9, 4.5, 0}, {9, 0, 0}};
  double arc = 0;
  for (size_t c = 0; c + 1 < corners.size(); ++c) {
    const double length = glm::distance(corners[c], corners[c + 1]);
    const int pieces = int(std::round(length / 0.3));
    for (int k = 0; k < pieces; ++k, arc += length / pieces)
      y.lines.push_back({glm::mix(corners[c], corners[c + 1], double(k) / pieces),
                         glm::mix(corners[c], corners[c + 1], double(k + 1) / pieces), 0, arc});
  }
  y.length = {arc}, y.shift = {{1, 0}};
  return y;
}

// The measure itself, where the answer is known: segments; straight yarns, which are nearer to each other in the next
// tile than in their own; and a bend, whose limbs count only where two diameters of yarn or more are between them.
TEST(BundledContact, MeasureIsRight) {
  EXPECT_DOUBLE_EQ(nearest({0, 0, 0}, {2, 0, 0}, {1, -1, 0.5}, {1, 1, 0.5}).distance, 0.5);
  EXPECT_DOUBLE_EQ(nearest({0, 0, 0}, {2, 0, 0}, {0, 0.7, 0}, {2, 0.7, 0}).distance, 0.7);
  EXPECT_DOUBLE_EQ(nearest({0, 0, 0}, {1, 0, 0}, {4, 4, 0}, {9, 9, 0}).distance, 5);
  Yarns y;
  y.period = {4, 1.94};
  for (int i = 0; i < 4; ++i) y.lines.push_back({{i, 0, 0}, {i + 1, 0, 0}, 0, double(i)});
  for (int i = 0; i < 4; ++i) y.lines.push_back({{i, 1.1, 0}, {i + 1, 1.1, 0}, 1, double(i)});
  y.length = {4, 4}, y.shift = {{1, 0}, {1, 0}};
  EXPECT_NEAR(closest(y), 1.94 - 1.1, 1e-12) << "to the next tile";
  EXPECT_NEAR(closest(hair_pin(1.2)), 0.6, 1e-12) << "its ends have 2.4 and 3 of yarn between them";
  EXPECT_NEAR(closest(hair_pin(0.3)), std::hypot(0.9, 0.6), 1e-12) << "1.2 are no contact; 2.1 are, farther off";
}

}  // namespace
}  // namespace wale
