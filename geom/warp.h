#pragma once
#include "geom/base_mesh.h"
#include "geom/charts.h"

namespace wale {

/// The reference of kernels/warp.cl in double (KNIT21 Algorithm 1): barycentric point plus height along the
/// interpolated unit normal. Metres.
dvec3 warp_point(const BaseMesh& mesh, const ChartPoint& at, double height);

/// Columns dW/dx, dW/dy, dW/dz of the warp at a point, x and y in cloth metres (uv = uv0 + uv_per_metre * (x, y)).
dmat3 warp_jacobian(const BaseMesh& mesh, const ChartPoint& at, double height, dvec2 uv_per_metre);

}  // namespace wale
