#pragma once
#include <array>
#include <vector>

#include "geom/charts.h"

namespace wale {

/// Strain of a chart's cloth along course and wale, continuous over it and across its joins: |dP/du| and |dP/dv| of the
/// triangles against their relaxed sizes, less 1, averaged at the vertices with the triangles' UV areas as weights and
/// interpolated between. Only triangles of one chart whose UVs meet there, at once or by a join, share an average: on
/// other seams course and wale of the two sides are different directions.
class StrainField {
 public:
  /// `relaxed`: metres of relaxed cloth per UV.
  StrainField(const BaseMesh& mesh, const Chart& chart, dvec2 relaxed);
  /// Strain at a place of the chart; past its border that of the border triangle's nearest place.
  dvec2 at(const ChartPoint& place) const;

 private:
  std::vector<std::array<dvec2, 3>> corner_;  ///< per triangle of the mesh; 0 where it is not of the chart
};

}  // namespace wale
