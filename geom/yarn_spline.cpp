#include "geom/yarn_spline.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale {
namespace {

/// Solves the cyclic tridiagonal system  low[i] x[i-1] + diagonal[i] x[i] + high[i] x[i+1] = right[i], n >= 3, by
/// Sherman-Morrison: the corners are a rank-one change of a tridiagonal matrix (Press et al., section 2.7).
std::vector<dvec3> solve_cyclic(const std::vector<double>& low, std::vector<double> diagonal,
                                const std::vector<double>& high, const std::vector<dvec3>& right) {
  const size_t n = diagonal.size();
  const double corner_top = low[0], corner_bottom = high[n - 1], gamma = -diagonal[0];
  diagonal[0] -= gamma;
  diagonal[n - 1] -= corner_top * corner_bottom / gamma;
  const auto solve = [&](auto x) {
    std::vector<double> ratio(n);
    double pivot = diagonal[0];
    x[0] /= pivot;
    for (size_t i = 1; i < n; ++i) {
      ratio[i] = high[i - 1] / pivot;
      pivot = diagonal[i] - low[i] * ratio[i];
      x[i] = (x[i] - low[i] * x[i - 1]) / pivot;
    }
    for (size_t i = n - 1; i-- > 0;) x[i] -= ratio[i + 1] * x[i + 1];
    return x;
  };
  std::vector<dvec3> x = solve(right);
  std::vector<double> u(n, 0.0);
  u[0] = gamma;
  u[n - 1] = corner_bottom;
  const std::vector<double> z = solve(u);
  const dvec3 factor = (x[0] + x[n - 1] * (corner_top / gamma)) / (1 + z[0] + z[n - 1] * corner_top / gamma);
  for (size_t i = 0; i < n; ++i) x[i] -= z[i] * factor;
  return x;
}

}  // namespace

YarnSpline::YarnSpline(const Pattern& pattern, const YarnChain& cycle, dvec3 scale) {
  join(pattern, cycle);
  if (pattern.kind == CurveKind::interpolating) set_knots();
  fit(pattern.kind, scale);
}

// Splines are linear in their control points where knots are given. Offsets do not advance: as if the period were 0.
YarnSpline::YarnSpline(const Pattern& pattern, const YarnChain& cycle, dvec3 scale, const std::vector<dvec3>& offsets,
                       const YarnSpline& curve)
    : knots_(curve.knots_) {
  Pattern moves;
  auto from = offsets.begin();
  for (const PatternCurve& one : pattern.curves) {
    const auto to = from + ptrdiff_t(one.points.size());
    moves.curves.push_back({{from, to}, one.closed});
    from = to;
  }
  join(moves, cycle);
  fit(pattern.kind, scale);
}

void YarnSpline::fit(CurveKind kind, dvec3 scale) {
  if (kind == CurveKind::bspline) {
    fit_bspline();
  } else {
    fit_interpolating();
  }
  for (Span& span : spans_) span.c0 *= scale, span.c1 *= scale, span.c2 *= scale, span.c3 *= scale;
  advance_ *= scale;
}

/// Control points of all links in yarn order; the last point of each link is the first one of the next, and where the
/// file has them a little apart their mean is taken.
void YarnSpline::join(const Pattern& pattern, const YarnChain& cycle) {
  const auto offset = [&](ivec2 shift) { return dvec3(shift.x * pattern.period.x, shift.y * pattern.period.y, 0); };
  advance_ = offset(cycle.shift);
  dvec3 previous_end(0);
  for (const Link& link : cycle.links) {
    const PatternCurve& curve = pattern.curves[link.curve];
    const size_t count = curve.points.size();
    const auto point = [&](size_t i) {
      return curve.points[link.reversed ? count - 1 - i : i] + offset(link.instance);
    };
    link_start_.push_back(static_cast<int>(chain_.size()));
    for (size_t i = 0; i < (curve.closed ? count : count - 1); ++i) chain_.push_back(point(i));
    if (link_start_.back() > 0) {
      dvec3& joint = chain_[link_start_.back()];
      joint = (joint + previous_end) * 0.5;
    }
    previous_end = point(count - 1);
    if (!curve.closed && &link == &cycle.links.back()) chain_[0] = (chain_[0] + (previous_end - advance_)) * 0.5;
  }
  link_start_.push_back(static_cast<int>(chain_.size()));
}

/// Control point i of the endless chain.
dvec3 YarnSpline::control(int i) const {
  const int count = static_cast<int>(chain_.size());
  int turns = i / count;
  if (i % count < 0) --turns;
  return chain_[i - turns * count] + advance_ * double(turns);
}

