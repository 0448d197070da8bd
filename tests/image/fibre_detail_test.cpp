// Fibre detail is seen and costs no light: it changes pixels up close, not the mean of the cloth, and fades with the
// distance without a change of brightness.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

LightScene lamp(double z) {
  LightScene light;
  light.radiance = {12, 12, 12};
  light.position = {-0.12, 0.12, z};
  light.width = light.height = 0.12;
  return light;
}

Scene swatch(const std::string& preset, double view, int pixels, double light_z, Detail detail) {
  Scene scene = empty_scene(view, pixels);
  add_fabric(scene, stockinette_pattern(), 0.03, 0.03, 3, preset, Rgb{0.97, 0.95, 0.9});
  scene.fabrics.back().spec.detail = detail;
  scene.lights.push_back(lamp(light_z));
  scene.lights.push_back(constant_environment(0.2));
  return scene;
}

// So near that a pixel is smaller than a fibre: from afar the filter would hide any error.
// V8: the mean of a swatch with detail on and off, front- and back-lit, differs by less than 1 %.
TEST(FibreDetail, MeanOfASwatchStays) {
  for (const double z : {0.18, -0.18})
    for (const char* preset : {"wool", "silk"}) {
      const auto off = mean_rgb(take(swatch(preset, 0.002, 160, z, Detail::none), 8, 1).image);
      const auto on = mean_rgb(take(swatch(preset, 0.002, 160, z, Detail::maps), 8, 1).image);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(on[k] / off[k], 1, 0.01) << preset << " light at " << z;
    }
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  size_t count = 0;
  const size_t n = a.channels.size();
  for (size_t i = 0; i < a.pixels.size() / n; ++i)
    for (size_t k = 0; k < 3; ++k, ++count)
      sum += std::pow(double(a.pixels[n * i + k]) - double(b.pixels[n * i + k]), 2);
  return std::sqrt(sum / double(count));
}

// Up close the picture differs by more than noise where fibres lie side by side; from afar it does not.
TEST(FibreDetail, ShowsUpCloseOnly) {
  const auto contrast = [](double view, int spp) {
    const auto dyed = [&](Detail detail, unsigned seed) {
      Scene scene = swatch("wool", view, 48, 0.18, detail);
      scene.materials.back().yarn.color = Rgb{0.2, 0.2, 0.2};  // short paths, little noise
      return take(scene, spp, seed);
    };
    const Picture off = dyed(Detail::none, 1), again = dyed(Detail::none, 2), on = dyed(Detail::maps, 2);
    return rmse(on.image, off.image) / rmse(again.image, off.image);
  };
  // Measured 1.22 and 1.00: the noise of one picture is the unit.
  EXPECT_GT(contrast(0.0006, 512), 1.1);
  EXPECT_LT(contrast(0.02, 64), 1.03);
}

}  // namespace
}  // namespace wale::test
