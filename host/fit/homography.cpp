#include "host/fit/homography.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wale::fit {
namespace {

constexpr const char* kCornerNames[] = {"top left", "top right", "bottom right", "bottom left"};

double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

// A quadrilateral cut by up to four straight lines.
struct Polygon {
  std::array<dvec2, 16> corner;
  size_t size = 0;

  void add(dvec2 p) { corner[size++] = p; }
  double area() const {
    double twice = 0;
    for (size_t i = 2; i < size; ++i) twice += cross(corner[i - 1] - corner[0], corner[i] - corner[0]);
    return std::abs(twice) / 2;
  }
  double least(int axis) const {
    double value = 1e300;
    for (size_t i = 0; i < size; ++i) value = std::min(value, corner[i][axis]);
    return value;
  }
  double greatest(int axis) const {
    double value = -1e300;
    for (size_t i = 0; i < size; ++i) value = std::max(value, corner[i][axis]);
    return value;
  }
  // What lies at coordinates up to `limit` (side 1) or from it (side -1); Sutherland and Hodgman's clipping.
  Polygon cut(int axis, double limit, int side) const {
    Polygon out;
    for (size_t i = 0; i < size; ++i) {
      const dvec2 p = corner[i], q = corner[i + 1 == size ? 0 : i + 1];
      const double in_p = side * (limit - p[axis]), in_q = side * (limit - q[axis]);
      if (in_p >= 0) out.add(p);
      if ((in_p > 0 && in_q < 0) || (in_p < 0 && in_q > 0)) {
        dvec2 between = p + (q - p) * (in_p / (in_p - in_q));
        between[axis] = limit;
        out.add(between);
      }
    }
    return out;
  }
};

// Mean colour of the photograph over a small quadrilateral.
void mean_over(const Picture& photograph, const Polygon& whole, float out[3]) {
  const auto index = [](double at, int size) { return std::clamp(int(std::floor(at)), 0, size - 1); };
  const int bottom = index(whole.greatest(1), photograph.height);
  double sum[3] = {}, area = 0;
  for (int y = index(whole.least(1), photograph.height); y <= bottom; ++y) {
    const Polygon strip = whole.cut(1, y, -1).cut(1, y + 1.0, 1);
    if (strip.size < 3) continue;
    const int first = index(strip.least(0), photograph.width), last = index(strip.greatest(0), photograph.width);
    double before = 0;  // area of the strip on the left
    for (int x = first; x <= last; ++x) {
      const double until = x == last ? strip.area() : strip.cut(0, x + 1.0, 1).area();
      for (int c = 0; c < 3; ++c) sum[c] += (until - before) * double(photograph.at(x, y)[c]);
      before = until;
    }
    area += before;
  }
  for (int c = 0; c < 3; ++c) out[c] = float(sum[c] / area);
}

}  // namespace

Homography::Homography(const Corners& p) {
  const dvec2 s = p[0] - p[1] + p[2] - p[3], right = p[1] - p[2], down = p[3] - p[2];
  const double det = cross(right, down);
  g_ = cross(s, down) / det;
  h_ = cross(right, s) / det;
  a_ = p[1].x - p[0].x + g_ * p[1].x;
  b_ = p[3].x - p[0].x + h_ * p[3].x;
  c_ = p[0].x;
  d_ = p[1].y - p[0].y + g_ * p[1].y;
  e_ = p[3].y - p[0].y + h_ * p[3].y;
  f_ = p[0].y;
}

dvec2 Homography::operator()(dvec2 p) const {
  return dvec2(a_ * p.x + b_ * p.y + c_, d_ * p.x + e_ * p.y + f_) / (g_ * p.x + h_ * p.y + 1);
}

std::string corners_fault(const Corners& corners, int width, int height) {
  for (size_t i = 0; i < 4; ++i) {
    const dvec2 p = corners[i];
    if (!(p.x >= 0 && p.x <= width && p.y >= 0 && p.y <= height))
      return fmt::format("the {} one, ({:g}, {:g}), lies outside of the {} x {} pixels", kCornerNames[i], p.x, p.y,
                         width, height);
  }
  for (size_t i = 0; i < 4; ++i) {
    const dvec2 p = corners[i], before = corners[(i + 3) % 4] - p, after = corners[(i + 1) % 4] - p;
    if (!(glm::length(after) >= 1))
      return fmt::format("the {} and the {} one are less than a pixel apart", kCornerNames[i],
                         kCornerNames[(i + 1) % 4]);
    // At 3 degrees from straight on a corner is no corner of a photographed rectangle.
    if (!(cross(after, before) > 0.05 * glm::length(after) * glm::length(before)))
      return fmt::format("they make no convex turn at the {} one; give top left, top right, bottom right, bottom left",
                         kCornerNames[i]);
  }
  return {};
}

ivec2 size_of(const Corners& p) {
  const auto longer = [](double a, double b) { return std::max(1, int(std::lround(std::max(a, b)))); };
  return {longer(glm::length(p[1] - p[0]), glm::length(p[2] - p[3])),
          longer(glm::length(p[3] - p[0]), glm::length(p[2] - p[1]))};
}

bool inside(const Corners& corners, dvec2 p) {
  for (size_t i = 0; i < 4; ++i)
    if (cross(corners[(i + 1) % 4] - corners[i], p - corners[i]) < 0) return false;
  return true;
}

Picture rectified(const Picture& photograph, const Corners& corners, int width, int height) {
  const Homography map(corners);
  const auto vertex = [&](int x, int y) { return map({double(x) / width, double(y) / height}); };
  Picture out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Polygon footprint;  // straight lines stay straight
      footprint.add(vertex(x, y));
      footprint.add(vertex(x + 1, y));
      footprint.add(vertex(x + 1, y + 1));
      footprint.add(vertex(x, y + 1));
      mean_over(photograph, footprint, out.at(x, y));
    }
  return out;
}

}  // namespace wale::fit
