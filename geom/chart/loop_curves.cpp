// A loop from the left, in units of the stitch's width, y up from the row that makes it (d: depth, e: half the height
// of a crossing; f: +1 where it is pulled to the front, F where the next one is):
//
//   foot    (-.33, -e, -f d)   passes behind the legs of the loop below (in front for purl) ...
//   neck    (-.15, +e, +f d)   ... and comes up through it, in front of its head
//   leg     (-.33, H - e, +F d)  the next loop's foot passes behind
//   head    (-.15, H + e, -F d)  and its neck in front
//
// with H the way to the row that takes it; and the same mirrored, down to the next wale. Loops that are taken together
// lie one behind the other, the one in front outermost at its legs and innermost at its head.
#include "geom/chart/loop_curves.h"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

constexpr double kRow = 0.62, kHalf = 0.13, kDepth = 0.16, kLane = 0.3;  // stitch widths

// Heights of the rows of a tile and of as many as its loops reach into the next ones: where loops cross on their way up
// there is more of it, or their legs would lie side by side as one.
class RowHeights {
 public:
  explicit RowHeights(const Knit& knit) : rows_(knit.rows), way_(size_t(knit.rows), kRow) {
    for (const Loop& loop : knit.loops)
      if (loop.crossing != 0) {
        double& way = way_[size_t((loop.top_row - 1) % rows_)];
        way = std::max(way, kRow * (1 + 0.5 * std::abs(loop.top_wale - loop.wale)));
      }
    for (const double way : way_) tile_ += way;
  }
  double at(int row) const {
    double sum = (row / rows_) * tile_;
    for (int r = 0; r < row % rows_; ++r) sum += way_[size_t(r)];
    return sum;
  }
  double tile() const { return tile_; }

 private:
  int rows_;
  std::vector<double> way_;
  double tile_ = 0;
};

class CourseCurve {
 public:
  CourseCurve(const Knit& knit, const RowHeights& heights, const Course& course) : heights_(heights) {
    const double lane = kLane * (course.lane - 0.5 * (course.lanes - 1));
    for (size_t wale = 0; wale < course.places.size(); ++wale) {
      const auto& place = course.places[wale];
      if (place.loop < 0)
        add(double(wale) + 0.5, heights_.at(course.row) + lane, (place.float_front ? 2.2 : -2.2) * kDepth);
      else
        loop(knit.loops[size_t(place.loop)]);
    }
  }
  std::vector<dvec3> points;

 private:
  void add(double x, double y, double z) { points.emplace_back(x, y, z); }

  void loop(const Loop& l) {
    for (const double side : {-1.0, 1.0}) {
      std::vector<dvec3> half;
      const double x = l.wale + 0.5, y = heights_.at(l.row), front = l.knit ? 1 : -1;
      const double top_x = l.top_wale + 0.5, top = heights_.at(l.top_row), top_front = l.top_knit ? 1 : -1;
      if (l.foot == Loop::Foot::pulled) {
        half.emplace_back(x + side * 0.33, y - kHalf, -front * kDepth);
        half.emplace_back(x + side * 0.2, y - 0.2 * kHalf, 0);
        half.emplace_back(x + side * 0.15, y + kHalf, front * kDepth);
      } else {
        // Nothing to come up through; behind what is held there, or in front.
        half.emplace_back(x + side * 0.38, y - 0.5 * kHalf, -1.8 * front * kDepth);
        half.emplace_back(x + side * 0.36, y + kHalf, -1.4 * front * kDepth);
      }
      const double behind = 2 * kDepth * l.place, before = 2 * kDepth * (l.beside - 1 - l.place);
      const double lean = side * 0.04 * l.place;
      if (l.crossing != 0)
        half.emplace_back(0.5 * (x + top_x) + side * 0.25, 0.5 * (y + top), 4.0 * kDepth * l.crossing);
      else if (l.foot == Loop::Foot::pulled)
        half.emplace_back(0.5 * (x + top_x) + side * 0.26, y + 0.5 * (top - y),
                          0.5 * (front + top_front) * kDepth + 0.5 * top_front * before);
      half.emplace_back(top_x + side * 0.33 + lean, top - kHalf, top_front * (kDepth + before));
      half.emplace_back(top_x + side * 0.29 + lean, top + 0.2 * kHalf, top_front * 0.5 * (before - behind));
      half.emplace_back(top_x + side * 0.15, top + kHalf, -top_front * (kDepth + behind));
      if (side < 0) half.emplace_back(top_x, top + (1.4 + 0.3 * l.place) * kHalf, -top_front * (kDepth + behind));
      if (side > 0) std::reverse(half.begin(), half.end());
      points.insert(points.end(), half.begin(), half.end());
    }
  }

