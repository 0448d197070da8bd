#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "shared/wale_types.h"

namespace wale {

/// How often a light, or a texel of the sky, is sampled: by its power, or all alike (those that are not black).
enum class LightChoice { power, uniform };

/// Sampling tables of an environment image; layout as in kernels/environment.clh.
struct EnvironmentTables {
  std::vector<w_float4> texels;  ///< width * height: rgb radiance, w = sampling weight
  std::vector<float> cdf;        ///< height row sums, then width per row
  float average = 0;             ///< mean of the weight over the sphere; 0 when the image is black
};

/// Builds them from width * height * 3 linear values, row 0 at the top. The weight of a texel is the mean
/// of the channels over its 3x3 neighbourhood under a tent, so that the density is positive wherever the bilinear
/// lookup is, and radiance over density stays bounded. Throws a bug on a size that does not fit and a user error on
/// negative or non-finite texels.
EnvironmentTables environment_tables(const std::vector<float>& rgb, int width, int height,
                                     LightChoice choice = LightChoice::power);

using LightTriangle = std::array<float, 9>;  ///< three corners, metres

/// Tables of all sampled lights; buffers of WLights (kernels/lights.clh).
struct LightTables {
  std::vector<WLight> lights;
  std::vector<float> cdf;               ///< per mesh light: running share of area
  std::vector<float> triangles;         ///< 9 per triangle
  std::vector<int32_t> triangle_index;  ///< triangle of the scene
  std::vector<double> power;            ///< per light; those of power 0 are never chosen
  LightChoice choice = LightChoice::power;

  /// Sets the probabilities of choosing lights.
  void choose();
  /// Some light may be chosen.
  bool any() const;
};

/// Adds lights one after the other; finish() sets the probabilities of choosing them, none of them 0 unless the light
/// is black. Each add returns the index of the light.
class LightTableBuilder {
 public:
  int add_sphere(const std::array<float, 3>& radiance, const std::array<float, 3>& center, float radius);
  /// scene_triangles: the numbers of these triangles in the scene, as many as `triangles`. Triangles of zero area are
  /// never chosen; a user error when all of them have none.
  int add_mesh(const std::array<float, 3>& radiance, const std::vector<LightTriangle>& triangles,
               const std::vector<int32_t>& scene_triangles, bool one_sided);
  /// power_radius: radius (metres) of a ball around the scene, which the environment lights with pi r^2 of its disc.
  int add_environment(const std::array<float, 3>& mean_radiance, float power_radius);
  LightTables finish(LightChoice choice = LightChoice::power);

 private:
  int add(WLight light, double power);
  LightTables tables_;
};

}  // namespace wale
