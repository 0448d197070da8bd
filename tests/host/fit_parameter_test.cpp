// What a fit changes of a scene, and what it leaves as it was.
#include <gtest/gtest.h>

#include "host/fit/material_json.h"
#include "host/fit/parameter.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

// Two fabrics of one yarn, each with its own twist.
Scene cloth_of(double twist, double other_twist) {
  TemporaryFolder folder;
  const auto fabric = [](double pitch) {
    return fmt::format(R"({{"mesh": {{"generator": "swatch", "width": 0.1, "height": 0.1}},
      "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": 40}}, "yarn": {{"twist_pitch": {}}}}})",
                       pitch);
  };
  return read_scene(
      folder.write("s.json", fmt::format(R"({{"wale": 1, "fabrics": [{}, {}]}})", fabric(twist), fabric(other_twist))));
}

const FitTarget kBoth{.material = 0, .fabrics = {0, 1}};

TEST(FitParameter, TwistKeepsEachYarnsHand) {
  Scene scene = cloth_of(-8, 10);
  const auto parameters = fit_parameters("twist_pitch=4..16");
  EXPECT_NEAR(places_of(scene, kBoth, parameters)[0], 0.5, 1e-12);
  const double place = 0.25;
  apply_parameters(scene, kBoth, parameters, {&place, 1});
  const double pitch = 4 * std::sqrt(2);
  EXPECT_NEAR(scene.fabrics[0].spec.twist_pitch, -pitch, 1e-12);
  EXPECT_NEAR(scene.fabrics[1].spec.twist_pitch, pitch, 1e-12);
  EXPECT_NEAR(places_of(scene, kBoth, parameters)[0], place, 1e-12);
  // What is written makes the yarns that were fitted.
  EXPECT_EQ(other_settings(scene, kBoth, parameters),
            "--set fabrics.0.yarn.twist_pitch=-5.6569\n--set fabrics.1.yarn.twist_pitch=5.6569\n");
}

TEST(FitParameter, YarnWithoutTwistHasNoHandToKeep) {
  const Scene scene = cloth_of(8, 0);
  const std::string line = user_message([&] { require_hand(scene, kBoth, fit_parameters("roughness,twist_pitch")); });
  EXPECT_TRUE(line.starts_with(scene.file + ": fabrics.1.yarn.twist_pitch: 0 is yarn without twist")) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_NO_THROW(require_hand(scene, kBoth, fit_parameters("thickness")));
  EXPECT_NO_THROW(require_hand(scene, {.material = 0, .fabrics = {0}}, fit_parameters("twist_pitch")));
}

}  // namespace
}  // namespace wale::fit
