#include "tests/image/picture.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "geom/base_mesh.h"
#include "host/image.h"
#include "host/rare_events.h"

namespace wale::test {

const Device& device() {
  static const Device d = Device::open();
  return d;
}

Studio::Studio(const Device& device, const Scene& scene)
    : device_(device),
      integrator_(scene.integrator),
      world_(build_world(scene, Loaders{[](const auto& file) { return read_mesh(file); },
                                        [](const auto& file) { return read_image(file, true); }})),
      on_device_(device, world_) {}

Rendered Studio::take(const RenderOptions& options, unsigned seed) const {
  IntegratorScene integrator = integrator_;
  integrator.seed = seed;
  return render(device_, world_, on_device_, integrator, options);
}

Picture take_on(const Device& dev, const Scene& scene, int spp, unsigned seed, uint32_t pool, bool aovs) {
  RenderOptions options;
  options.spp = spp;
  options.pool = pool;
  options.aovs = aovs;
  Rendered r = Studio(dev, scene).take(options, seed);
  return {std::move(r.image), std::move(r.counts)};
}

Picture take(const Scene& scene, int spp, unsigned seed, uint32_t pool, bool aovs) {
  return take_on(device(), scene, spp, seed, pool, aovs);
}

uint64_t bad_events(const WaveCounts& counts) {
  uint64_t sum = 0;
  for (const RareEvent& e : kRareEvents)
    if (e.weight != RareEvent::Weight::note) sum += counts.events[e.counter];
  return sum;
}

Scene empty_scene(double size, int pixels) {
  Scene scene;
  scene.camera_given = true;
  scene.camera.orthographic = true;
  scene.camera.position = dvec3(0, 0, 10 * size);
  scene.camera.height = size;
  scene.film.width = scene.film.height = pixels;
  scene.film.filter = "box";
  return scene;
}

Pattern straight_yarn(double pitch, double radius) {
  Pattern p;
  p.name = "straight";
  p.period = dvec2(pitch, pitch);
  p.yarn_radius = radius;
  p.stitches = ivec2(1, 1);
  PatternCurve curve;
  for (int i = 0; i <= 4; ++i) curve.points.push_back(dvec3(pitch * i / 4.0, pitch / 2, 0));
  p.curves.push_back(curve);
  return p;
}

void add_fabric(Scene& scene, const Pattern& pattern, double width, double height, int plies, const std::string& preset,
                std::optional<Rgb> color, double twist_pitch) {
  static int number = 0;
  const auto file = std::filesystem::temp_directory_path() / fmt::format("wale_tile_{}_{}.json", getpid(), number++);
  write_pattern_json(pattern, file);
  MaterialSpec material;
  material.name = "yarn";
  material.ply = true;
  material.yarn.preset = preset;
  material.yarn.color = color;
  FabricScene fabric;
  fabric.spec.name = "fabric";
  fabric.spec.scale.kind = FabricScale::Kind::uv_metres;
  fabric.spec.plies = plies;
  fabric.spec.twist_pitch = twist_pitch;
  fabric.mesh.generator = "swatch";
  fabric.mesh.width = width;
  fabric.mesh.height = height;
  fabric.mesh.nu = fabric.mesh.nv = 4;
  fabric.pattern.file = file;
  fabric.material = int(scene.materials.size());
  scene.materials.push_back(material);
  scene.fabrics.push_back(fabric);
}

LightScene constant_environment(double radiance) {
  LightScene light;
  light.kind = LightScene::Kind::environment;
  light.radiance = {radiance, radiance, radiance};
  return light;
}

// Continued fraction of the regularised incomplete beta function (Lentz); p = I_x(dof/2, 1/2), x = dof/(dof + t^2).
double student_p(double t, double dof) {
  const double x = dof / (dof + t * t), a = dof / 2, b = 0.5;
  const bool flip = x > (a + 1) / (a + b + 2);
  const double p = flip ? b : a, q = flip ? a : b, z = flip ? 1 - x : x;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + p * std::log(z) + q * std::log1p(-z)) / p;
  double f = 1, c = 1, d = 0;
  for (int i = 0; i <= 400; ++i) {
    const int m = i / 2;
    const double n = i == 0       ? 1
                     : i % 2 == 0 ? m * (q - m) * z / ((p + 2 * m - 1) * (p + 2 * m))
                                  : -(p + m) * (p + q + m) * z / ((p + 2 * m) * (p + 2 * m + 1));
    d = 1 / (1 + n * d);
    c = 1 + n / c;
    f *= c * d;
    if (std::abs(1 - c * d) < 1e-14) break;
  }
  const double tail = front * (f - 1);
  return flip ? 1 - tail : tail;
}

namespace {
double p_of(double difference, double variance, double dof) {
  if (variance <= 0) return std::abs(difference) < 1e-4 ? 1 : 0;
  return student_p(difference / std::sqrt(variance), dof);
}
}  // namespace

double smallest_p(const Image& image, double expected, size_t& tests) {
  double p = 1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c, ++tests) {
        const float* v = image.at(x, y);
        // Rounding of a long sum of floats is not noise.
        const double floor = 1e-12;
        p = std::min(p, p_of(v[c] - expected, v[3 + c] > floor ? v[3 + c] : 0, 7));
      }
  return p;
}

double smallest_p(const Image& a, const Image& b, size_t& tests) {
  double p = 1;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int c = 0; c < 3; ++c, ++tests) {
        const float *v = a.at(x, y), *w = b.at(x, y);
        const double s = v[3 + c], u = w[3 + c];
        if (s + u <= 1e-12) {
          p = std::min(p, p_of(v[c] - w[c], 0, 7));
          continue;
        }
        const double dof = (s + u) * (s + u) / (s * s / 7 + u * u / 7);
        p = std::min(p, p_of(v[c] - w[c], s + u, dof));
      }
  return p;
}

double smallest_p_of_means(const Image& a, const Image& b) {
  double p = 1;
  for (int c = 0; c < 3; ++c) {
    double difference = 0, variance = 0;
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        const float *v = a.at(x, y), *w = b.at(x, y);
        difference += double(v[c]) - w[c];
        variance += double(v[3 + c]) + w[3 + c];
      }
    p = std::min(p, p_of(difference, variance, 7.0 * a.width * a.height));
  }
  return p;
}

double sidak(double alpha, size_t tests) { return -std::expm1(std::log1p(-alpha) / double(tests)); }

std::array<double, 3> mean_rgb(const Image& image) {
  std::array<double, 3> sum{};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += image.at(x, y)[c];
  for (double& s : sum) s /= double(image.width) * image.height;
  return sum;
}

}  // namespace wale::test
