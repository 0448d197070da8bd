#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "geom/charts.h"
#include "geom/mesh_edges.h"

namespace wale {
namespace {

void set_weights(const std::array<dvec2, 3>& t, dvec2 p, double area2, ChartPoint& out) {
  const dvec2 e1 = t[1] - t[0], e2 = t[2] - t[0], d = p - t[0];
  out.b1 = (d.x * e2.y - d.y * e2.x) / area2;
  out.b2 = (e1.x * d.y - e1.y * d.x) / area2;
}

/// Offset from p to the nearest point of the triangle's outline, under the metric.
dvec2 to_outline(const std::array<dvec2, 3>& t, dvec2 p, dvec2 metric) {
  dvec2 best(0);
  double best_length = std::numeric_limits<double>::infinity();
  for (size_t c = 0; c < 3; ++c) {
    const dvec2 a = (t[c] - p) * metric, b = (t[(c + 1) % 3] - p) * metric, ab = b - a;
    const double length2 = glm::dot(ab, ab);
    const double s = length2 > 0 ? std::clamp(-glm::dot(a, ab) / length2, 0.0, 1.0) : 0;
    const dvec2 offset = a + s * ab;
    if (glm::length(offset) < best_length) {
      best_length = glm::length(offset);
      best = offset / metric;
    }
  }
  return best;
}

constexpr size_t kItemsPerTriangle = 32;

int bucket(double x, double origin, double cell, int size) {
  return static_cast<int>(std::clamp(std::floor((x - origin) / cell), 0.0, size - 1.0));
}

/// A point, and its copies one period away, for a seam that is not straight.
class Copies {
 public:
  Copies(const Chart& chart, dvec2 uv) : uv_(uv) {
    for (const dvec2 join : chart.joins) period_ += join;
    for (int axis = 0; axis < 2; ++axis)
      if (period_[axis] > 0) {
        uv_[axis] -= period_[axis] * std::floor((uv_[axis] - chart.uv_min[axis]) / period_[axis]);
        count_[axis] = 3;
      }
  }
  int count() const { return count_.x * count_.y; }
  dvec2 uv(int k) const {
    constexpr int kOrder[3] = {0, 1, -1};
    return uv_ + dvec2(kOrder[k % count_.x], kOrder[k / count_.x]) * period_;
  }

