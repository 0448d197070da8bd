#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "geom/fabric.h"
#include "geom/fibre_detail.h"
#include "shared/wale_types.h"

namespace wale {

/// Tables of fibre detail for all ply materials, as the kernels read them (kernels/appearance/fibre_detail.clh).
struct FibreTables {
  std::vector<WFibreDetail> details;  ///< per ply material
  std::vector<uint32_t> offsets;      ///< W_DETAIL_BINS + 1 per material with detail
  std::vector<w_float4> candidates;   ///< distance, cosine and sine of the angle, migration phase

  bool any() const;  ///< some material shows its fibres by maps
  /// Appends the next ply material. ply_radius in metres; turns and migrations become whole numbers per
  /// W_LENGTH_PERIOD, where stored lengths wrap. A section that `previous` has already is not laid out again.
  void add(const FibreRecipe& recipe, double ply_radius, Detail level, const FibreTables* previous = nullptr);

  /// Sections of the tables by what they were made from: laying one out takes tens of milliseconds.
  struct Made {
    FibreRecipe from;
    std::shared_ptr<const FibreDetail> detail;
  };
  std::vector<Made> made;
};

}  // namespace wale
