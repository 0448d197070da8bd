#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "geom/stitch.h"

namespace wale {

/// How plies lie in a yarn, in the cloth (after the tile has been scaled).
struct YarnSpec {
  int plies = 3;            ///< 1 to 8
  double twist = 0;         ///< turns per metre of yarn, positive = right-handed helix (Z twist); 0 allowed
  double ply_radius = 0;    ///< metres, the traced tube
  double helix_radius = 0;  ///< metres from the yarn axis to a ply axis (0 for one ply)
  double phase = 0;         ///< radians
  double tolerance = 0.02;  ///< largest distance of a ply polyline from its curve, in ply radii
  double winding = -1;      ///< 1/m: curvature of explicit fibres about the ply, whose tolerance it then is; < 0: none
  bool places = false;      ///< say of every sample where on its yarn and in which stitch it lies
  bool strains = false;     ///< say of every sample where the tile's strain table moves it
};

/// Where a sample lies on its yarn, and in which stitch.
struct YarnPlace {
  double along = 0;    ///< metres of yarn from the start of the full yarn (rest length of the axis)
  ivec2 stitch{0, 0};  ///< column and row, see geom/stitch_places.h
  dvec2 middle{0, 0};  ///< of the stitch, metres in the cloth
};

/// Ply and helix radius of n equal circles that fill a yarn of the given radius and touch their neighbours.
/// Circle packing on a ring: r = R s/(1+s), s = sin(pi/n); n = 1 gives r = R.
void fill_yarn(YarnSpec& spec, double yarn_radius);

/// One full yarn of the flat knit. K samples; ply arrays are ply-major, [ply*K + k].
/// A closed yarn repeats itself at both ends by one ghost sample: sample 0 is sample K-3 displaced back and sample K-1
/// is sample 2 displaced forward (sample K-2 equals sample 1 displaced), so that every traced joint has two real
/// neighbours.
struct FlatYarn {
  bool closed = false;
  int color = 0;  ///< PatternCurve::yarn
  std::vector<dvec3> centre;     ///< yarn axis, metres in the cloth: x course, y wale, z through the fabric
  std::vector<dvec3> position;   ///< ply axes
  std::vector<dvec3> normal;     ///< unit, perpendicular to the ply's mean tangent: double-reflection frame of the ply
  std::vector<dvec3> tangent;    ///< unit: mean of a ply's two edges
  std::vector<double> length;    ///< metres of ply from the start of the full yarn (rest length)
  std::vector<YarnPlace> place;  ///< per sample where YarnSpec::places asks for it; a ghost's `along` goes on
  /// Per sample where YarnSpec::strains asks for it: offset of the yarn axis, metres, in each shape of the pattern's
  /// strain table; null for ghosts. Lives as long as the FlatKnit. What the flat yarn says holds at strain 0.
  std::vector<const dvec3*> strained;
};

/// The full yarns of a rectangle of tiles. Samples of one tile are the same in every instance: chosen by arc length so
/// that the twisted ply polylines stay within spec.tolerance of their curves. `scale` takes pattern metres to cloth
/// metres in x, y and z. Deterministic; frames by double reflection (Wang et al. 2008), closing twist of closed yarns
/// spread over their length.
class FlatKnit {
 public:
  /// `pattern` and `partners` must outlive it.
  FlatKnit(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
           const InstanceRect& rect);
  ~FlatKnit();
  /// Full yarns, in the order of stitch().
  size_t yarns() const { return chains_.size(); }
  /// Lays yarn `number` in place of what `yarn` held; several threads may do so at once.
  void lay(size_t number, FlatYarn& yarn) const;

 private:
  class Layer;
  const PartnerMap& partners_;
  std::unique_ptr<const Layer> layer_;
  std::vector<YarnChain> chains_;
};

/// Delivers the yarns of a FlatKnit one at a time, in order.
void knit_flat(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale,
               const InstanceRect& rect, const std::function<void(FlatYarn&&)>& deliver);

/// Number of samples that one tile's yarns take under knit_flat; for size estimates before anything is allocated.
long samples_per_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale);

/// Metres of yarn in one tile.
double yarn_per_tile(const Pattern& pattern, const PartnerMap& partners, const YarnSpec& spec, dvec3 scale);

}  // namespace wale
