#include "host/world_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/viewpoint.h"

namespace wale {
namespace {

w_float4 vec4(const dvec3& v) { return {float(v.x), float(v.y), float(v.z), 0}; }
w_float4 rgb4(const Rgb& c, float w) { return {float(c[0]), float(c[1]), float(c[2]), w}; }
std::array<float, 3> rgb3(const Rgb& c) { return {float(c[0]), float(c[1]), float(c[2])}; }

class Lights {
 public:
  Lights(World& world, SurfaceSet& surfaces, const Scene& scene, const Loaders& loaders, double radius,
         const KeptMeshes* kept_before)
      : world_(world),
        surfaces_(surfaces),
        scene_(scene),
        loaders_(loaders),
        radius_(radius),
        kept_before_(kept_before) {}

  void add() {
    LightTableBuilder tables;
    for (const auto& light : scene_.lights) {  // also black ones: what they are made of is in the way of light
      switch (light.kind) {
        case LightScene::Kind::sphere:
          add_sphere_light(light, tables);
          break;
        case LightScene::Kind::environment:
          add_environment(light, tables);
          break;
        case LightScene::Kind::quad:
          add_quad_light(light, tables);
          break;
        case LightScene::Kind::mesh:
          add_mesh_light(light, tables);
          break;
      }
    }
    world_.lights = tables.finish(light_choice());
  }

 private:
  LightChoice light_choice() const {
    return scene_.integrator.light_choice == "uniform" ? LightChoice::uniform : LightChoice::power;
  }

  void name_light(const LightScene& light, const char* kind) {
    world_.light_names.push_back(light.name.empty() ? kind : fmt::format("\"{}\" ({})", light.name, kind));
  }

  void add_sphere_light(const LightScene& light, LightTableBuilder& tables) {
    const int material = SurfaceSet::add_emitter(world_, light.radiance, false);
    const dvec3 c = light.position - world_.origin;
    const int index =
        tables.add_sphere(rgb3(light.radiance), {float(c.x), float(c.y), float(c.z)}, float(light.radius));
    world_.surface_materials[size_t(material)].light = index;
    surfaces_.add_sphere(light.position, light.radius, material, index);
    name_light(light, "sphere");
    world_.sphere_names.push_back(world_.light_names.back());
  }

  // Registers triangles [first, end) as one light.
  void register_triangles(size_t first, const Rgb& radiance, bool one_sided, int material, LightTableBuilder& tables,
                          const LightScene& light, const char* kind) {
    std::vector<LightTriangle> corners;
    std::vector<int32_t> numbers;
    for (size_t i = first; i < surfaces_.triangles().size(); ++i) {
      LightTriangle t;
      for (size_t k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a)
          t[3 * k + size_t(a)] = float(surfaces_.triangles()[i].corner[k][a] - world_.origin[a]);
      corners.push_back(t);
      numbers.push_back(int32_t(i));
    }
    world_.surface_materials[size_t(material)].light = tables.add_mesh(rgb3(radiance), corners, numbers, one_sided);
    name_light(light, kind);
    world_.triangle_names.push_back(world_.light_names.back());
  }

  void add_quad_light(const LightScene& light, LightTableBuilder& tables) {
    const ViewFrame frame(light.position, light.look_at, light.up);
    const int material = SurfaceSet::add_emitter(world_, light.radiance, !light.two_sided);
    const size_t first = surfaces_.triangles().size();
    // right x up points against forward: the order below makes the front face look_at.
    surfaces_.add_quad(light.position, frame.up * (0.5 * light.height), frame.right * (0.5 * light.width), material);
    register_triangles(first, light.radiance, !light.two_sided, material, tables, light, "quad");
  }

  void add_mesh_light(const LightScene& light, LightTableBuilder& tables) {
    BaseMesh mesh = *world_.kept_meshes.load(light.mesh, loaders_, kept_before_, world_.notes);
    transform_mesh(mesh, light.transform);
    const int material = SurfaceSet::add_emitter(world_, light.radiance, false);
    const size_t first = surfaces_.triangles().size();
    surfaces_.add_mesh(mesh, material);
    register_triangles(first, light.radiance, false, material, tables, light, "mesh");
  }

  // Photographed skies are resampled with filters that ring: a few texels dip below zero, where no light can be.
  void darken_negative(std::vector<float>& rgb, const std::filesystem::path& file) {
    size_t count = 0;
    float lowest = 0;
    for (float& v : rgb)
      if (v < 0) {
        lowest = std::min(lowest, v);
        v = 0;
        ++count;
      }
    if (count)
      world_.notes.push_back(
          fmt::format("{}: {} negative values (lowest {:.3g}) count as 0", file.string(), count, lowest));
  }

  void add_environment(const LightScene& light, LightTableBuilder& tables) {
    WEnvironment& env = world_.environment;
    Rgb mean = light.radiance;
    env.radiance = rgb4(light.radiance, 1);
    const dvec3 up = glm::normalize(light.env_up);
    // Local y is up; at rotation 0 local -z is world -z (or, for up = z, world +y), turned about up by the rotation.
    const dvec3 back = std::abs(up.z) > 0.9 ? dvec3(0, -1, 0) : dvec3(0, 0, 1);
    const dvec3 x0 = glm::normalize(glm::cross(up, back)), z0 = glm::cross(x0, up);
    const double c = std::cos(light.rotation), s = std::sin(light.rotation);
    env.to_local[0] = vec4(c * x0 - s * z0);
    env.to_local[1] = vec4(up);
    env.to_local[2] = vec4(s * x0 + c * z0);
    if (!light.file.empty()) {
      const Image image = loaders_.image(light.file);
      std::vector<float> rgb(size_t(image.width) * image.height * 3);
      const size_t n = image.channels.size();
      for (size_t i = 0; i < rgb.size() / 3; ++i)
        for (size_t k = 0; k < 3; ++k)
          rgb[3 * i + k] = image.pixels[i * n + (n >= 3 ? k : 0)] * float(light.radiance[k]);
      darken_negative(rgb, light.file);
      world_.environment_tables = environment_tables(rgb, image.width, image.height, light_choice());
      env.width = image.width;
      env.height = image.height;
      env.average = world_.environment_tables.average;
      const double a = env.average;
      mean = {a, a, a};
    }
    env.light = tables.add_environment(rgb3(mean), float(radius_));
    name_light(light, "environment");
  }

  World& world_;
  SurfaceSet& surfaces_;
  const Scene& scene_;
  const Loaders& loaders_;
  double radius_;
  const KeptMeshes* kept_before_;
};

}  // namespace

void add_lights(World& world, SurfaceSet& surfaces, const Scene& scene, const Loaders& loaders, double radius,
                const KeptMeshes* kept_before) {
  Lights(world, surfaces, scene, loaders, radius, kept_before).add();
}

}  // namespace wale
