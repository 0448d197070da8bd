#pragma once
#include <functional>
#include <vector>

#include "geom/relax/relaxation.h"
#include "geom/strain_table.h"

namespace wale {

/// A table of relaxed shapes and what each came to, in the table's order.
struct RelaxedStrains {
  StrainTable table;
  std::vector<Relaxed> reached;
  bool stopped = false;
  bool converged() const;
};

/// Relaxes a relaxed tile at given strains of its period along course and wale: ascending, above -1, 0 among both (else
/// a user error). Each shape starts from that of the strain beside it nearer 0, moved as the cloth is, so that the yarn
/// keeps its way through the loops. Offsets have no mean, as a shift of the tile means nothing; per yarn there are its
/// points and the first one again, as in the curves of a Pattern. Every shape is a path of settings.watch, in the
/// table's order. The columns run on `threads` threads; the result does not depend on their number. `progress` gets the
/// share of shapes that are done, one call at a time, on every step; false stops, and shapes are then not all there.
RelaxedStrains relax_strains(const PeriodicYarns& relaxed, const RelaxSettings& settings, std::vector<double> course,
                             std::vector<double> wale, unsigned threads,
                             const std::function<bool(double)>& progress = {});

}  // namespace wale
