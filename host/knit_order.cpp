#include "host/knit_order.h"

namespace wale {

bool serves(const KnitOrder& before, const Fabric& made, const KnitOrder& wanted) {
  if (wanted.spec.places && made.place.empty()) return false;  // they were not kept
  if (before == wanted) return true;
  const FabricSpec& spec = before.spec;
  if (spec.detail == Detail::fibres || spec.flyaways.any() || !made.lattice.empty()) return false;
  // Fibres that are shown by maps only lie in no buffer of the fabric.
  KnitOrder same = wanted;
  same.spec.fibres = spec.fibres;
  return before == same;
}

}  // namespace wale
