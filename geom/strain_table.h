#pragma once
#include <array>
#include <string>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// Shapes of a tile under strain. Convention of MADYPG's tables: the tile at strains (a, b) along course and wale is
/// (Q + g) scaled by (1 + a, 1 + b, 1), periods too.
struct StrainTable {
  std::vector<double> course, wale;         ///< strains, ascending, 0 among both
  std::vector<std::vector<dvec3>> offsets;  ///< [iw * course.size() + ic][point, all curves of the tile one after
                                            ///< another], metres
  bool empty() const { return course.empty(); }
};

/// Bilinear interpolation in a table: what is looked up is the sum of weight[i] * offsets[node[i]].
struct StrainWeights {
  std::array<size_t, 4> node{};
  std::array<double, 4> weight{};
  bool clamped = false;  ///< the strain lies beyond the table, whose border is taken
};

/// `strain`: along course and wale, finite. At a strain of the table one weight is 1 and the others are 0.
StrainWeights strain_weights(const StrainTable& table, dvec2 strain);

/// What is wrong with a table for a tile of `points` points, as "place: what", the place within the table ("course[2]:
/// not finite"); empty when nothing is. An empty table is good.
std::string fault_of(const StrainTable& table, size_t points);

}  // namespace wale