 private:
  dvec2 uv_, period_{0, 0};
  ivec2 count_{1, 1};
};

}  // namespace

ChartLocator::ChartLocator(const BaseMesh& mesh, const Chart& chart)
    : mesh_(mesh), chart_(chart), origin_(chart.uv_min), cell_(1), size_(1, 1) {
  // About one bucket a triangle, square in space rather than in UV.
  const dvec2 extent = glm::max(chart.uv_max - chart.uv_min, dvec2(1e-300));
  const dvec2 metres = glm::max(extent * chart.metres_per_uv, dvec2(1e-300));
  const double count = static_cast<double>(chart.triangles.size());
  size_.x = static_cast<int>(std::clamp(std::sqrt(count * metres.x / metres.y), 1.0, std::min(count, 8192.0)));
  size_.y = static_cast<int>(std::clamp(count / size_.x, 1.0, 8192.0));
  cell_ = extent / dvec2(size_);

  // Of triangles with the same UVs the first wins wherever they are asked for: the others need not be looked at.
  std::set<std::array<double, 6>> seen;
  for (const uint32_t t : chart.triangles) {
    const auto& uv = mesh.uv[t];
    const double area2 = uv_area2(uv);
    if (area2 == 0 || !seen.insert({uv[0].x, uv[0].y, uv[1].x, uv[1].y, uv[2].x, uv[2].y}).second) continue;
    Outline outline{t, {}, {}};
    for (size_t c = 0; c < 3; ++c) {
      // The ends are taken in one order, whichever triangle asks, so that the two triangles of an edge get exactly
      // opposite signs and no point falls between them.
      dvec2 a = uv[c], b = uv[(c + 1) % 3];
      const bool swap = b.x < a.x || (b.x == a.x && b.y < a.y);
      if (swap) std::swap(a, b);
      outline.corner[c] = a;
      outline.along[c] = swap == (area2 > 0) ? a - b : b - a;
    }
    outlines_.push_back(outline);
  }

  const auto visit = [&](auto&& emit) {
    for (uint32_t i = 0; i < outlines_.size(); ++i) {
      const auto& uv = mesh.uv[outlines_[i].triangle];
      const dvec2 lo = glm::min(uv[0], glm::min(uv[1], uv[2])), hi = glm::max(uv[0], glm::max(uv[1], uv[2]));
      const int x0 = bucket(lo.x, origin_.x, cell_.x, size_.x), x1 = bucket(hi.x, origin_.x, cell_.x, size_.x);
      const int y0 = bucket(lo.y, origin_.y, cell_.y, size_.y), y1 = bucket(hi.y, origin_.y, cell_.y, size_.y);
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          emit(static_cast<size_t>(y) * static_cast<size_t>(size_.x) + static_cast<size_t>(x), i);
    }
  };
  // Long thin triangles lie in many buckets: coarser ones keep the lists in proportion to the mesh.
  for (;;) {
    size_t items = 0;
    visit([&](size_t, uint32_t) { ++items; });
    if (items <= kItemsPerTriangle * outlines_.size() || (size_.x == 1 && size_.y == 1)) break;
    size_ = glm::max(size_ / 2, ivec2(1));
    cell_ = extent / dvec2(size_);
  }
  offset_.assign(static_cast<size_t>(size_.x) * static_cast<size_t>(size_.y) + 1, 0);
  visit([&](size_t b, uint32_t) { ++offset_[b + 1]; });
  for (size_t b = 1; b < offset_.size(); ++b) offset_[b] += offset_[b - 1];
  items_.resize(offset_.back());
  std::vector<size_t> next(offset_.begin(), offset_.end() - 1);
  visit([&](size_t b, uint32_t i) { items_[next[b]++] = i; });
}

bool ChartLocator::locate(dvec2 uv, double reach, dvec2 metric, ChartPoint& out) const {
  const auto range = [&](int x, int y) {
    const size_t b = static_cast<size_t>(y) * static_cast<size_t>(size_.x) + static_cast<size_t>(x);
    return std::pair(offset_[b], offset_[b + 1]);
  };
  const Copies copies(chart_, uv);
  for (int k = 0; k < copies.count(); ++k) {
    const dvec2 p = copies.uv(k);
    if (!(p.x >= chart_.uv_min.x && p.y >= chart_.uv_min.y && p.x <= chart_.uv_max.x && p.y <= chart_.uv_max.y))
      continue;
    const auto [begin, end] = range(bucket(p.x, origin_.x, cell_.x, size_.x), bucket(p.y, origin_.y, cell_.y, size_.y));
    for (size_t i = begin; i < end; ++i) {
      const Outline& outline = outlines_[items_[i]];
      const auto left_of = [&](size_t c) {
        const dvec2 d = p - outline.corner[c];
        return outline.along[c].x * d.y - outline.along[c].y * d.x;
      };
      if (!(std::min({left_of(0), left_of(1), left_of(2)}) >= 0)) continue;
      out.triangle = outline.triangle;  // items ascend inside a bucket: the lowest index wins
      out.outside = 0;
      const auto& t = mesh_.uv[out.triangle];
      set_weights(t, p, uv_area2(t), out);
      return true;
    }
  }

  // A hair's breadth is always bridged: neighbouring triangles whose UVs agree only to rounding leave cracks.
  const dvec2 extent = chart_.uv_max - chart_.uv_min;
  reach = std::max(reach, 1e-9 * std::max(extent.x * metric.x, extent.y * metric.y));
  double best = std::numeric_limits<double>::infinity();
  uint32_t best_triangle = std::numeric_limits<uint32_t>::max();
  dvec2 best_point(0);
  for (int k = 0; k < copies.count(); ++k) {
    const dvec2 p = copies.uv(k), lo = p - reach / metric, hi = p + reach / metric;
    if (!(hi.x >= chart_.uv_min.x && hi.y >= chart_.uv_min.y && lo.x <= chart_.uv_max.x && lo.y <= chart_.uv_max.y))
      continue;
    const int x0 = bucket(lo.x, origin_.x, cell_.x, size_.x), x1 = bucket(hi.x, origin_.x, cell_.x, size_.x);
    const int y0 = bucket(lo.y, origin_.y, cell_.y, size_.y), y1 = bucket(hi.y, origin_.y, cell_.y, size_.y);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const auto [begin, end] = range(x, y);
        for (size_t i = begin; i < end; ++i) {
          const uint32_t triangle = outlines_[items_[i]].triangle;
          const dvec2 offset = to_outline(mesh_.uv[triangle], p, metric);
          const double distance = glm::length(offset * metric);
          if (distance > reach) continue;
          // The step past the border is judged by what the triangle's own map would make of it in space: slivers along
          // a border stretch it out of all proportion, and lose to a sound triangle a little farther off.
          dvec3 du, dv;
          uv_gradient(mesh_, triangle, du, dv);
          const double cost = std::max(distance, glm::length(du * offset.x + dv * offset.y));
          if (cost > best || (cost == best && triangle >= best_triangle)) continue;
          best = cost;
          best_triangle = triangle;
          best_point = p;
          out.outside = glm::length(offset);
        }
      }
  }
  if (best_triangle == std::numeric_limits<uint32_t>::max()) return false;
  out.triangle = best_triangle;
  set_weights(mesh_.uv[best_triangle], best_point, uv_area2(mesh_.uv[best_triangle]), out);
  return true;
}

}  // namespace wale
