#include "tests/fuzz/scenes.h"

#include <algorithm>

#include "host/materials.h"
#include "host/viewpoint.h"
#include "tests/fuzz/expect.h"

namespace wale::fuzz {
namespace {

void expect_finite(const w_float4& v, const char* what) {
  expect(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w), what);
}

void expect_consistent(const Transform& t) {
  expect(std::isfinite(t.scale) && t.scale > 0 && finite(t.rotate) && finite(t.translate), "a transform is not finite");
}

void expect_consistent(const CameraScene& camera, const FilmScene& film) {
  expect(film.width > 0 && film.height > 0 && std::isfinite(film.exposure), "the film has no pixels");
  const WCamera device = device_camera(camera, film, dvec3(0));
  for (const w_float4& axis : {device.origin, device.right, device.up, device.forward})
    expect_finite(axis, "the camera is not finite");
  expect(std::isfinite(device.half_width) && device.half_height > 0, "the camera sees nothing");
}

void expect_consistent(const LightScene& light) {
  for (const double channel : light.radiance)
    expect(std::isfinite(float(channel)) && channel >= 0, "a light's radiance");
  expect(finite(light.position) && finite(light.look_at), "a light's place is not finite");
  expect(light.width > 0 && light.height > 0 && light.radius > 0, "a light has no area");
  expect_consistent(light.transform);
}

}  // namespace

std::filesystem::path scene_folder() { return std::filesystem::path(WALE_SOURCE_DIR) / "tests/fuzz/files"; }

void expect_consistent(const MaterialSpec& material) {
  if (!material.ply) {
    expect_finite(surface_material(material.surface).color, "a surface's colour is not finite");
    return;
  }
  const WPlyMaterial ply = ply_material(material.yarn);
  for (const w_float4& color : {ply.fibre, ply.forward, ply.back}) expect_finite(color, "a body colour is not finite");
  for (const float value : {ply.tau_e, ply.f0, ply.beta_r, ply.e_r, ply.e_r_h4, ply.b, ply.s_f0, ply.e_f, ply.d_f,
                            ply.s_b, ply.d_b, ply.v_c, ply.v_e, ply.n0, ply.n1, ply.tilt, ply.hits_back})
    expect(std::isfinite(value), "a parameter of a ply is not finite");
  expect_finite(fibre_material(material.yarn).transmit, "a fibre's colour is not finite");
  expect(fibre_recipe(material.yarn).fibres > 0, "a ply without fibres");
}

void expect_consistent(const Scene& scene) {
  expect_consistent(scene.camera, scene.film);
  expect(scene.integrator.spp > 0, "no samples");
  const auto material = [&](int index, bool ply) {
    expect(index >= 0 && size_t(index) < scene.materials.size() && scene.materials[size_t(index)].ply == ply,
           "a material of the wrong sort");
  };
  for (const FabricScene& fabric : scene.fabrics) {
    material(fabric.material, true);
    expect_consistent(fabric.transform);
    expect(fabric.spec.plies >= 1 && fabric.spec.plies <= 8, "a yarn's plies");
  }
  for (const ObjectScene& object : scene.objects) {
    material(object.material, false);
    expect_consistent(object.transform);
  }
  expect(!scene.lights.empty(), "no light");
  for (const LightScene& light : scene.lights) expect_consistent(light);
  // Their making takes milliseconds; the first ones stand for all.
  for (size_t i = 0; i < std::min<size_t>(scene.materials.size(), 2); ++i) expect_consistent(scene.materials[i]);
}

}  // namespace wale::fuzz
