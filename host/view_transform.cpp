// From scene-linear to display values.
#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/image.h"
#include "host/schema.h"

namespace wale {
namespace {

// Khronos PBR Neutral tone mapper, specification of 2024: colours up to 0.8 keep their hue and (but for a Fresnel
// offset of 0.04) their value; brighter ones are compressed towards 1 and lose saturation slowly.
void neutral(double c[3]) {
  constexpr double kStart = 0.8 - 0.04, kDesaturation = 0.15;
  const double least = std::min({c[0], c[1], c[2]});
  const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
  for (int i = 0; i < 3; ++i) c[i] -= offset;
  const double peak = std::max({c[0], c[1], c[2]});
  if (peak < kStart) return;
  constexpr double kRoom = 1 - kStart;
  const double new_peak = 1 - kRoom * kRoom / (peak + kRoom - kStart);
  const double gray = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
  for (int i = 0; i < 3; ++i) c[i] = c[i] * new_peak / peak * (1 - gray) + new_peak * gray;
}

}  // namespace

void view_transform(const float linear[3], double exposure, const std::string& view, float display[3]) {
  constexpr double kMax = 1e30;  // keeps squares finite
  double c[3];
  for (int i = 0; i < 3; ++i) {
    const double exposed = linear[i] * std::exp2(exposure);
    c[i] = exposed > 0 ? std::min(exposed, kMax) : 0;  // NaN becomes 0
  }
  if (view == "neutral")
    neutral(c);
  else if (view != "srgb")
    user_error("view \"{}\": not known; valid: \"neutral\", \"srgb\"", view);
  for (int i = 0; i < 3; ++i) display[i] = static_cast<float>(linear_to_srgb(std::clamp(c[i], 0.0, 1.0)));
}

}  // namespace wale
