#include "geom/cycle_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geom/double_reflection.h"
#include "geom/error.h"
#include "geom/yarn_spline.h"

namespace wale {
namespace {

constexpr int kFine = 8;          // steps between two samples, for frames and for the error
constexpr int kPhases = 12;       // phases at which the error is measured; the worst one is missed by < 3.5 %
constexpr double kMargin = 0.95;  // ... which this makes good
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr long kMostSamples = 200000;  // per tile yarn

/// One cycle at uniform arc length inside each link: kFine steps per sample.
struct FineCycle {
  std::vector<dvec3> centre, tangent, normal;
  std::vector<double> arc;
  std::vector<long> link_start;  ///< sample (not step) with which each link begins, then the number of samples
};

FineCycle trace(const YarnSpline& spline, const ArcLength& arc_length, double spacing) {
  FineCycle fine;
  fine.link_start.push_back(0);
  for (size_t link = 0; link + 1 < spline.link_start().size(); ++link) {
    const double begin = arc_length.span_start(spline.link_start()[link]);
    const double end = arc_length.span_start(spline.link_start()[link + 1]);
    const long samples = std::max(1L, static_cast<long>(std::ceil((end - begin) / spacing - 1e-9)));
    for (long i = 0; i < samples * kFine; ++i)
      fine.arc.push_back(begin + (end - begin) * double(i) / (samples * kFine));
    fine.link_start.push_back(fine.link_start.back() + samples);
  }
  fine.arc.push_back(arc_length.total());
  for (const double s : fine.arc) {
    const ArcLength::Place at = arc_length.at(s);
    fine.centre.push_back(spline.position(at.span, at.u));
    const dvec3 along = spline.derivative(at.span, at.u);
    const double speed = glm::length(along);
    fine.tangent.push_back(speed > 0 ? along / speed : fine.tangent.empty() ? dvec3(1, 0, 0) : fine.tangent.back());
  }
  fine.centre.back() = fine.centre.front() + spline.advance();
  fine.tangent.back() = fine.tangent.front();
  fine.normal.push_back(any_normal(fine.tangent[0]));
  for (size_t i = 1; i < fine.centre.size(); ++i)
    fine.normal.push_back(double_reflection(fine.normal[i - 1], fine.centre[i - 1], fine.tangent[i - 1], fine.centre[i],
                                            fine.tangent[i]));
  return fine;
}

double distance_to_chord(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 ab = b - a;
  const double c = glm::dot(ab, ab);
  const double t = c > 0 ? std::clamp(glm::dot(p - a, ab) / c, 0.0, 1.0) : 0;
  return glm::length(p - a - t * ab);
}

/// Largest distance of the ply curve from its polyline over all phases, metres. A ply at phase q lies at
/// centre + cos q A + sin q B with A = h (cos w N + sin w B), B = h (cos w B - sin w N), w = 2 pi twist s.
double polyline_error(const FineCycle& fine, double helix_radius, double twist) {
  double worst = 0;
  const int phases = helix_radius > 0 ? kPhases : 1;
  dvec3 a[kFine + 1], b[kFine + 1];
  for (size_t start = 0; start + kFine < fine.centre.size(); start += kFine) {
    for (int i = 0; i <= kFine; ++i) {
      const dvec3& n = fine.normal[start + i];
      const dvec3 m = glm::cross(fine.tangent[start + i], n);
      const double w = kTwoPi * twist * (fine.arc[start + i] - fine.arc[start]);
      a[i] = helix_radius * (std::cos(w) * n + std::sin(w) * m);
      b[i] = helix_radius * (std::cos(w) * m - std::sin(w) * n);
    }
    for (int phase = 0; phase < phases; ++phase) {
      const double c = std::cos(kTwoPi * phase / phases), s = std::sin(kTwoPi * phase / phases);
      const auto ply = [&](int i) { return fine.centre[start + i] + c * a[i] + s * b[i]; };
      const dvec3 first = ply(0), last = ply(kFine);
      for (int i = 1; i < kFine; ++i) worst = std::max(worst, distance_to_chord(ply(i), first, last));
    }
  }
  return worst;
}

/// The same for fibres that wind about the ply with curvature w. On the outside of a bend of curvature k a fibre at
/// radius R takes a step longer by 1 + k R and bends by k / (1 + k R): its sagitta is that of the ply times 1 + k R.
double fibre_error(double ply_error, const FineCycle& fine, const YarnSpec& spec, double twist) {
  double step = 0;
  for (size_t i = kFine; i < fine.arc.size(); i += kFine) step = std::max(step, fine.arc[i] - fine.arc[i - kFine]);
  step *= std::hypot(1, kTwoPi * twist * spec.helix_radius);
  const double bend = 8 * ply_error / (step * step);
  return ply_error * (1 + bend * spec.ply_radius) + spec.winding * step * step / 8;
}

/// Coarsest spacing that keeps the error, which falls with its square, within the tolerance.
FineCycle trace_within(const YarnSpline& spline, const ArcLength& arc_length, const YarnSpec& spec, double twist,
                       double widest, const std::string& name) {
  const double tolerance = kMargin * spec.tolerance * spec.ply_radius;
  widest = std::min(widest, arc_length.total() / 8);
  double spacing = widest;
  FineCycle best;
  double best_spacing = 0;
  for (int step = 0; step < 40; ++step) {
    if (arc_length.total() / spacing > kMostSamples)
      user_error("pattern '{}': a tolerance of {} ply radii asks for more than {} samples per yarn and tile", name,
                 spec.tolerance, kMostSamples);
    FineCycle fine = trace(spline, arc_length, spacing);
    double error = polyline_error(fine, spec.helix_radius, twist);
    if (spec.winding >= 0) error = fibre_error(error, fine, spec, twist);
    const double used = spacing;
    if (error <= tolerance) {
      best = std::move(fine);
      best_spacing = used;
      if (used >= widest || error > 0.9 * tolerance || step > 8) return best;
      spacing = std::min({widest, used * 1.5, used * std::sqrt(0.97 * tolerance / std::max(error, 1e-30))});
    } else {
      // A coarser try after a good one has failed: the good one is near enough.
      if (best_spacing > 0) return best;
      spacing = used * std::clamp(std::sqrt(0.97 * tolerance / error), 0.1, 0.97);
    }
  }
  if (best_spacing > 0) return best;
  user_error("pattern '{}': a tolerance of {} ply radii cannot be met", name, spec.tolerance);
}

/// Offsets of a yarn's samples in every shape of the tile's strain table, per link.
void add_strained(const Pattern& pattern, const YarnChain& yarn, dvec3 scale, const YarnSpline& spline,
                  const ArcLength& arc_length, TileSamples& tile) {
  const auto& shapes = pattern.strains.offsets;
  std::vector<YarnSpline> moves;
  for (const auto& offsets : shapes) moves.emplace_back(pattern, yarn, scale, offsets, spline);
  for (const Link& link : yarn.links) {
    LinkSamples& samples = tile.of_curve[link.curve];
    for (const double s : samples.arc) {
      const ArcLength::Place at = arc_length.at(s);
      for (const YarnSpline& move : moves) samples.strained.push_back(move.position(at.span, at.u));
    }
  }
}

/// Passes of its cycle after which a yarn meets itself; 0 if it never does.
int passes_to_close(ivec2 shift, ivec2 wrap) {
  int passes = 1;
  for (const int axis : {0, 1}) {
    if (shift[axis] == 0) continue;
    if (wrap[axis] <= 0) return 0;
    passes = std::lcm(passes, wrap[axis] / std::gcd(wrap[axis], shift[axis]));
  }
  return passes;
}

void check_spec(const YarnSpec& spec, dvec3 scale) {
  const auto good = [](double value) { return value > 0 && std::isfinite(value); };
  if (spec.plies < 1 || spec.plies > 8) user_error("a yarn of {} plies: choose 1 to 8", spec.plies);
  if (!good(spec.ply_radius)) user_error("a ply radius of {} m: it must be positive", spec.ply_radius);
  if (!good(spec.tolerance)) user_error("a tolerance of {} ply radii: it must be positive", spec.tolerance);
  if (!(spec.helix_radius >= 0) || !std::isfinite(spec.helix_radius))
    user_error("a helix radius of {} m: it must not be negative", spec.helix_radius);
  if (!std::isfinite(spec.twist) || !std::isfinite(spec.phase))
    user_error("a twist of {} turns per metre, phase {}: both must be finite", spec.twist, spec.phase);
  if (!good(scale.x) || !good(scale.y) || !good(scale.z))
    user_error("a tile scale of {} x {} x {}: all must be positive", scale.x, scale.y, scale.z);
}

}  // namespace

TileSamples sample_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
                        ivec2 wrap) {
  check_spec(spec, scale);
  TileSamples tile;
  tile.of_curve.resize(pattern.curves.size());
  const dvec3 period(pattern.period.x * scale.x, pattern.period.y * scale.y, 0);
  // Straight yarns too must follow a bent base mesh: four samples a stitch at least.
  const double widest =
      std::min(period.x / std::max(1, pattern.stitches.x), period.y / std::max(1, pattern.stitches.y)) / 4;
  for (const YarnChain& yarn : tile_yarns(pattern, partners)) {
    const YarnSpline spline(pattern, yarn, scale);
    const ArcLength arc_length(spline);
    const int passes = passes_to_close(yarn.shift, wrap);
    const double closing = passes > 0 ? 0.5 / (passes * arc_length.total()) : 0;
    const double twist = spec.twist + std::copysign(closing, spec.twist);
    const FineCycle fine = trace_within(spline, arc_length, spec, twist, widest, pattern.name);

    CycleSamples cycle;
    cycle.length = arc_length.total();
    cycle.links = static_cast<int>(yarn.links.size());
    cycle.samples = fine.link_start.back();
    const dvec3 binormal = glm::cross(fine.tangent[0], fine.normal[0]);
    cycle.turn = std::atan2(glm::dot(fine.normal.back(), binormal), glm::dot(fine.normal.back(), fine.normal[0]));
    for (int order = 0; order < cycle.links; ++order) {
      const Link& link = yarn.links[order];
      LinkSamples& samples = tile.of_curve[link.curve];
      samples.cycle = static_cast<int>(tile.cycles.size());
      samples.order = order;
      const dvec3 origin = dvec3(link.instance.x, link.instance.y, 0) * period;
      for (long i = fine.link_start[order]; i < fine.link_start[order + 1]; ++i) {
        const long step = i * kFine;
        samples.centre.push_back(fine.centre[step] - origin);
        samples.normal.push_back(fine.normal[step]);
        samples.binormal.push_back(glm::cross(fine.tangent[step], fine.normal[step]));
        samples.arc.push_back(fine.arc[step]);
      }
    }
    if (spec.strains) add_strained(pattern, yarn, scale, spline, arc_length, tile);
    tile.cycles.push_back(cycle);
  }
  return tile;
}

double yarn_per_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale) {
  double sum = 0;
  for (const CycleSamples& cycle : sample_tile(pattern, partners, spec, scale).cycles) sum += cycle.length;
  return sum;
}

long samples_per_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale) {
  long sum = 0;
  for (const CycleSamples& cycle : sample_tile(pattern, partners, spec, scale).cycles) sum += cycle.samples;
  return sum;
}

}  // namespace wale
