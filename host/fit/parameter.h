#pragma once
#include <span>
#include <string>
#include <vector>

#include "host/scene.h"

namespace wale::fit {

/// The material that a fit changes, and the fabrics made of it.
struct FitTarget {
  size_t material = 0;          ///< index into Scene::materials, a ply material
  std::vector<size_t> fabrics;  ///< indices into Scene::fabrics
};

constexpr int kNoGradient = -1;
constexpr int kScalesPictures = -2;  ///< a factor on both pictures, by powers of two

/// Parameters that a fit may change together, as a user names them: a colour has three.
struct ParameterGroup {
  const char* name;
  int count;         ///< 1, or 3 for a linear colour
  double low, high;  ///< bounds unless the user gives others, in `unit`
  bool logarithmic;  ///< steps are ratios
  bool usual;        ///< fitted unless the user chooses
  bool geometry;     ///< fabrics are knitted anew when it changes
  const char* unit;  ///< as in scene files
  const char* doc;
  double (*get)(const Scene&, const FitTarget&, int k);
  void (*set)(Scene&, const FitTarget&, int k, double value);
  /// Which of the derivatives that paths gather is by this parameter: W_GRADIENT_*, kNoGradient, or kScalesPictures.
  int gradient = kNoGradient;
  /// Derivative of what that one is by (radians, tangents) by a value in `unit`; absent: 1.
  double (*slope)(double value) = nullptr;
};

/// All of them, in the order of the documentation.
std::span<const ParameterGroup> parameter_groups();

/// One number that is fitted.
struct FitParameter {
  const ParameterGroup* group;
  int k;  ///< which of the group's
  double low, high;

  /// "transmit.r", "roughness".
  std::string name() const;
  /// A place in [0,1] between the bounds, and back; a value outside of the bounds has the nearest place.
  double value(double place) const;
  double place(double value) const;
  /// Derivative of the value by the place.
  double steepness(double place) const;
};

/// Reads what is to be fitted: names of groups with commas between them, each with bounds if others are wanted
/// ("transmit,reflect,roughness=5..30"); empty: the usual ones. Throws a user error that names the option and the
/// nearest valid choice.
std::vector<FitParameter> fit_parameters(const std::string& text);

/// Throws a user error where the twist of yarn without any is to be fitted: a fit keeps the yarn's hand.
void require_hand(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters);

/// Puts the values at these places into a scene whose material gives body colours; what it gave in another way
/// (color, gloss, translucency) is replaced.
void apply_parameters(Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters,
                      std::span<const double> places);

/// Where the scene itself stands.
std::vector<double> places_of(const Scene& scene, const FitTarget& target, std::span<const FitParameter> parameters);

}  // namespace wale::fit
