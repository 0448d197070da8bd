#pragma once
#include <vector>

#include "geom/stitch.h"

namespace wale {

/// The smooth curve of one tile yarn over its whole cycle, periodic up to the displacement `advance`. Built from the
/// joined control chain: evaluating each block of a B-spline alone would lose the spans at the joints.
class YarnSpline {
 public:
  /// `scale` is applied to the curve (splines are affine invariant, so it does not change its shape parameter).
  YarnSpline(const Pattern& pattern, const YarnChain& cycle, dvec3 scale);
  /// What a tile's offsets (geom/strain_table.h: one shape of the table) add to `curve`, its yarn of the same cycle and
  /// scale, at the same parameters: curve + offsets is the spline through the points moved, with the knots of `curve`.
  YarnSpline(const Pattern& pattern, const YarnChain& cycle, dvec3 scale, const std::vector<dvec3>& offsets,
             const YarnSpline& curve);

  int spans() const { return static_cast<int>(spans_.size()); }
  /// Position (metres, in the instance of the cycle's first link) at parameter u in [0,1] of a span.
  dvec3 position(int span, double u) const;
  /// d position / du.
  dvec3 derivative(int span, double u) const;
  /// Span with which each link of the cycle begins, then the number of spans.
  const std::vector<int>& link_start() const { return link_start_; }
  dvec3 advance() const { return advance_; }

 private:
  struct Span {
    dvec3 c0, c1, c2, c3;
  };
  void join(const Pattern& pattern, const YarnChain& cycle);
  dvec3 control(int i) const;
  void set_knots();
  void fit(CurveKind kind, dvec3 scale);
  void fit_bspline();
  void fit_interpolating();

  std::vector<dvec3> chain_;
  std::vector<double> knots_;  ///< of an interpolating spline: parameter from each point to the next, pattern metres
  std::vector<int> link_start_;
  std::vector<Span> spans_;
  dvec3 advance_{0, 0, 0};
};

/// Arc length along a YarnSpline: Gauss-Legendre over sub-spans, inverted by Newton steps kept inside the sub-span.
class ArcLength {
 public:
  explicit ArcLength(const YarnSpline& spline);
  double total() const { return until_.back(); }
  double span_start(int span) const { return until_[static_cast<size_t>(span) * kParts]; }

  struct Place {
    int span;
    double u;
  };
  /// Where the arc length from the start of the cycle is s, 0 <= s <= total().
  Place at(double s) const;

 private:
  static constexpr int kParts = 8;
  double length(int span, double u0, double u1) const;

  const YarnSpline& spline_;
  std::vector<double> until_;  ///< length up to the start of each part
};

}  // namespace wale
