#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/hard/fixtures_lights.h"
#include "tests/hard/fixtures_materials.h"
#include "tests/hard/look_picture.h"
#include "tests/hard/trap.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

Trap constant(const std::string& name, const std::string& breaks, const std::string& promise,
              const std::function<std::vector<ConstantPicture>()>& pictures, int spp = 256) {
  return {name, breaks, promise, "of the radiance", tolerance::kFurnacePicture, 0, [pictures, spp] {
            std::vector<Finding> found;
            for (const ConstantPicture& p : pictures()) found.push_back(look_at_constant(p.scene, p.radiance, spp));
            return worst_of(found);
          }};
}

// Two ways to find the light show the same, and neither has fireflies.
Finding look_at_hot_pixel() {
  Scene scene = cloth_under_a_hot_pixel();
  const Picture mis = take(scene, 256, 1);
  scene.integrator.light_sampling = "light";
  const Picture light = take(scene, 256, 2);
  Finding found = look_for_finite(mis);
  double error = 0, a = 0, b = 0;
  for (int y = 0; y < mis.image.height; ++y)
    for (int x = 0; x < mis.image.width; ++x) {
      a += mis.image.at(x, y)[1], b += light.image.at(x, y)[1];
      error += mis.image.at(x, y)[4] + light.image.at(x, y)[4];
    }
  found.error_float = std::abs(a - b) / std::sqrt(error);
  return found;
}

Finding look_at_radiances(const std::vector<double>& radiances) {
  const Picture one = take(furnace_of(1).scene, 64, 1);
  std::vector<Finding> all;
  for (const double radiance : radiances) {
    const Picture other = take(furnace_of(radiance).scene, 64, 1);
    Finding found = look_for_finite(other);
    for (int y = 0; y < one.image.height; ++y)
      for (int x = 0; x < one.image.width; ++x)
        for (int c = 0; c < 3; ++c)
          found.error_float =
              std::max(found.error_float, std::abs(other.image.at(x, y)[c] / radiance - one.image.at(x, y)[c]));
    all.push_back(found);
  }
  return worst_of(all);
}

// Materials whose picture has no closed form: nothing is lost, gained or not a number.
Finding look_at_limits(const std::vector<Scene>& scenes, bool white) {
  std::vector<Finding> all;
  for (const Scene& scene : scenes) {
    const Picture picture = take(scene, 64, 1);
    Finding found = look_for_finite(picture);
    for (const double mean : mean_rgb(picture.image))
      found.error_float = std::max(found.error_float, white ? std::abs(mean - 1) : std::max(mean - 1, -mean));
    all.push_back(found);
  }
  return worst_of(all);
}

}  // namespace

std::vector<Trap> light_traps() {
  const std::string analytic = "the picture is that of the closed form, every pixel within its noise";
  const std::string white = "white cloth stays white, every pixel within its noise";
  return {
      constant("light smaller than a float", "radius 1 nm at 10 km: the cone's cosine is 1", analytic,
               [] { return std::vector{ground_under_a_speck()}; }),
      constant("light far away", "radius 500 km at 1000 km: squares of distances overflow or swallow the scene",
               analytic, [] { return std::vector{ground_under_a_far_giant()}; }),
      constant("cosine of 0", "a light in the plane of the ground is seen by 0/0", analytic,
               [] { return std::vector{ground_beside_a_quad_in_its_plane()}; }),
      constant("camera along the cloth", "rays in the plane of the base mesh divide by 0", white,
               [] { return std::vector{camera_along_the_cloth()}; }),
      constant("camera inside a light", "cones to a sphere light from inside have no angle", white,
               [] { return std::vector{cloth_inside_a_light()}; }),
      constant("light touching the cloth", "densities grow without bound where light and cloth meet", white,
               [] {
                 return std::vector{cloth_through_a_light(), cloth_touched_by_a_light()};
               }),
      constant("camera inside a yarn", "a ray that starts inside a ply meets its back", white,
               [] { return std::vector{camera_inside_a_ply()}; }),
      constant("cloths in one place", "each hits the other where a path starts on it", white,
               [] {
                 return std::vector{two_cloths_in_one_place(), two_grounds_in_one_place()};
               }),
      {"radiance at its limits", "squares of 1e30 or 1e-30 leave the floats",
       "at radiance 1e-30, 1e15 and 1e30 the picture of the same seed is that of radiance 1 times as much, and its "
       "variance is finite",
       "of the radiance", tolerance::kProportional, 0,
       [] {
         return look_at_radiances({1e-30, 1e15, 1e30});
       }},
      constant(
          "angle of view at its limits", "directions of neighbouring pixels round to one; tangents overflow", white,
          [] {
            return std::vector{furnace_through(0.01 * M_PI / 180), furnace_through(179 * M_PI / 180)};
          },
          64),
      constant(
          "film of one pixel", "divisions by a size less 1", white, [] { return std::vector{furnace_on_one_pixel()}; },
          8192),
      constant("pixel of 1e6 in the sky on the ground", "samples miss it, and those that find it are fireflies",
               analytic, [] { return std::vector{ground_under_a_hot_pixel()}; }),
      {"pixel of 1e6 in the sky on cloth", "paths that find the pixel by chance are fireflies",
       "with and without MIS the picture's mean is the same", "standard errors", tolerance::kStandardErrors, 0,
       [] { return look_at_hot_pixel(); }},
      {"white materials at their limits", "roughness, index and density of 0 or far beyond use divide by 0",
       "white plies of any roughness, index, density and fibre angle are white", "of the radiance",
       tolerance::kFurnaceSmall, 0, [] { return look_at_limits(white_plies_at_their_limits(), true); }},
      {"colours and coats at their limits", "colours of 0 and 1e-6, coats without width divide by 0",
       "nothing gains energy, is negative or not finite", "of the radiance", tolerance::kSurfaceFurnace, 0,
       [] { return look_at_limits(dark_and_coated_at_their_limits(), false); }},
  };
}

}  // namespace wale::test
