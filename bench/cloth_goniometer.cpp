// A goniometer for cloth: what share of light a flat swatch sends back and lets through, against the angle.
//   cloth_goniometer SCENE -o OUT.json [--spp N] [--stitches N] [--set key=value]...
// Takes the scene's first fabric as it lies: a flat swatch about the origin, face to +z; its own camera and lights are
// not used. By reciprocity the radiance that an orthographic camera at inclination theta sees under a hemisphere of
// radiance 1 on its own side is the directional-hemispherical reflectance at theta, under one on the far side the
// transmittance, openings included. Measured in the planes of courses (x) and wales (y). A white cloth gives R + T = 1.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/base_mesh.h"
#include "host/atomic_file.h"
#include "host/render.h"

namespace {

using namespace wale;

constexpr int kPixels = 40;  ///< down the picture

struct Measured {
  std::array<double, 3> rgb{}, error{};
  double coverage = 0;
};

/// Radiance 1 from the half of the sky above (z > 0) or below the cloth.
Image half_sky(bool above) {
  Image image;
  image.width = 4;
  image.height = 512;
  image.channels = {"R", "G", "B"};
  image.pixels.assign(size_t(3 * image.width) * size_t(image.height), 0.0f);
  const size_t half = image.pixels.size() / 2;
  std::fill_n(image.pixels.begin() + (above ? 0 : std::ptrdiff_t(half)), half, 1.0f);
  return image;
}

Measured measure(const Device& device, const Scene& scene, bool above, int spp) {
  const Loaders loaders{[](const auto& file) { return read_mesh(file); },
                        [&](const auto& file) { return file == "sky" ? half_sky(above) : Image{}; }};
  const World world = build_world(scene, loaders);
  const SceneDevice on_device(device, world);
  RenderOptions options;
  options.spp = spp;
  options.aovs = true;
  const Image image = render(device, world, on_device, scene.integrator, options).image;
  Measured out;
  const size_t n = image.channels.size(), pixels = image.pixels.size() / n;
  const size_t covered =
      size_t(std::find(image.channels.begin(), image.channels.end(), "coverage") - image.channels.begin());
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t k = 0; k < 3; ++k) {
      out.rgb[k] += image.pixels[n * i + k] / double(pixels);
      out.error[k] += image.pixels[n * i + 3 + k] / double(pixels * pixels);
    }
    out.coverage += image.pixels[n * i + covered] / double(pixels);
  }
  for (double& e : out.error) e = std::sqrt(e);
  return out;
}

void aim(Scene& scene, double theta, bool along_wales, dvec2 stitch, int stitches) {
  const dvec3 tilt = along_wales ? dvec3(0, 1, 0) : dvec3(1, 0, 0),
              across = along_wales ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec2 size = along_wales ? dvec2(stitch.y, stitch.x) : stitch;  // along the tilt, across it
  scene.camera_given = true;
  scene.camera.orthographic = true;
  scene.camera.look_at = dvec3(0);
  scene.camera.position = std::sin(theta) * tilt + std::cos(theta) * dvec3(0, 0, 1);
  scene.camera.up = across;
  const dvec2 view = double(stitches) * size * dvec2(std::cos(theta), 1);
  scene.camera.height = view.y;
  scene.film.height = kPixels;
  scene.film.width = std::max(1, int(std::lround(kPixels * view.x / view.y)));
  scene.film.filter = "box";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Reflectance and transmittance of a flat swatch against the angle"};
  std::string file, output;
  std::vector<std::string> set;
  int spp = 64, stitches = 8;
  app.add_option("scene", file)->required();
  app.add_option("-o", output)->required();
  app.add_option("--spp", spp);
  app.add_option("--stitches", stitches);
  app.add_option("--set", set);
  CLI11_PARSE(app, argc, argv);
  try {
    Scene scene = read_scene(file, set);
    scene.objects.clear();
    scene.lights.clear();
    scene.fabrics.resize(1);
    LightScene sky;
    sky.kind = LightScene::Kind::environment;
    sky.file = "sky";
    sky.env_up = {0, 0, 1};
    scene.lights.push_back(sky);
    const Device device = Device::open();
    const World once = build_world(
        scene, Loaders{[](const auto& f) { return read_mesh(f); }, [](const auto&) { return half_sky(true); }});
    const dvec2 stitch = once.fabrics[0].report.stitch_metres;
    nlohmann::ordered_json json{
        {"scene", file}, {"fabric", once.fabrics[0].name}, {"spp", spp}, {"angles", nlohmann::ordered_json::array()}};
    fmt::print("plane    theta  reflectance            transmittance          openness  R+T\n");
    for (const bool wales : {false, true})
      for (const int degrees : {0, 15, 30, 45, 60, 75}) {
        if (wales && degrees == 0) continue;
        aim(scene, degrees * std::numbers::pi / 180, wales, stitch, stitches);
        const Measured r = measure(device, scene, true, spp), t = measure(device, scene, false, spp);
        fmt::print("{:<8} {:>5}  {:.4f} {:.4f} {:.4f}   {:.4f} {:.4f} {:.4f}   {:.4f}    {:.4f}\n",
                   wales ? "wales" : "courses", degrees, r.rgb[0], r.rgb[1], r.rgb[2], t.rgb[0], t.rgb[1], t.rgb[2],
                   1 - r.coverage, r.rgb[0] + t.rgb[0]);
        json["angles"].push_back({{"plane", wales ? "wales" : "courses"},
                                  {"theta", degrees},
                                  {"reflectance", r.rgb},
                                  {"reflectance_error", r.error},
                                  {"transmittance", t.rgb},
                                  {"transmittance_error", t.error},
                                  {"openness", 1 - r.coverage}});
      }
    write_text_file(output, json.dump(1) + "\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
