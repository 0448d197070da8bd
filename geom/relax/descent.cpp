#include "geom/relax/descent.h"

#include <algorithm>
#include <cmath>

#include "geom/relax/step_bound.h"
#include "geom/relax/yarn_terms.h"

namespace wale {
namespace {

constexpr double kReach = 1.8;                              // D: pairs within it are looked at on every step
constexpr double kSpare = 0.05;                             // D beyond contact that pairs have a place in the matrix
constexpr double kLeastDamping = 1e-7, kLeastShift = 1e-4;  // B / D^3

}  // namespace

Descent::Descent(PeriodicYarns& yarns, const RelaxSettings& settings)
    : yarns_(yarns), settings_(settings), segments_(segments_of(yarns)), system_(yarns.points.size()) {
  uint32_t first = 0;
  for (uint32_t i = 0; i < segments_.size(); ++i) {
    if (segments_[i].yarn != segments_[first].yarn) first = i;
    const bool last = i + 1 == segments_.size() || segments_[i + 1].yarn != segments_[i].yarn;
    next_.push_back(last ? first : i + 1);
  }
}

void Descent::barrier(double from, double closest) {
  barrier_.from = from;
  barrier_.closest = closest;
  barrier_.stiffness = settings_.contact_stiffness;
  barrier_.samples = settings_.contact_samples;
}

std::vector<LocalTerm> Descent::terms(const PeriodicYarns& yarns, Order order) const {
  std::vector<LocalTerm> out;
  for (const YarnSegment& s : segments_) out.push_back(stretch_term(yarns, s, settings_.stretch_stiffness, order));
  for (size_t i = 0; i < segments_.size(); ++i)
    out.push_back(bending_term(yarns, segments_[i], segments_[next_[i]], order));
  for (size_t k = 0; k < near_.size(); ++k) {
    if (order == Order::derivatives && distance_[k] >= barrier_.from) continue;
    const SegmentPair& pair = near_[k];
    const LocalTerm term =
        contact_term(yarns, segments_[pair.first], segments_[pair.second], pair.image, barrier_, order);
    if (term.energy != 0) out.push_back(term);
  }
  return out;
}

double Descent::energy_of(const PeriodicYarns& yarns) const {
  double sum = 0;
  for (const LocalTerm& term : terms(yarns, Order::energy)) sum += term.energy;
  return sum - settings_.tension.x * yarns.period.x - settings_.tension.y * yarns.period.y;
}

void Descent::sum() {
  const std::vector<LocalTerm> all = terms(yarns_, Order::derivatives);
  std::vector<std::array<uint32_t, 4>> spare;
  for (size_t k = 0; k < near_.size(); ++k) {
    if (distance_[k] >= barrier_.from + kSpare) continue;
    const YarnSegment &f = segments_[near_[k].first], &g = segments_[near_[k].second];
    spare.push_back({f.a, f.b, g.a, g.b});
  }
  system_.begin(all, spare);
  energy_ = -settings_.tension.x * yarns_.period.x - settings_.tension.y * yarns_.period.y;
  for (const LocalTerm& term : all) {
    system_.add(term);
    energy_ += term.energy;
  }
  system_.add_strain(-settings_.tension * yarns_.period);
}

void Descent::look() {
  near_ = near_pairs(yarns_, segments_, kReach, settings_.neighbours);
  distance_.resize(near_.size());
  for (size_t k = 0; k < near_.size(); ++k) distance_[k] = glm::length(closest_of(yarns_, segments_, near_[k]).way);
  sum();
}

double Descent::force() const {
  double most = 0;
  for (const dvec3& g : system_.gradient()) most = std::max(most, glm::length(g));
  return most;
}

double Descent::period_force() const {
  const dvec2 pull = glm::abs(system_.strain_gradient() / yarns_.period);
  return std::max(free_ && settings_.free_period_x ? pull.x : 0.0, free_ && settings_.free_period_y ? pull.y : 0.0);
}

double Descent::closest_samples() const {
  double least = kReach;
  for (size_t k = 0; k < near_.size(); ++k)
    if (distance_[k] < least)
      least = std::min(least, sample_distance(yarns_, segments_[near_[k].first], segments_[near_[k].second],
                                              near_[k].image, settings_.contact_samples));
  return least;
}

double Descent::strain() const {
  double most = 0;
  for (const YarnSegment& s : segments_)
    most = std::max(most, std::abs(glm::length(edge_of(yarns_, s)) / s.length - 1));
  return most;
}

// H + damping is made positive by the damping alone: where H has negative directions, as it does on the way to a
// buckled state, a small one gives long steps just along these.
bool Descent::step(const std::function<bool()>& over) {
  for (int attempt = 0; attempt < 24; ++attempt) {
    const auto found =
        system_.solve(damping_, free_ && settings_.free_period_x, free_ && settings_.free_period_y, over);
    if (over && over()) return false;
    if (!found) {
      damping_ = std::max(4 * damping_, kLeastShift);
      continue;
    }
    double slope = glm::dot(system_.strain_gradient(), found->strain);
    for (size_t i = 0; i < found->points.size(); ++i) slope += glm::dot(system_.gradient()[i], found->points[i]);
    double share = safe_share(yarns_, segments_, near_, kReach, barrier_.from, *found);
    for (int halving = 0; halving < 4; ++halving, share *= 0.5) {
      PeriodicYarns next = moved(yarns_, *found, share);
      const double after = energy_of(next);
      if (!(after <= energy_ + 1e-4 * share * slope)) continue;
      if (halving > 1) damping_ *= 4;
      if (halving == 0 && attempt == 0) damping_ = std::max(0.2 * damping_, kLeastDamping);
      yarns_.points = std::move(next.points);
      yarns_.period = next.period;
      return true;
    }
    damping_ = std::max(8 * damping_, kLeastShift);
  }
  return false;
}

}  // namespace wale
