// The two periods of a tile that states neither, from where its curves end (KNIT21 section 3.1 needs them to match).
#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/error.h"
#include "geom/near_points.h"
#include "geom/pattern_readers.h"

namespace wale {
namespace {

// Every pair of ends votes, and the best votes are tried with each other: beyond this it is no tile, and takes for
// ever.
constexpr size_t kMostEnds = 512;

/// A curve end and the point before it, for blocks that overlap by two points (of which a curve of two has no inner
/// one).
struct End {
  dvec3 point, inner;
  bool has_inner = false;
};

/// Distance by which the two ends miss each other when f is displaced, for an overlap by one point or by two.
double miss(const End& e, const End& f, dvec3 shift) {
  const double one = glm::distance(e.point, f.point + shift);
  if (!e.has_inner || !f.has_inner) return one;
  const double two = std::max(glm::distance(e.point, f.inner + shift), glm::distance(e.inner, f.point + shift));
  return std::min(one, two);
}

struct Match {
  int paired = 0;
  double worst = 0;
  dvec2 sum{0, 0};  ///< of the displacements, per crossed period
  ivec2 crossings{0, 0};
};

/// Pairs every end with its nearest end under the periods; counts those that are nearest to each other. Gives up,
/// counting none, once fewer than `wanted` can be: most periods that are tried leave an end alone at once.
Match match(const std::vector<End>& ends, const NearPoints& places, dvec2 period, double tolerance, int wanted) {
  struct Nearest {
    size_t to = 0;
    ivec2 shift{0, 0};
    double distance = std::numeric_limits<double>::infinity();
  };
  std::vector<Nearest> nearest(ends.size());
  int possible = static_cast<int>(ends.size());
  for (size_t i = 0; i < ends.size(); ++i) {
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const dvec3 shift(x * period.x, y * period.y, 0);
        const auto consider = [&](int number) {
          const auto j = static_cast<size_t>(number);
          if (i == j) return;
          const double distance = miss(ends[i], ends[j], shift);
          Nearest& best = nearest[i];
          if (distance < best.distance || (distance == best.distance && j < best.to)) best = {j, {x, y}, distance};
        };
        places.visit_near(ends[i].point - shift, consider);                         // overlap by one point
        if (ends[i].has_inner) places.visit_near(ends[i].inner - shift, consider);  // by two
      }
    if (!(nearest[i].distance <= tolerance) && --possible < wanted) return {};
  }
  Match result;
  for (size_t i = 0; i < ends.size(); ++i) {
    const Nearest& to = nearest[i];
    const Nearest& back = nearest[to.to];
    if (!(to.distance <= tolerance) || back.to != i || back.shift != -to.shift) continue;
    ++result.paired;
    result.worst = std::max(result.worst, to.distance);
    const End &e = ends[i], &f = ends[to.to];
    const dvec3 shift(to.shift.x * period.x, to.shift.y * period.y, 0);
    const bool single = glm::distance(e.point, f.point + shift) <= tolerance;
    const dvec3 apart = single ? e.point - f.point : (e.point - f.inner + e.inner - f.point) * 0.5;
    for (const int axis : {0, 1})
      if (to.shift[axis] != 0) {
        result.sum[axis] += apart[axis] * to.shift[axis];
        ++result.crossings[axis];
      }
  }
  return result;
}

struct Candidate {
  double period = 0;
  int votes = 0;
};

/// Displacements along one axis between ends that agree across it; those within the tolerance of each other are one.
std::vector<Candidate> candidates(const std::vector<End>& ends, int axis, double least, double tolerance) {
  std::vector<double> found;
  for (const End& e : ends)
    for (const End& f : ends)
      for (const dvec3& apart : {e.point - f.point, e.point - f.inner})
        if (apart[axis] > least && std::abs(apart[1 - axis]) <= tolerance && std::abs(apart.z) <= tolerance)
          found.push_back(apart[axis]);
  std::sort(found.begin(), found.end());
  std::vector<Candidate> clusters;
  for (size_t i = 0; i < found.size();) {
    size_t j = i;
    double sum = 0;
    for (; j < found.size() && found[j] - found[i] <= tolerance; ++j) sum += found[j];
    clusters.push_back({sum / double(j - i), static_cast<int>(j - i)});
    i = j;
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Candidate& a, const Candidate& b) { return a.votes > b.votes; });
  constexpr size_t kMost = 24;
  if (clusters.size() > kMost) clusters.resize(kMost);
  return clusters;
}

}  // namespace

dvec2 recover_periods(const Pattern& pattern, dvec2 known, double tolerance, const std::filesystem::path& file) {
  if (known.x > 0 && known.y > 0) return known;
  std::vector<End> ends;
  for (const PatternCurve& curve : pattern.curves) {
    if (curve.closed) continue;
    const auto& p = curve.points;
    ends.push_back({p.front(), p[1], p.size() > 2});
    ends.push_back({p.back(), p[p.size() - 2], p.size() > 2});
  }
  if (ends.size() > kMostEnds)
    user_error("{}: {} curve ends are too many to recover the period from, at most {}; give the period", file.string(),
               ends.size(), kMostEnds);
  NearPoints places(tolerance);
  for (size_t i = 0; i < ends.size(); ++i) places.add(ends[i].point, static_cast<int>(i));
  std::vector<Candidate> along[2];
  for (const int axis : {0, 1}) {
    along[axis] = known[axis] > 0 ? std::vector<Candidate>{{known[axis], 0}}
                                  : candidates(ends, axis, 2 * pattern.yarn_radius, tolerance);
    if (along[axis].empty())
      user_error("{}: no two curve ends lie one {} period apart; give the period", file.string(),
                 axis == 0 ? "x" : "y");
  }
  const int all = static_cast<int>(ends.size());
  dvec2 best{0, 0};
  Match best_match;
  for (const Candidate& x : along[0])
    for (const Candidate& y : along[1]) {
      const Match tried = match(ends, places, {x.period, y.period}, tolerance, all);
      if (tried.paired < all || (best_match.paired == all && tried.worst >= best_match.worst)) continue;
      best = {x.period, y.period}, best_match = tried;
    }
  if (best_match.paired < all) {
    const dvec2 likeliest(along[0][0].period, along[1][0].period);
    user_error(
        "{}: the periods cannot be recovered: with {:.6g} x {:.6g} m, the likeliest, {} of {} curve ends find a "
        "partner; give the period",
        file.string(), likeliest.x, likeliest.y, match(ends, places, likeliest, tolerance, 0).paired, all);
  }
  // The mean over all crossings is exact where the file is, and least squares where it is not.
  for (const int axis : {0, 1}) {
    if (known[axis] > 0) continue;
    if (best_match.crossings[axis] == 0)
      user_error("{}: no curve crosses the {} border, so that period is unknown; give the period", file.string(),
                 axis == 0 ? "x" : "y");
    best[axis] = best_match.sum[axis] / best_match.crossings[axis];
  }
  return best;
}

}  // namespace wale
