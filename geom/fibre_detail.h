#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geom/fibre_section.h"

namespace wale {

/// Which fibres show on the surface of a ply, and how they are turned and shaded there: the 1-D maps of KNIT21 (section
/// 3.2, after Montazeri et al. 2020), not as texels but from the fibres' circles themselves, so that they have no
/// resolution. All in the cross-section, lengths in ply radii. The kernels evaluate the same from the same tables
/// (kernels/appearance/fibre_detail.clh); this is the reference in double.
class FibreDetail {
 public:
  static constexpr int kBins = 64;  ///< of azimuth, each with the fibres that matter there

  explicit FibreDetail(const FibreRecipe& recipe);

  struct At {
    bool fibre = false;   ///< false: a gap, one looks through to the axis
    double radius = 0;    ///< where the line towards the axis meets the fibre
    double sin_turn = 0;  ///< sine of the angle from the ply's normal to the fibre's, positive towards t x n
    double distance = 0;  ///< of the fibre from the axis
    double openness = 0;  ///< share of the half plane of directions that neighbours leave open, [0,1]
  };
  /// At azimuth phi of the ply's frame and twist angle theta = kappa s.
  At at(double phi, double theta) const;

  /// Means over the surface and over the migration.
  double mean_openness() const { return mean_openness_; }
  double mean_distance() const { return mean_distance_; }
  /// Variance of the fibres' angle to the axis over the surface, rad^2.
  double tilt_variance() const { return tilt_variance_; }
  double fibre_radius() const { return section_.fibre_radius; }

  /// Fibres per bin of azimuth [-pi, pi): those of bin b are candidates()[offsets()[b] .. offsets()[b + 1]).
  const std::array<uint32_t, kBins + 1>& offsets() const { return offsets_; }
  const std::vector<uint32_t>& candidates() const { return candidates_; }
  const FibreSection& section() const { return section_; }

 private:
  void fill_bins();
  void average();

  FibreRecipe recipe_;
  FibreSection section_;
  std::array<uint32_t, kBins + 1> offsets_{};
  std::vector<uint32_t> candidates_;
  double mean_openness_ = 1, mean_distance_ = 1, tilt_variance_ = 0;
};

}  // namespace wale
