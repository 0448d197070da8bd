#pragma once
#include <cstdint>
#include <vector>

#include "geom/base_mesh.h"

namespace wale {

/// Deviation of a seam from a pure translation that is still a join, relative to the translation. Files with six
/// decimals reach 2e-6; 1e-5 of a sleeve's girth is a hundredth of a ply radius.
constexpr double kJoinTolerance = 1e-5;

/// A connected piece of the UV layout.
struct Chart {
  std::vector<uint32_t> triangles;
  dvec2 uv_min{0, 0}, uv_max{0, 0};
  dvec2 metres_per_uv{1, 1};  ///< area-weighted mean of |dP/du|, |dP/dv|
  std::vector<dvec2> joins;   ///< translations T: uv and uv+T are the two sides of a seam (T and -T once)
  bool mirrored = false;      ///< most of its triangles are clockwise in UV
};

/// Charts: triangles joined where an edge carries the same UV on both sides. Deterministic order (first triangle).
std::vector<Chart> find_charts(const BaseMesh& mesh);

/// A point of a chart: triangle and barycentric weights of corners 1 and 2 (corner 0 has 1-b1-b2). Weights lie outside
/// [0,1] where the point was extrapolated past a border.
struct ChartPoint {
  uint32_t triangle = 0;
  double b1 = 0, b2 = 0;
  double outside = 0;  ///< distance past the border in UV units; 0 inside
};

/// Finds triangles by UV within one chart, through a uniform bucket grid.
class ChartLocator {
 public:
  ChartLocator(const BaseMesh& mesh, const Chart& chart);
  /// The triangle that holds uv, also across the chart's joins; else the border triangle within `reach` (in units of
  /// the metric: |du * metric.x|, |dv * metric.y|) whose linear extrapolation is shortest. False when neither.
  bool locate(dvec2 uv, double reach, dvec2 metric, ChartPoint& out) const;

 private:
  /// A triangle by its sides: corner and direction, such that a point lies inside where it is to no side's right.
  struct Outline {
    uint32_t triangle;
    dvec2 corner[3], along[3];
  };

  const BaseMesh& mesh_;
  const Chart& chart_;
  dvec2 origin_, cell_;
  ivec2 size_;
  std::vector<Outline> outlines_;  ///< triangles that can be found, ascending
  std::vector<size_t> offset_;
  std::vector<uint32_t> items_;  ///< outlines that touch a bucket, ascending
};

}  // namespace wale
