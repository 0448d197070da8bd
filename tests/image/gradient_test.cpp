// Derivatives gathered along paths: their expectation is the derivative of the picture's.
#include <gtest/gtest.h>

#include <functional>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

constexpr int kSide = 12, kSamples = 128, kSeeds = 8;

Scene lit_cloth() {
  Scene scene = empty_scene(0.01, kSide);
  add_fabric(scene, straight_yarn(0.001, 0.0005), 0.012, 0.012, 3, "wool", std::nullopt);
  PlyAppearance& yarn = scene.materials.back().yarn;
  yarn.forward = Rgb{0.8, 0.6, 0.3};
  yarn.back = Rgb{0.4, 0.7, 0.5};
  // Sampled lights in front and behind, a surface that light comes back from, and the environment.
  LightScene light;
  light.radius = 0.01;
  light.position = {0.03, 0.02, 0.05};
  light.radiance = {4, 4, 4};
  light.kind = LightScene::Kind::sphere;
  scene.lights.push_back(light);
  light.position = {-0.02, 0.01, -0.05};
  scene.lights.push_back(light);
  scene.lights.push_back(constant_environment(0.3));
  ObjectScene ground;
  ground.kind = ObjectScene::Kind::ground;
  ground.up = {0, 0, 1};
  ground.height = -0.1;
  ground.extent = 0.5;
  MaterialSpec grey;
  grey.name = "grey";
  scene.materials.push_back(grey);
  ground.material = int(scene.materials.size()) - 1;
  scene.objects.push_back(ground);
  return scene;
}

// Means over the picture and their variances, of several seeds.
struct Means {
  std::array<double, 3> mean{}, variance{};
};

Means means_of(const std::vector<std::array<double, 3>>& seeds) {
  Means out;
  const double n = double(seeds.size());
  for (size_t c = 0; c < 3; ++c) {
    for (const auto& s : seeds) out.mean[c] += s[c] / n;
    for (const auto& s : seeds) out.variance[c] += (s[c] - out.mean[c]) * (s[c] - out.mean[c]) / (n * (n - 1));
  }
  return out;
}

std::array<double, 3> mean_of(const Image& image, const std::string& prefix) {
  const auto first = std::find(image.channels.begin(), image.channels.end(), prefix + "R");
  std::array<double, 3> out{};
  const size_t stride = image.channels.size(), pixels = image.pixels.size() / stride;
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c)
      out[c] += image.pixels[i * stride + size_t(first - image.channels.begin()) + c] / double(pixels);
  return out;
}

std::vector<Image> pictures(const Scene& scene, bool gradients, int samples = kSamples) {
  const Studio studio(device(), scene);
  std::vector<Image> out;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    RenderOptions options;
    options.spp = samples;
    options.gradients = gradients;
    const Rendered r = studio.take(options, seed + (gradients ? 100 : 0));
    EXPECT_EQ(bad_events(r.counts), 0u);
    out.push_back(r.image);
  }
  return out;
}

struct Step {
  const char* channel;
  double size;
  std::function<void(PlyAppearance&, double)> apply;
};

TEST(Gradients, AreThoseOfTheExpectedPicture) {
  const Scene scene = lit_cloth();
  const std::vector<Image> gathered = pictures(scene, true);
  const WPlyMaterial base = build_world(scene, {}).ply_materials.front();
  const Step steps[] = {
      {"by.transmit.", 0.05,
       [](PlyAppearance& y, double d) {
         for (double& v : *y.forward) v += d;
       }},
      {"by.reflect.", 0.05,
       [](PlyAppearance& y, double d) {
         for (double& v : *y.back) v += d;
       }},
      {"by.roughness.", 0.03, [&](PlyAppearance& y, double d) { y.roughness = base.beta_r + d; }},
      {"by.tilt.", 0.1, [&](PlyAppearance& y, double d) { y.fibre_twist = std::atan(base.tilt + d); }},
  };
  for (const Step& step : steps) {
    std::vector<std::array<double, 3>> along, lower, upper;
    for (const Image& image : gathered) along.push_back(mean_of(image, step.channel));
    for (const double sign : {-1.0, 1.0}) {
      Scene moved = scene;
      step.apply(moved.materials.front().yarn, sign * step.size);
      for (const Image& image : pictures(moved, false, 4 * kSamples))
        (sign < 0 ? lower : upper).push_back(mean_of(image, ""));
    }
    const Means by = means_of(along), low = means_of(lower), high = means_of(upper);
    for (size_t c = 0; c < 3; ++c) {
      const double difference = (high.mean[c] - low.mean[c]) / (2 * step.size);
      const double noise =
          std::sqrt((low.variance[c] + high.variance[c]) / (4 * step.size * step.size) + by.variance[c]);
      // What a difference over this step cannot resolve of the slope: a hundredth of it.
      EXPECT_NEAR(by.mean[c], difference, 4 * noise + 0.01 * std::abs(difference))
          << step.channel << c << " noise " << noise;
      RecordProperty(step.channel + std::to_string(c),
                     std::to_string(by.mean[c]) + " " + std::to_string(difference) + " +- " + std::to_string(noise));
    }
  }
}

// Gathering derivatives changes nothing of the picture.
TEST(Gradients, LeaveThePictureAsItIs) {
  const Scene scene = lit_cloth();
  const Studio studio(device(), scene);
  RenderOptions options;
  options.spp = 16;
  const Image plain = studio.take(options).image;
  options.gradients = true;
  const Image with = studio.take(options).image;
  for (size_t i = 0; i < size_t(kSide * kSide); ++i)
    for (size_t c = 0; c < 3; ++c)
      EXPECT_EQ(plain.pixels[i * plain.channels.size() + c], with.pixels[i * with.channels.size() + c]);
}

}  // namespace
}  // namespace wale::test
