#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "geom/relax/contact_term.h"
#include "geom/relax/newton_system.h"
#include "geom/relax/periodic_yarns.h"
#include "geom/relax/relaxation.h"

namespace wale {

/// Newton's method with a bounded, damped step on the energy of a tile (stretch + bending + contact - tension), in
/// units of the yarn's diameter and bending stiffness.
class Descent {
 public:
  Descent(PeriodicYarns& yarns, const RelaxSettings& settings);

  void barrier(double from, double closest);
  /// Whether periods may change; those that the settings hold never do.
  void free_period(bool free) { free_ = free; }
  /// Finds pairs and sums the energy and its gradient at the yarns as they are.
  void look();
  double force() const;         ///< largest on a point, after look()
  double period_force() const;  ///< on the sides of the tile
  double closest_samples() const;
  double strain() const;  ///< largest of a segment
  double energy() const { return energy_; }
  /// One step down; false where no step leads further down, or where `over` ended it. look() comes next.
  bool step(const std::function<bool()>& over = {});

 private:
  void sum();
  double energy_of(const PeriodicYarns& yarns) const;
  std::vector<LocalTerm> terms(const PeriodicYarns& yarns, Order order) const;

  PeriodicYarns& yarns_;
  RelaxSettings settings_;
  std::vector<YarnSegment> segments_;
  std::vector<uint32_t> next_;     // segment after this one along its yarn
  std::vector<SegmentPair> near_;  // all within reach
  std::vector<double> distance_;   // of each
  ContactBarrier barrier_;
  NewtonSystem system_;
  bool free_ = true;
  double energy_ = 0;
  double damping_ = 1e-2;
};

}  // namespace wale
