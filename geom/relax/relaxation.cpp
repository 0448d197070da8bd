// Newton's method on E(points, period) = stretch + bending + contact - tension, in units of the yarn's diameter D and
// bending stiffness B.
//
//   stretch   K/2 l0 (|e|/l0 - 1)^2                   per segment of rest length l0
//   bending   1/l (1 - t1.t2) = |t2 - t1|^2 / 2l      per joint, unit edges t: theta^2/2l for small angles
//   contact   -k (d - a)^2 ln((d - c) / (a - c))      per pair of segments at distance d < a, infinite at c: the
//   barrier
//                                                     of Li et al. 2020 (Incremental Potential Contact), from c, not 0
//
// Each term is a function of sums v = sum w_i x_i + S p of points and period p, where weights of the closest points of
// two segments are held: then gradients are exact (they are closest), and Hessians keep their positive part only.
//
// No yarn passes through another. On a step every point goes straight. Two segments at distance d of which no two ends
// move by more than m against each other keep d - m or more on the way, so a step is cut to 0.9 d / m for every pair
// within reach R. For pairs beyond it the step of a point is split into the stretch A of the whole tile and the rest,
// at most r: they keep (1 - |A|) R - 2 r, of which half of R is left. Energies are infinite below c, so no pair rests
// closer than that.
#include "geom/relax/relaxation.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

namespace wale {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

// One v = sum of weight * point + shift * period.
struct Combination {
  int count = 0;
  uint32_t point[4];
  double weight[4];
  dvec2 shift{0, 0};
};

dvec3 value(const Combination& c, const PeriodicYarns& yarns) {
  dvec3 v(c.shift.x * yarns.period.x, c.shift.y * yarns.period.y, 0);
  for (int k = 0; k < c.count; ++k) v += c.weight[k] * yarns.points[c.point[k]];
  return v;
}

class Energy {
 public:
  Energy(const RelaxSettings& settings, const std::vector<YarnSegment>& segments, size_t points)
      : settings_(settings), segments_(segments), unknowns_(3 * points + 2) {}

  void contact(double from, double closest) { contact_from_ = from, closest_ = closest; }
  double closest() const { return closest_; }
  void pairs(std::vector<SegmentPair> pairs) { pairs_ = std::move(pairs); }
  const std::vector<SegmentPair>& pairs() const { return pairs_; }

  Closest pair_distance(const PeriodicYarns& y, const SegmentPair& pair) const {
    const YarnSegment &f = segments_[pair.first], &g = segments_[pair.second];
    const auto at = [&](uint32_t i, ivec2 by) {
      return y.points[i] + dvec3(by.x * y.period.x, by.y * y.period.y, 0.0);
    };
    return closest_points(at(f.a, {0, 0}), at(f.b, f.shift), at(g.a, pair.image), at(g.b, pair.image + g.shift));
  }

  double energy(const PeriodicYarns& y) const {
    double sum = 0;
    for (const YarnSegment& s : segments_) {
      const double strain = glm::length(value(edge(s), y)) / s.length - 1;
      sum += 0.5 * settings_.stretch_stiffness * s.length * strain * strain;
    }
    for (size_t i = 0; i < segments_.size(); ++i) {
      const YarnSegment &s = segments_[i], &n = next(i);
      const dvec3 bend = glm::normalize(value(edge(n), y)) - glm::normalize(value(edge(s), y));
      sum += 0.5 / s.length * glm::dot(bend, bend);
    }
    for (const SegmentPair& pair : pairs_) {
      const double d = glm::length(pair_distance(y, pair).way);
      if (d >= contact_from_) continue;
      if (!(d > closest_)) return INFINITY;
      sum -= settings_.contact_stiffness * (d - contact_from_) * (d - contact_from_) *
             std::log((d - closest_) / (contact_from_ - closest_));
    }
    return sum - settings_.tension.x * y.period.x * y.period.y - settings_.tension.y * y.period.y * y.period.x;
  }

