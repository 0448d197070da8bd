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

// Mean over the picture of values times `weights`, one for each of a pixel's channels.
std::array<double, 3> mean_of(const Image& image, const std::string& prefix, const std::vector<double>& weights) {
  const auto first = std::find(image.channels.begin(), image.channels.end(), prefix + "R");
  std::array<double, 3> out{};
  const size_t stride = image.channels.size(), pixels = image.pixels.size() / stride;
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c)
      out[c] +=
          weights[3 * i + c] * image.pixels[i * stride + size_t(first - image.channels.begin()) + c] / double(pixels);
  return out;
}

// Where a derivative is above 0 and where below: a wider highlight takes from here what it gives there, and a mean
// would not see it. From images whose noise the means have no part in.
std::vector<double> signs_of(std::span<const Image> images, const std::string& prefix) {
  std::vector<double> sum;
  for (const Image& image : images) {
    const auto first =
        size_t(std::find(image.channels.begin(), image.channels.end(), prefix + "R") - image.channels.begin());
    const size_t stride = image.channels.size();
    sum.resize(3 * image.pixels.size() / stride);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += image.pixels[i / 3 * stride + first + i % 3];
  }
  for (double& v : sum) v = v > 0 ? 1 : v < 0 ? -1 : 0;
  return sum;
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
  bool dark;  ///< body colours near black: light that has scattered often hides the highlight's width
  std::function<void(PlyAppearance&, double)> apply;
};

// Gathered derivatives against differences of renders with the same seeds, means of both.
void expect_like_differences(const Scene& scene, const Step& step) {
  const std::vector<Image> gathered = pictures(scene, true);
  const size_t half = gathered.size() / 2;
  const std::vector<double> signs = signs_of(std::span(gathered).first(half), step.channel);
  std::vector<std::array<double, 3>> along, differences;
  for (const Image& image : std::span(gathered).subspan(half)) along.push_back(mean_of(image, step.channel, signs));
  Scene lower = scene, upper = scene;
  step.apply(lower.materials.front().yarn, -step.size);
  step.apply(upper.materials.front().yarn, step.size);
  const std::vector<Image> below = pictures(lower, false, 4 * kSamples), above = pictures(upper, false, 4 * kSamples);
  for (size_t i = 0; i < below.size(); ++i) {
    const auto low = mean_of(below[i], "", signs), high = mean_of(above[i], "", signs);
    auto& d = differences.emplace_back();
    for (size_t c = 0; c < 3; ++c) d[c] = (high[c] - low[c]) / (2 * step.size);
  }
  const Means by = means_of(along), difference = means_of(differences);
  for (size_t c = 0; c < 3; ++c) {
    const double noise = std::sqrt(by.variance[c] + difference.variance[c]), slope = difference.mean[c];
    EXPECT_GT(std::abs(slope), 6 * noise) << step.channel << c << " is not seen";
    // What a difference over this step cannot resolve of the slope: a hundredth of it.
    EXPECT_NEAR(by.mean[c], slope, 4 * noise + 0.01 * std::abs(slope)) << step.channel << c << " noise " << noise;
    testing::Test::RecordProperty(
        step.channel + std::to_string(c),
        std::to_string(by.mean[c]) + " " + std::to_string(slope) + " +- " + std::to_string(noise));
  }
}

TEST(Gradients, AreThoseOfTheExpectedPicture) {
  const Scene scene = lit_cloth();
  // One light, from beside a narrow highlight.
  Scene dark = scene;
  dark.lights.resize(1);
  PlyAppearance& black = dark.materials.front().yarn;
  black.forward = black.back = Rgb{0.02, 0.02, 0.02};
  black.roughness = 0.14;
  const WPlyMaterial base = build_world(scene, {}).ply_materials.front();
  const Step steps[] = {
      {"by.transmit.", 0.05, false,
       [](PlyAppearance& y, double d) {
         for (double& v : *y.forward) v += d;
       }},
      {"by.reflect.", 0.05, false,
       [](PlyAppearance& y, double d) {
         for (double& v : *y.back) v += d;
       }},
      {"by.roughness.", 0.01, true, [](PlyAppearance& y, double d) { *y.roughness += d; }},
      {"by.tilt.", 0.1, false, [&](PlyAppearance& y, double d) { y.fibre_twist = std::atan(base.tilt + d); }},
  };
  for (const Step& step : steps) expect_like_differences(step.dark ? dark : scene, step);
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
