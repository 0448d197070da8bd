#include "geom/flat_knit.h"

#include <cmath>
#include <numbers>

#include "geom/cycle_samples.h"
#include "geom/error.h"
#include "geom/ply_frames.h"
#include "geom/stitch_places.h"

namespace wale {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

}  // namespace

/// Lays the tile's samples along full yarns.
class FlatKnit::Layer {
 public:
  Layer(const Pattern& pattern, const PartnerMap& partners, TileSamples&& tile, const YarnSpec& spec, dvec3 scale)
      : tile_(std::move(tile)), spec_(spec), period_(pattern.period.x * scale.x, pattern.period.y * scale.y, 0) {
    for (const PatternCurve& curve : pattern.curves) color_of_curve_.push_back(curve.yarn);
    if (spec.places) places_ = stitch_places(pattern, partners, tile_, scale);
    shapes_ = pattern.strains.offsets.size();
    for (int ply = 0; ply < spec.plies; ++ply) {
      cos_.push_back(std::cos(kTwoPi * ply / spec.plies));
      sin_.push_back(std::sin(kTwoPi * ply / spec.plies));
    }
  }

  void lay(const YarnChain& chain, ivec2 end_instance, int end_curve, FlatYarn& yarn) const {
    yarn.closed = chain.closed;
    yarn.color = color_of_curve_[size_t(chain.links[0].curve)];
    size_t count = chain.closed ? 3 : 1;
    for (const Link& link : chain.links) count += tile_.of_curve[link.curve].centre.size();
    yarn.centre.resize(count);
    yarn.position.resize(count * spec_.plies);
    yarn.place.resize(spec_.places ? count : 0);
    yarn.strained.assign(spec_.strains ? count : 0, nullptr);

    const LinkSamples& first = tile_.of_curve[chain.links[0].curve];
    const CycleSamples& cycle = tile_.cycles[first.cycle];
    const Twist twist{first.arc[0], kTwoPi * spec_.twist + (chain.closed ? closing_correction(chain, cycle) : 0),
                      cycle};
    size_t at = chain.closed ? 1 : 0;
    int pass = 0;
    for (const Link& link : chain.links) {
      const LinkSamples& samples = tile_.of_curve[link.curve];
      for (size_t i = 0; i < samples.centre.size(); ++i, ++at) {
        put(yarn, at, samples, i, link.instance, pass, twist);
        if (spec_.places) yarn.place[at] = place(link.curve, i, link.instance, pass * cycle.length, twist.start);
      }
      if (samples.order + 1 == cycle.links) ++pass;
    }
    if (!chain.closed) {
      put(yarn, at, tile_.of_curve[end_curve], 0, end_instance, pass, twist);
      if (spec_.places) yarn.place[at] = place(end_curve, 0, end_instance, pass * cycle.length, twist.start);
    } else {
      add_ghosts(yarn, dvec3(chain.shift.x, chain.shift.y, 0) * period_);
      if (spec_.places) add_ghost_places(yarn, double(chain.links.size()) / cycle.links * cycle.length);
    }
    frame_plies(yarn, spec_.plies);
  }

 private:
  /// Of one yarn: arc length at which it starts, radians per metre, and its cycle.
  struct Twist {
    double start, per_metre;
    const CycleSamples& cycle;
  };

  /// Radians per metre that bring twist and frame of a closed yarn back to whole turns.
  double closing_correction(const YarnChain& chain, const CycleSamples& cycle) const {
    const double passes = double(chain.links.size()) / cycle.links;
    const double length = passes * cycle.length;
    const double angle = kTwoPi * spec_.twist * length + passes * cycle.turn;
    return (kTwoPi * std::round(angle / kTwoPi) - angle) / length;
  }

  /// Sample i of a link: the axis, and each ply at centre + helix_radius (cos a N + sin a B),
  /// a = phase + 2 pi (twist s + ply / plies), N and B turned by pass * cycle.turn.
  void put(FlatYarn& yarn, size_t at, const LinkSamples& samples, size_t i, ivec2 instance, int pass,
           const Twist& twist) const {
    const dvec3 centre = samples.centre[i] + dvec3(instance.x, instance.y, 0) * period_;
    yarn.centre[at] = centre;
    if (spec_.strains) yarn.strained[at] = &samples.strained[i * shapes_];
    const double s = pass * twist.cycle.length + samples.arc[i] - twist.start;
    const double angle = spec_.phase + twist.per_metre * s + pass * twist.cycle.turn;
    const double c = spec_.helix_radius * std::cos(angle), d = spec_.helix_radius * std::sin(angle);
    const dvec3 out = c * samples.normal[i] + d * samples.binormal[i];
    const dvec3 side = c * samples.binormal[i] - d * samples.normal[i];
    const size_t count = yarn.centre.size();
    for (int ply = 0; ply < spec_.plies; ++ply)
      yarn.position[ply * count + at] = centre + cos_[ply] * out + sin_[ply] * side;
  }

  void add_ghosts(FlatYarn& yarn, dvec3 displacement) const {
    const size_t count = yarn.centre.size();
    const auto repeat = [&](dvec3* p) {
      p[count - 2] = p[1] + displacement;
      p[count - 1] = p[2] + displacement;
      p[0] = p[count - 3] - displacement;
    };
    repeat(yarn.centre.data());
    for (int ply = 0; ply < spec_.plies; ++ply) repeat(&yarn.position[ply * count]);
  }

  YarnPlace place(int curve, size_t i, ivec2 instance, double passed, double start) const {
    const ivec2 stitch = places_.of_curve[curve][i] + instance * places_.per_tile;
    return {passed + tile_.of_curve[curve].arc[i] - start, stitch, (dvec2(stitch) + places_.phase) * places_.size};
  }

  static void add_ghost_places(FlatYarn& yarn, double length) {
    auto& place = yarn.place;
    const size_t count = place.size();
    place[count - 2] = place[1];
    place[count - 1] = place[2];
    place[0] = place[count - 3];
    place[count - 2].along += length;
    place[count - 1].along += length;
    place[0].along -= length;
  }

  TileSamples tile_;
  YarnSpec spec_;
  std::vector<int> color_of_curve_;
  StitchPlaces places_;
  dvec3 period_;
  size_t shapes_ = 0;  ///< of the pattern's strain table
  std::vector<double> cos_, sin_;
};

FlatKnit::FlatKnit(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
                   const InstanceRect& rect)
    : partners_(partners),
      layer_(std::make_unique<Layer>(pattern, partners, sample_tile(pattern, partners, spec, scale, rect.wrap), spec,
                                     scale)),
      chains_(stitch(pattern, partners, rect)) {}

FlatKnit::~FlatKnit() = default;

void FlatKnit::lay(size_t number, FlatYarn& yarn) const {
  const YarnChain& chain = chains_[number];
  const Link& last = chain.links.back();
  ivec2 end_instance = last.instance;
  int end_curve = last.curve;
  if (!chain.closed) {
    const Partner& on = partners_.of[last.curve][last.reversed ? 0 : 1];
    end_instance += on.shift;
    end_curve = on.to.curve;
  }
  layer_->lay(chain, end_instance, end_curve, yarn);
}

void knit_flat(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
               const InstanceRect& rect, const std::function<void(FlatYarn&&)>& deliver) {
  const FlatKnit knit(pattern, partners, spec, scale, rect);
  for (size_t i = 0; i < knit.yarns(); ++i) {
    FlatYarn yarn;
    knit.lay(i, yarn);
    deliver(std::move(yarn));
  }
}

}  // namespace wale
