// The claim of the whole model: a 3-ply stockinette of plies looks and measures like the same one of explicit fibres,
// lit from the front, from behind and from everywhere. Same program, same cross-sections, same yarn.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

bool long_tests() {
  const char* wanted = std::getenv("WALE_LONG_TESTS");
  return wanted && std::string(wanted) == "1";
}

const std::vector<std::string> kLights = {"front", "back", "environment"};
constexpr int kStitches = 2, kCourses = 3;

/// Two stitches by three courses, whole periods, in the middle of a swatch of 4 x 7.
Scene swatch(const std::string& preset, const std::string& light, Detail detail, int pixels_down) {
  const Pattern pattern = stockinette_pattern(0.0025);
  Scene scene = empty_scene(kCourses * pattern.period.y, pixels_down);
  scene.film.width = int(std::lround(pixels_down * kStitches * pattern.period.x / (kCourses * pattern.period.y)));
  add_fabric(scene, pattern, 0.01, 0.01, 3, preset, std::nullopt);
  // White loses nothing, bright fibres a little on dozens of plies, and a dyed channel is dark.
  scene.materials.back().yarn.fibre_color = Rgb{1, 0.97, 0.8};
  scene.fabrics.back().spec.detail = detail;
  if (light == "environment") {
    scene.lights.push_back(constant_environment(1));
    return scene;
  }
  LightScene lamp;
  lamp.radiance = {16, 16, 16};
  lamp.position = {-0.12, 0.12, light == "front" ? 0.18 : -0.18};
  lamp.width = lamp.height = 0.12;
  scene.lights.push_back(lamp);
  return scene;
}

struct Taken {
  Image image;
  double seconds = 0, bytes = 0, variance = 0;  ///< of the picture's mean, relative, second channel
};

Taken take_swatch(const Scene& scene, int spp, unsigned seed) {
  const World world = build_world(scene, Loaders{});
  const SceneDevice on_device(device(), world);
  IntegratorScene integrator = scene.integrator;
  integrator.seed = seed;
  RenderOptions options;
  options.spp = spp;
  Rendered r = render(device(), world, on_device, integrator, options);
  Taken out;
  out.image = std::move(r.image);
  for (const auto& [name, stage] : r.counts.stages) out.seconds += stage.seconds;
  out.bytes = double(on_device.fabric().bytes);
  const size_t n = out.image.channels.size(), pixels = out.image.pixels.size() / n;
  const double mean = mean_rgb(out.image)[1];
  for (size_t i = 0; i < pixels; ++i)
    out.variance += out.image.pixels[n * i + 4] / (double(pixels) * double(pixels) * mean * mean);
  return out;
}

/// Gaussian low pass of one channel, the picture going round.
std::vector<double> low_pass(const Image& image, size_t channel, double sigma) {
  const int w = image.width, h = image.height, reach = int(std::ceil(4 * sigma));
  std::vector<double> in(size_t(w * h)), out(in.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) in[size_t(y * w + x)] = image.at(x, y)[channel];
  double sum = 0;
  for (int d = -reach; d <= reach; ++d) sum += std::exp(-0.5 * d * d / (sigma * sigma));
  for (const bool across : {true, false}) {
    std::fill(out.begin(), out.end(), 0.0);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int d = -reach; d <= reach; ++d) {
          const int sx = across ? ((x + d) % w + w) % w : x, sy = across ? y : ((y + d) % h + h) % h;
          out[size_t(y * w + x)] += in[size_t(sy * w + sx)] * std::exp(-0.5 * d * d / (sigma * sigma)) / sum;
        }
    in = out;
  }
  return out;
}

double relative_rmse(const Image& a, const Image& b, size_t channel, double sigma) {
  const auto la = low_pass(a, channel, sigma), lb = low_pass(b, channel, sigma);
  double square = 0, sum = 0;
  for (size_t i = 0; i < la.size(); ++i) square += std::pow(la[i] - lb[i], 2), sum += la[i];
  return std::sqrt(square * double(la.size())) / sum;
}

class PliesAndFibres : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Presets, PliesAndFibres,
                         testing::Values("wool", "cotton", "silk", "polyester", "acrylic", "mohair"),
                         [](const auto& i) { return i.param; });

TEST_P(PliesAndFibres, LookAndMeasureAlike) {
  if (!long_tests() && GetParam() != "wool" && GetParam() != "cotton") GTEST_SKIP() << "long test: ./wale test --long";
  const int down = long_tests() ? 48 : 24;
  for (const std::string& light : kLights) {
    const int spp = long_tests() ? 128 : 96;
    const Taken fibres = take_swatch(swatch(GetParam(), light, Detail::fibres, down), spp, 1);
    const Taken plies = take_swatch(swatch(GetParam(), light, Detail::maps, down), 2 * spp, 2);
    const auto f = mean_rgb(fibres.image), p = mean_rgb(plies.image);
    const double ply_radius_pixels = 0.1426e-3 / (kCourses * stockinette_pattern(0.0025).period.y) * down;
    std::array<double, 3> rmse{};
    for (size_t k = 0; k < 3; ++k) rmse[k] = relative_rmse(fibres.image, plies.image, k, ply_radius_pixels);
    const double bytes = fibres.bytes / plies.bytes;
    const double time = fibres.seconds * fibres.variance / (plies.seconds * plies.variance);
    std::printf("| %s | %s | %.4f %.4f %.4f | %.4f %.4f %.4f | %+.1f %+.1f %+.1f %% | %.3f %.3f %.3f | %.0f | %.1f |\n",
                GetParam().c_str(), light.c_str(), f[0], f[1], f[2], p[0], p[1], p[2], 100 * (p[0] / f[0] - 1),
                100 * (p[1] / f[1] - 1), 100 * (p[2] / f[2] - 1), rmse[0], rmse[1], rmse[2], bytes, time);
    std::fflush(stdout);
    // Three standard errors on top: the noise of both pictures.
    const double noise = 3 * std::sqrt(fibres.variance + plies.variance);
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_LT(std::abs(p[k] - f[k]), std::max((0.05 + noise) * f[k], 0.01)) << light << " channel " << k;
      // 15 %; on dark channels, where a few per cent of reflected light is all there is, 0.02.
      if (long_tests()) {
        EXPECT_LT(rmse[k] * f[k], std::max(0.15 * f[k], 0.02)) << light << " channel " << k;
      }
    }
    EXPECT_GT(bytes, 40);
  }
}

}  // namespace
}  // namespace wale::test
