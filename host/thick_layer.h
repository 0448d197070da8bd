#pragma once
#include <vector>

#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// What a layer of plies too thick to look through shows in diffuse light, as a function of the colour of its fibres.
/// The layer is a uniform, isotropically lit medium: van de Hulst's R_inf(A, g) for semi-infinite media (Multiple Light
/// Scattering 1980, volume 2, table 38; the fit of Christensen and Burley, Approximate Reflectance Profiles 2015):
///   R = (1-s)(1-0.139 s)/(1+1.17 s),  s = sqrt((1-A)/(1-A g)).
/// A is the ply's albedo after a collision by the law of docs/appearance.md, g the mean cosine of what it
/// scatters, both averaged over the places and angles at which an isotropic field meets a ply. How far that is from
/// knitted cloth is in docs/appearance.md.
class ThickLayer {
 public:
  /// `material` without its colour; one that gives body colours directly is a bug.
  explicit ThickLayer(const WPlyMaterial& material);

  /// Mean cosine g of what is scattered at fibre colour C in [0,1].
  double mean_cosine(double fibre) const;
  /// Albedo A at fibre colour C in [0,1]; 1 at 1.
  double albedo(double fibre) const;
  /// Colour R seen at fibre colour C in [0,1]: rises strictly, 1 at 1.
  double seen(double fibre) const;
  /// Fibre colour of a given albedo A: 1 at 1; 0 up to that of black fibres.
  double fibre_of_albedo(double albedo) const;
  /// Fibre colour at which R is seen: 1 at 1; 0 up to what black fibres show, seen(0).
  double fibre(double seen) const;
  Rgb fibre(const Rgb& seen) const;
  Rgb seen(const Rgb& fibre) const;

 private:
  struct Scattered {
    double lost = 0, cosine = 0;  ///< share of the light, and the rest's mean cosine
  };
  Scattered scattered(double fibre) const;

  struct Node {
    double weight, surface, forward, fresnel, hits, hits_back;
    double cos_r, cos_f, cos_b;  ///< mean cosine between the ways in and out, per lobe
  };
  std::vector<Node> nodes_;
};

}  // namespace wale