void YarnSpline::fit_bspline() {
  for (int i = 0; i < static_cast<int>(chain_.size()); ++i) {
    const dvec3 a = control(i - 1), b = control(i), c = control(i + 1), d = control(i + 2);
    spans_.push_back({(a + 4.0 * b + c) / 6.0, (c - a) / 2.0, (a - 2.0 * b + c) / 2.0, (d - a + 3.0 * (b - c)) / 6.0});
  }
}

/// Chord-length knots, which keep fourth order on uneven points (Floater 2006).
void YarnSpline::set_knots() {
  const int points = static_cast<int>(chain_.size());
  // Fewer than three unknowns would make the cyclic system's corners fall onto its diagonals: take several cycles.
  const int count = points < 3 ? 3 * points : points;
  double mean = 0;
  for (int i = 0; i < points; ++i) mean += glm::distance(control(i), control(i + 1)) / points;
  if (!(mean > 0)) user_error("a yarn of the tile has no length");
  // Points listed twice get a short knot interval, so that the curve only slows down there.
  for (int i = 0; i < count; ++i) knots_.push_back(std::max(glm::distance(control(i), control(i + 1)), 1e-3 * mean));
}

/// C2 cubic through the control points. With h the knot intervals and M the second derivatives:
///   h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (d[i] - d[i-1]),   d[i] = (P[i+1] - P[i]) / h[i].
void YarnSpline::fit_interpolating() {
  const std::vector<double>& h = knots_;
  const int points = static_cast<int>(chain_.size()), count = static_cast<int>(h.size());
  std::vector<double> low(count), diagonal(count), high(count);
  std::vector<dvec3> slope(count), right(count);
  for (int i = 0; i < count; ++i) slope[i] = (control(i + 1) - control(i)) / h[i];
  for (int i = 0; i < count; ++i) {
    const int before = (i + count - 1) % count;
    low[i] = h[before];
    high[i] = h[i];
    diagonal[i] = 2 * (h[before] + h[i]);
    right[i] = 6.0 * (slope[i] - slope[before]);
  }
  const std::vector<dvec3> m = solve_cyclic(low, diagonal, high, right);
  for (int i = 0; i < points; ++i) {
    const dvec3& m0 = m[i];
    const dvec3& m1 = m[(i + 1) % count];
    const double k = h[i];  // in u = t / k
    spans_.push_back(
        {control(i), (slope[i] - k * (2.0 * m0 + m1) / 6.0) * k, m0 * (k * k / 2), (m1 - m0) * (k * k / 6)});
  }
}

dvec3 YarnSpline::position(int span, double u) const {
  const Span& c = spans_[span];
  return c.c0 + u * (c.c1 + u * (c.c2 + u * c.c3));
}

dvec3 YarnSpline::derivative(int span, double u) const {
  const Span& c = spans_[span];
  return c.c1 + u * (2.0 * c.c2 + 3.0 * u * c.c3);
}

ArcLength::ArcLength(const YarnSpline& spline) : spline_(spline) {
  until_.push_back(0);
  for (int span = 0; span < spline.spans(); ++span)
    for (int part = 0; part < kParts; ++part)
      until_.push_back(until_.back() + length(span, double(part) / kParts, double(part + 1) / kParts));
}

/// Five-point Gauss-Legendre.
double ArcLength::length(int span, double u0, double u1) const {
  constexpr double kNode[] = {0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = (u0 + u1) / 2, half = (u1 - u0) / 2;
  double sum = kWeight[0] * glm::length(spline_.derivative(span, middle));
  for (const int i : {1, 2})
    sum += kWeight[i] * (glm::length(spline_.derivative(span, middle - half * kNode[i])) +
                         glm::length(spline_.derivative(span, middle + half * kNode[i])));
  return sum * half;
}

ArcLength::Place ArcLength::at(double s) const {
  const auto after = std::upper_bound(until_.begin() + 1, until_.end() - 1, s);
  const int part = static_cast<int>(after - until_.begin()) - 1;
  const int span = part / kParts;
  const double start = double(part % kParts) / kParts;
  const double wanted = s - until_[part], whole = until_[part + 1] - until_[part];
  double lo = start, hi = start + 1.0 / kParts;
  double u = whole > 0 ? start + std::clamp(wanted / whole, 0.0, 1.0) / kParts : start;
  for (int step = 0; step < 50; ++step) {
    const double miss = length(span, start, u) - wanted;
    if (std::abs(miss) <= 1e-14 * total()) break;
    (miss > 0 ? hi : lo) = u;
    const double speed = glm::length(spline_.derivative(span, u));
    const double newton = speed > 0 ? u - miss / speed : lo;
    if (hi - lo < 1e-15) break;
    u = newton > lo && newton < hi ? newton : (lo + hi) / 2;
  }
  return {span, u};
}

}  // namespace wale