  // Gradient and the positive part of the Hessian.
  void differentiate(const PeriodicYarns& y, Vector& gradient, Matrix& hessian) {
    gradient = Vector::Zero(long(unknowns_));
    entries_.clear();
    for (const YarnSegment& s : segments_) {
      const Combination c = edge(s);
      const dvec3 v = value(c, y);
      const double length = glm::length(v), strain = length / s.length - 1;
      const dvec3 t = v / length;
      const double pull = settings_.stretch_stiffness * strain;
      add(c, pull * t, gradient);
      const double along = settings_.stretch_stiffness / s.length, across = std::max(0.0, pull / length);
      add(c, c, across * glm::dmat3(1.0) + (along - across) * glm::outerProduct(t, t));
    }
    for (size_t i = 0; i < segments_.size(); ++i) {
      const Combination c1 = edge(segments_[i]), c2 = edge(next(i));
      const dvec3 v1 = value(c1, y), v2 = value(c2, y);
      const double l1 = glm::length(v1), l2 = glm::length(v2), stiffness = 1 / segments_[i].length;
      const dvec3 t1 = v1 / l1, t2 = v2 / l2, bend = t2 - t1;
      const dmat3 j1 = (glm::outerProduct(t1, t1) - dmat3(1.0)) / l1,
                  j2 = (dmat3(1.0) - glm::outerProduct(t2, t2)) / l2;
      add(c1, stiffness * (j1 * bend), gradient);
      add(c2, stiffness * (j2 * bend), gradient);
      add(c1, c1, stiffness * (j1 * j1));
      add(c2, c2, stiffness * (j2 * j2));
      add(c1, c2, stiffness * (j1 * j2));
      add(c2, c1, stiffness * (j2 * j1));
    }
    const double k = settings_.contact_stiffness, a = contact_from_, c0 = closest_;
    for (const SegmentPair& pair : pairs_) {
      const Closest at = pair_distance(y, pair);
      const double d = glm::length(at.way);
      if (d >= a) continue;
      const YarnSegment &f = segments_[pair.first], &g = segments_[pair.second];
      Combination c;
      c.count = 4;
      const uint32_t points[] = {f.a, f.b, g.a, g.b};
      const double weights[] = {1 - at.s, at.s, at.t - 1, -at.t};
      std::copy(points, points + 4, c.point);
      std::copy(weights, weights + 4, c.weight);
      c.shift = at.s * dvec2(f.shift) - dvec2(pair.image) - at.t * dvec2(g.shift);
      const dvec3 n = at.way / d;
      const double log = std::log((d - c0) / (a - c0)), gap = d - a, room = d - c0;
      add(c, -k * (2 * gap * log + gap * gap / room) * n, gradient);
      add(c, c, k * (-2 * log - 4 * gap / room + gap * gap / (room * room)) * glm::outerProduct(n, n));
    }
    const size_t px = unknowns_ - 2, py = px + 1;
    gradient[long(px)] -= (settings_.tension.x + settings_.tension.y) * y.period.y;
    gradient[long(py)] -= (settings_.tension.x + settings_.tension.y) * y.period.x;
    hessian.resize(long(unknowns_), long(unknowns_));
    hessian.setFromTriplets(entries_.begin(), entries_.end());
  }

 private:
  Combination edge(const YarnSegment& s) const {
    Combination c;
    c.count = 2;
    c.point[0] = s.b, c.point[1] = s.a;
    c.weight[0] = 1, c.weight[1] = -1;
    c.shift = dvec2(s.shift);
    return c;
  }
  // The segment after this one along its yarn: the segments of a yarn follow one another.
  const YarnSegment& next(size_t i) const {
    if (i + 1 < segments_.size() && segments_[i + 1].yarn == segments_[i].yarn) return segments_[i + 1];
    size_t first = i;
    while (first > 0 && segments_[first - 1].yarn == segments_[i].yarn) --first;
    return segments_[first];
  }
  void add(const Combination& c, const dvec3& force, Vector& gradient) const {
    for (int i = 0; i < c.count; ++i)
      for (int a = 0; a < 3; ++a) gradient[long(3 * c.point[i]) + a] += c.weight[i] * force[a];
    gradient[long(unknowns_) - 2] += c.shift.x * force.x;
    gradient[long(unknowns_) - 1] += c.shift.y * force.y;
  }
  // Only the lower triangle is kept.
  void add(const Combination& c, const Combination& d, const dmat3& block) {
    struct Unknown {
      long at;
      int axis;
      double weight;
    };
    Unknown rows[14], columns[14];
    const auto list = [&](const Combination& x, Unknown* out) {
      int n = 0;
      for (int i = 0; i < x.count; ++i)
        for (int a = 0; a < 3; ++a) out[n++] = {long(3 * x.point[i]) + a, a, x.weight[i]};
      if (x.shift.x != 0) out[n++] = {long(unknowns_) - 2, 0, x.shift.x};
      if (x.shift.y != 0) out[n++] = {long(unknowns_) - 1, 1, x.shift.y};
      return n;
    };
    const int n = list(c, rows), m = list(d, columns);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < m; ++j)
        if (rows[i].at >= columns[j].at)
          entries_.emplace_back(int(rows[i].at), int(columns[j].at),
                                rows[i].weight * columns[j].weight * block[columns[j].axis][rows[i].axis]);
  }

