#include "geom/fibre_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/error.h"

namespace wale {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kMaxPacking = 0.7;    ///< disordered discs jam at 0.82; the wall takes its share
constexpr double kOverlapLeft = 1e-3;  ///< fibre radii; pushing apart stops here

constexpr double kMostOverlap = 0.1;  ///< fibre radii; more than that and it is no section of fibres

struct Disc {
  double x, y;
};

/// Discs by cells a little wider than they are: who may touch whom.
class Grid {
 public:
  Grid(const std::vector<Disc>& discs, double radius) : size_(2.1 * radius), across_(int(2 / size_) + 3) {
    cells_.resize(size_t(across_) * size_t(across_));
    for (size_t i = 0; i < discs.size(); ++i) cells_[cell(discs[i].x, discs[i].y)].push_back(i);
  }
  template <typename Visit>
  void beside(const Disc& d, const Visit& visit) const {
    for (const double dy : {-size_, 0.0, size_})
      for (const double dx : {-size_, 0.0, size_})
        for (const size_t i : cells_[cell(d.x + dx, d.y + dy)]) visit(i);
  }

 private:
  size_t cell(double x, double y) const {
    const auto at = [&](double v) { return std::clamp(int((v + 1) / size_) + 1, 0, across_ - 1); };
    return size_t(at(y)) * size_t(across_) + size_t(at(x));
  }
  double size_;
  int across_;
  std::vector<std::vector<size_t>> cells_;
};

class Placer {
 public:
  Placer(const FibreRecipe& recipe, double radius) : recipe_(recipe), radius_(radius), random_(recipe.seed) {}

  std::vector<Disc> place() {
    const int tries = 400 * recipe_.fibres;
    for (int i = 0; i < tries && int(discs_.size()) < recipe_.fibres; ++i) {
      const Disc disc = draw();
      if (!touches(disc)) discs_.push_back(disc);
    }
    if (int(discs_.size()) == recipe_.fibres) return discs_;
    while (int(discs_.size()) < recipe_.fibres) discs_.push_back(draw());
    push_apart();
    return discs_;
  }

  double uniform() { return double(random_() >> 11) * 0x1p-53; }

  /// Deepest overlap of two fibres, fibre radii.
  double overlap() const {
    double deepest = 0;
    const Grid grid(discs_, radius_);
    for (size_t i = 0; i < discs_.size(); ++i)
      grid.beside(discs_[i], [&](size_t j) {
        if (j < i)
          deepest = std::max(deepest, 2 - std::hypot(discs_[i].x - discs_[j].x, discs_[i].y - discs_[j].y) / radius_);
      });
    return deepest;
  }

 private:
  double density(double r) const {
    const double falling = (std::numbers::e - std::exp(r)) / (std::numbers::e - 1);
    return (1 - 2 * recipe_.radial_epsilon) * std::pow(std::max(falling, 0.0), recipe_.radial_beta) +
           recipe_.radial_epsilon;
  }

  /// Uniform in the disc that centres may lie in, kept with probability p(R) relative to its largest value p(0).
  Disc draw() {
    for (;;) {
      const double r = (1 - radius_) * std::sqrt(uniform()), angle = kTwoPi * uniform();
      if (uniform() * density(0) <= density(r)) return {r * std::cos(angle), r * std::sin(angle)};
    }
  }

  bool touches(const Disc& d) const {
    const double least = 4 * radius_ * radius_;
    return std::any_of(discs_.begin(), discs_.end(), [&](const Disc& o) {
      const double dx = d.x - o.x, dy = d.y - o.y;
      return dx * dx + dy * dy < least;
    });
  }

  /// Moves every overlapping pair half apart each, and back inside the wall, until nothing overlaps.
  void push_apart() {
    constexpr int kRounds = 4000;
    for (int round = 0; round < kRounds && overlap() > kOverlapLeft; ++round) {
      const Grid grid(discs_, radius_);  // of where they were: a pair that only now overlaps waits for the next round
      for (size_t i = 0; i < discs_.size(); ++i)
        grid.beside(discs_[i], [&](size_t j) {
          if (j >= i) return;
          Disc &a = discs_[i], &b = discs_[j];
          const double dx = a.x - b.x, dy = a.y - b.y, d = std::hypot(dx, dy);
          const double apart = 0.5 * (2.0005 * radius_ - d);
          if (apart <= 0) return;
          const double ux = d > 0 ? dx / d : 1, uy = d > 0 ? dy / d : 0;
          a.x += apart * ux, a.y += apart * uy;
          b.x -= apart * ux, b.y -= apart * uy;
        });
      keep_inside();
    }
  }

  void keep_inside() {
    for (Disc& d : discs_) {
      const double r = std::hypot(d.x, d.y), wall = 1 - radius_;
      if (r > wall) d.x *= wall / r, d.y *= wall / r;
    }
  }

  const FibreRecipe& recipe_;
  const double radius_;
  std::mt19937_64 random_;
  std::vector<Disc> discs_;
};

void check(const FibreRecipe& r) {
  if (r.fibres < 1 || r.fibres > 4096) user_error("fibres: count is {}; give 1 to 4096", r.fibres);
  if (!(r.packing > 0 && r.packing <= kMaxPacking))
    user_error("fibres: packing is {}; give a share above 0, at most {}", r.packing, kMaxPacking);
  if (!(r.radial_beta >= 0 && r.radial_beta <= 20))
    user_error("fibres: radial beta is {}; give 0 (uniform) to 20", r.radial_beta);
  if (!(r.radial_epsilon >= 0 && r.radial_epsilon <= 0.5))
    user_error("fibres: radial epsilon is {}; give 0 to 0.5", r.radial_epsilon);
  if (!(r.migration_min > 0 && r.migration_min <= 1))
    user_error("fibres: least migration radius is {}; give a share above 0, at most 1", r.migration_min);
}

}  // namespace

double fibre_radius(const FibreRecipe& recipe) {
  check(recipe);
  return std::sqrt(recipe.packing / recipe.fibres);
}

FibreSection make_fibre_section(const FibreRecipe& recipe) {
  FibreSection section;
  section.fibre_radius = fibre_radius(recipe);
  Placer placer(recipe, section.fibre_radius);
  for (const Disc& d : placer.place())
    section.fibres.push_back({std::hypot(d.x, d.y), std::atan2(d.y, d.x), kTwoPi * placer.uniform()});
  section.overlap = std::max(0.0, placer.overlap());
  if (section.overlap > kMostOverlap)
    user_error(
        "fibres: {} fibres of packing {} do not fit side by side into a ply; give a smaller packing, or more fibres",
        recipe.fibres, recipe.packing);
  return section;
}

double fibre_distance(const FibreSection::Fibre& fibre, const FibreRecipe& recipe, double theta) {
  const double swing = 0.5 * (std::cos(recipe.migration_rate * theta + fibre.phase) + 1);
  return fibre.distance * (recipe.migration_min + (1 - recipe.migration_min) * swing);
}

}  // namespace wale