  const RowHeights& heights_;
};

// Point of a centripetal Catmull-Rom spline (Barry and Goldman 1988) from b to c, u in [0,1].
dvec3 catmull_rom(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, double u) {
  const double t0 = 0, t1 = t0 + std::sqrt(glm::length(b - a)), t2 = t1 + std::sqrt(glm::length(c - b)),
               t3 = t2 + std::sqrt(glm::length(d - c)), t = t1 + u * (t2 - t1);
  const dvec3 p = (t1 - t) / (t1 - t0) * a + (t - t0) / (t1 - t0) * b,
              q = (t2 - t) / (t2 - t1) * b + (t - t1) / (t2 - t1) * c,
              r = (t3 - t) / (t3 - t2) * c + (t - t2) / (t3 - t2) * d;
  const dvec3 v = (t2 - t) / (t2 - t0) * p + (t - t0) / (t2 - t0) * q,
              w = (t3 - t) / (t3 - t1) * q + (t - t1) / (t3 - t1) * r;
  return (t2 - t) / (t2 - t1) * v + (t - t1) / (t2 - t1) * w;
}

// A closed course (on the torus) as a fine polyline.
std::vector<dvec3> fine(const std::vector<dvec3>& control, double wales) {
  const auto at = [&](long i) {
    const long n = long(control.size());
    const long lap = i < 0 ? -1 : i >= n ? 1 : 0;
    return control[size_t(i - lap * n)] + dvec3(double(lap) * wales, 0, 0);
  };
  std::vector<dvec3> out;
  constexpr int kFine = 24;
  for (long i = 0; i < long(control.size()); ++i)
    for (int k = 0; k < kFine; ++k)
      out.push_back(catmull_rom(at(i - 1), at(i), at(i + 1), at(i + 2), double(k) / kFine));
  out.push_back(out.front() + dvec3(wales, 0, 0));
  return out;
}

// Shares of a plain stitch's yarn: a float is about as long as a wale is wide; a loop that crosses wales takes up more.
constexpr double kFloat = 0.3, kCrossing = 0.25;

int crossed(const Loop& loop) { return loop.crossing == 0 ? 0 : loop.top_wale - loop.wale; }

double length_of(const std::vector<dvec3>& line) {
  double sum = 0;
  for (size_t i = 1; i < line.size(); ++i) sum += glm::length(line[i] - line[i - 1]);
  return sum;
}

}  // namespace

PeriodicYarns loop_curves(const Knit& knit, const LoopSizes& sizes) {
  const double diameter = 2 * sizes.yarn_radius;
  const RowHeights heights(knit);
  std::vector<std::vector<dvec3>> lines;
  double drawn = 0, total = 0;
  std::vector<double> lengths;
  for (const Course& course : knit.courses) {
    lines.push_back(fine(CourseCurve(knit, heights, course).points, knit.wales));
    drawn += length_of(lines.back());
    double loops = 0;
    for (const auto& place : course.places)
      loops += place.loop < 0 ? kFloat : 1 + kCrossing * std::abs(crossed(knit.loops[size_t(place.loop)]));
    lengths.push_back(loops * sizes.loop_length * diameter);
    total += lengths.back();
  }
  const double scale = total / drawn;  // metres per stitch width
  PeriodicYarns out;
  out.radius = sizes.yarn_radius;
  out.period = scale * dvec2(knit.wales, heights.tile());
  for (size_t row = 0; row < lines.size(); ++row) {  // courses
    PeriodicYarn yarn;
    yarn.first = uint32_t(out.points.size());
    yarn.length = lengths[row];
    yarn.count =
        2 * uint32_t(std::max(4.0, std::round(0.5 * lengths[row] / (sizes.step * diameter))));  // even: relax()
    const double whole = length_of(lines[row]), step = whole / yarn.count;
    double done = 0;
    size_t k = 0;
    for (uint32_t i = 0; i < yarn.count; ++i) {
      const double goal = i * step;
      while (k + 2 < lines[row].size() && done + glm::length(lines[row][k + 1] - lines[row][k]) < goal)
        done += glm::length(lines[row][k + 1] - lines[row][k]), ++k;
      const dvec3 way = lines[row][k + 1] - lines[row][k];
      out.points.push_back(scale * (lines[row][k] + way * ((goal - done) / glm::length(way))));
    }
    out.yarns.push_back(yarn);
  }
  return out;
}

}  // namespace wale