  const RelaxSettings& settings_;
  const std::vector<YarnSegment>& segments_;
  size_t unknowns_;
  double contact_from_ = 1, closest_ = 0.95;
  std::vector<SegmentPair> pairs_;
  std::vector<Eigen::Triplet<double>> entries_;
};

constexpr double kSoft = 0.6;

PeriodicYarns moved(const PeriodicYarns& y, const Vector& step, double share) {
  PeriodicYarns out = y;
  for (size_t i = 0; i < y.points.size(); ++i)
    for (int a = 0; a < 3; ++a) out.points[i][a] += share * step[long(3 * i) + a];
  out.period += share * dvec2(step[step.size() - 2], step[step.size() - 1]);
  return out;
}

class Relaxation {
 public:
  Relaxation(PeriodicYarns& yarns, const RelaxSettings& settings)
      : yarns_(yarns),
        settings_(settings),
        segments_(segments_of(yarns)),
        energy_(settings_, segments_, yarns.points.size()) {}

  // Newton steps until forces are below the tolerance or `most` are done.
  void settle(double tolerance, int most, bool free_period, Relaxed& out) {
    free_ = free_period;
    for (int step = 0; step < most; ++step) {
      find_pairs();
      energy_.differentiate(yarns_, gradient_, hessian_);
      clamp_period();
      measure(out);
      ++out.steps;
      if (out.force < tolerance && out.period_force < tolerance) return;
      if (!move()) return;
    }
  }

  void find_pairs() { energy_.pairs(near_pairs(yarns_, segments_, kReach, settings_.neighbours)); }
  double closest() const {
    double least = kReach;
    for (const SegmentPair& pair : energy_.pairs())
      least = std::min(least, glm::length(energy_.pair_distance(yarns_, pair).way));
    return least;
  }
  double strain() const {
    double most = 0;
    for (const YarnSegment& s : segments_) {
      const dvec3 v = yarns_.points[s.b] - yarns_.points[s.a] +
                      dvec3(s.shift.x * yarns_.period.x, s.shift.y * yarns_.period.y, 0.0);
      most = std::max(most, std::abs(glm::length(v) / s.length - 1));
    }
    return most;
  }
  Energy& energy() { return energy_; }

 private:
  static constexpr double kReach = 1.6;  // D; pairs beyond need no look at a time

  void clamp_period() {
    const long px = gradient_.size() - 2;
    const bool hold[] = {!(free_ && settings_.free_period_x), !(free_ && settings_.free_period_y)};
    for (int k = 0; k < 2; ++k)
      if (hold[k]) {
        gradient_[px + k] = 0;
        for (Matrix::InnerIterator it(hessian_, px + k); it; ++it) it.valueRef() = 0;
        for (long column = 0; column < px + k; ++column)
          for (Matrix::InnerIterator it(hessian_, column); it; ++it)
            if (it.row() == px + k) it.valueRef() = 0;
        hessian_.coeffRef(px + k, px + k) = 1;
      }
  }

  void measure(Relaxed& out) const {
    out.force = 0;
    for (long i = 0; i + 2 < gradient_.size(); i += 3)
      out.force = std::max(out.force, std::sqrt(gradient_[i] * gradient_[i] + gradient_[i + 1] * gradient_[i + 1] +
                                                gradient_[i + 2] * gradient_[i + 2]));
    out.period_force = std::max(std::abs(gradient_[gradient_.size() - 2]), std::abs(gradient_[gradient_.size() - 1]));
  }

  bool move() {
    const double before = energy_.energy(yarns_);
    for (int attempt = 0; attempt < 12; ++attempt, damping_ *= 8) {
      Matrix damped = hessian_;
      for (long i = 0; i < damped.rows(); ++i) damped.coeffRef(i, i) += damping_;
      solver_.compute(damped);
      if (solver_.info() != Eigen::Success) continue;
      const Vector step = solver_.solve(-gradient_);
      const double slope = gradient_.dot(step);
      if (!(slope < 0)) continue;
      double share = allowed(step);
      for (int halving = 0; halving < 8; ++halving, share *= 0.5) {
        const PeriodicYarns next = moved(yarns_, step, share);
        const double after = energy_.energy(next);
        if (!(after <= before + 1e-4 * share * slope)) continue;
        yarns_.points = next.points;
        yarns_.period = next.period;
        if (halving == 0) damping_ = std::max(1e-6, damping_ * 0.3);
        return true;
      }
    }
    damping_ = 1e-2;
    return false;
  }

  // Share of the step on which no pair can meet.
  double allowed(const Vector& step) const {
    const auto way = [&](uint32_t i) { return dvec3(step[long(3 * i)], step[long(3 * i) + 1], step[long(3 * i) + 2]); };
    const dvec2 period(step[step.size() - 2], step[step.size() - 1]);
    const dvec3 stretch(period / yarns_.period, 0);
    double own = 0;
    for (size_t i = 0; i < yarns_.points.size(); ++i)
      own = std::max(own, glm::length(way(uint32_t(i)) - stretch * yarns_.points[i]));
    const double affine = std::max(std::abs(stretch.x), std::abs(stretch.y));
    double share = std::min(1.0, 0.5 * kReach / std::max(2 * own + affine * kReach, 1e-300));
    share = std::min(share, 0.3 / std::max(affine, 1e-300));
    for (const SegmentPair& pair : energy_.pairs()) {
      const YarnSegment &f = segments_[pair.first], &g = segments_[pair.second];
      const auto image = [&](ivec2 by) { return dvec3(dvec2(by) * period, 0); };
      double motion = 0;
      for (const dvec3& a : {way(f.a), way(f.b) + image(f.shift)})
        for (const dvec3& b : {way(g.a) + image(pair.image), way(g.b) + image(pair.image + g.shift)})
          motion = std::max(motion, glm::length(a - b));
      if (motion > 0) share = std::min(share, 0.9 * glm::length(energy_.pair_distance(yarns_, pair).way) / motion);
    }
    return share;
  }

  PeriodicYarns& yarns_;
  RelaxSettings settings_;
  std::vector<YarnSegment> segments_;
  Energy energy_;
  Vector gradient_;
  Matrix hessian_;
  Eigen::SimplicialLDLT<Matrix> solver_;
  bool free_ = false;
  double damping_ = 1e-3;
};

}  // namespace

Relaxed relax(PeriodicYarns& yarns, const RelaxSettings& settings,
              const std::function<bool(double, double)>& progress) {
  const double diameter = 2 * yarns.radius;
  PeriodicYarns scaled = yarns;
  for (dvec3& p : scaled.points) p /= diameter;
  for (PeriodicYarn& y : scaled.yarns) y.length /= diameter;
  scaled.period /= diameter;
  Relaxation work(scaled, settings);
  Relaxed out;
  const auto finish = [&] {
    work.find_pairs();
    out.closest = work.closest();
    out.strain = work.strain();
    for (size_t i = 0; i < yarns.points.size(); ++i) yarns.points[i] = scaled.points[i] * diameter;
    yarns.period = scaled.period * diameter;
    return out;
  };
  work.find_pairs();
  // The yarn swells under a wide barrier, from kSoft of its diameter on; with its whole diameter the barrier narrows.
  double share = 0, hardness = kSoft;
  while (out.steps < settings.max_steps && (share < 1 || hardness < settings.closest)) {
    const double room = work.closest();
    if (share < 1)
      share = std::clamp(0.9 * room / kSoft, share * 1.0, std::min(1.0, share == 0 ? 1.0 : share * 1.25));
    else
      hardness = std::clamp(0.5 * (hardness + room), hardness, settings.closest);
    if (share == 1 && hardness > 0.995 * settings.closest && room > settings.closest) hardness = settings.closest;
    work.energy().contact(share, share * hardness);
    work.settle(0.1, 8, share > 0.6 || work.strain() > 0.02, out);
    out.thickness_share = share;
    if (progress && !progress(share, out.force)) return finish();
  }
  work.settle(settings.force_tolerance, std::max(0, settings.max_steps - out.steps), true, out);
  out.converged = share >= 1 && hardness >= settings.closest && out.force < settings.force_tolerance &&
                  out.period_force < settings.force_tolerance;
  return finish();
}

double closest_distance(const PeriodicYarns& yarns, double neighbours, double reach) {
  const std::vector<YarnSegment> segments = segments_of(yarns);
  RelaxSettings settings;
  const Energy energy(settings, segments, yarns.points.size());
  double least = reach;
  for (const SegmentPair& pair : near_pairs(yarns, segments, reach, neighbours))
    least = std::min(least, glm::length(energy.pair_distance(yarns, pair).way));
  return least;
}

}  // namespace wale
