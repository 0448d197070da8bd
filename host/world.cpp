#include "host/world.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "geom/error.h"
#include "host/analysis.h"
#include "host/features.h"
#include "host/knit_fabrics.h"
#include "host/materials.h"
#include "host/placement.h"
#include "host/ply_colors.h"
#include "host/viewpoint.h"

namespace wale {
namespace {

struct Bounds {
  dvec3 lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  void add(const dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  // What no triangle uses is not there: a forgotten vertex far away must not take the digits of the rest.
  void add(const BaseMesh& mesh) {
    for (const auto& t : mesh.triangle)
      for (const uint32_t v : t) add(mesh.position[v]);
  }
  bool empty() const { return lo.x > hi.x; }
  dvec3 centre() const { return 0.5 * (lo + hi); }
  double radius() const { return empty() ? 1.0 : std::max(1e-9, 0.5 * glm::length(hi - lo)); }
};

w_float4 vec4(const dvec3& v, double w = 0) { return {float(v.x), float(v.y), float(v.z), float(w)}; }
w_float4 rgb4(const Rgb& c, double w = 0) { return {float(c[0]), float(c[1]), float(c[2]), float(w)}; }
std::array<float, 3> rgb3(const Rgb& c) { return {float(c[0]), float(c[1]), float(c[2])}; }

class Builder {
 public:
  Builder(const Scene& scene, const Loaders& loaders, const BuildProgress& progress, const WorldOptions& options)
      : scene_(scene), loaders_(loaders), progress_(progress), options_(options), previous_(options.previous) {}
  // What was taken goes back, unless build() came to its end.
  ~Builder() {
    if (previous_ && !done_) give_back_fabrics(world_, *previous_);
  }

  World build() {
    step("knit", [&] { knit_all(); });
    step("props", [&] {
      add_objects();
      choose_origin();
      for (const Fabric& fabric : world_.fabrics) refuse_if_rounded(fabric, world_.origin);
      add_lights();
    });
    world_.camera = camera();
    world_.local_stage = local_stage(scene_.integrator);
    world_.leaf_form = leaf_form(scene_.integrator);
    done_ = true;
    return std::move(world_);
  }

 private:
  template <typename F>
  void step(const std::string& name, const F& work) {
    const auto start = std::chrono::steady_clock::now();
    if (progress_) progress_(name, 0);
    work();
    if (progress_) progress_(name, 1);
    world_.seconds[name] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void knit_all() {
    std::vector<KnittedFabric> knitted = knit_fabrics(
        scene_, loaders_,
        [&](double done) {
          if (progress_) progress_("knit", done);
        },
        previous_);
    for (size_t f = 0; f < knitted.size(); ++f) {
      const FabricScene& fabric = scene_.fabrics[f];
      const PlyAppearance& yarn = scene_.materials.at(size_t(fabric.material)).yarn;
      take(knitted[f]);
      Fabric& made = world_.fabrics.back();
      bounds_.add(made.mesh), fabric_bounds_.add(made.mesh);
      world_.fabric_material.push_back(uint32_t(world_.ply_materials.size()));
      world_.ply_materials.push_back(ply_material(yarn));
      world_.fibres.add(fibre_recipe(yarn), made.ply_radius, fabric.spec.detail);
      const bool fibres = made.report.fibres > 0;
      world_.fabric_fibre_material.push_back(fibres ? uint32_t(world_.fibre_materials.size()) : W_NONE);
      if (fibres) world_.fibre_materials.push_back(fibre_material(yarn));
      color_plies(made, yarn, fabric.color_image, knitted[f].yarn_colors);
    }
  }

  void take(KnittedFabric& knitted) {
    world_.fabrics.emplace_back();
    if (const auto from = knitted.of_previous) {
      world_.fabric_mesh_reports.push_back(previous_->fabric_mesh_reports[*from]);
      world_.knittings.push_back(previous_->knittings[*from]);
      std::swap(world_.fabrics.back(), previous_->fabrics[*from]);
    } else {
      world_.fabric_mesh_reports.push_back(knitted.mesh_report);
      world_.knittings.push_back(std::move(knitted.knitting));
      world_.fabrics.back() = std::move(knitted.fabric);
    }
    const std::vector<std::string>& notes = world_.knittings.back().notes;
    world_.notes.insert(world_.notes.end(), notes.begin(), notes.end());
  }

  void color_plies(Fabric& fabric, const PlyAppearance& yarn, const ColorImage& image, const std::vector<Rgb>& yarns) {
    const size_t before = vertices_;
    vertices_ += fabric.anchors.size();
    if (!colors_vary(yarn, image, yarns)) {
      if (!world_.ply_colors.empty()) world_.ply_colors.resize(vertices_, 0);
      return;
    }
    const std::vector<uint32_t> words =
        bake_ply_colors(fabric, yarn, image, image.file.empty() ? Image{} : loaders_.image(image.file), yarns);
    world_.ply_colors.resize(before, 0);  // fabrics before it keep their materials' colours
    world_.ply_colors.insert(world_.ply_colors.end(), words.begin(), words.end());
    world_.colored_fabrics.push_back(fabric.name);
    if (!options_.editable) fabric.place = {};
  }

  int add_material(const SurfaceAppearance& look) {
    WSurfaceMaterial m = surface_material(look);
    m.emission = {0, 0, 0, 0};
    m.light = -1;
    world_.surface_materials.push_back(m);
    return int(world_.surface_materials.size()) - 1;
  }

  int add_emitter(const Rgb& radiance, bool one_sided) {
    SurfaceAppearance black;
    black.color = {0, 0, 0};
    const int index = add_material(black);
    world_.surface_materials[size_t(index)].emission = rgb4(radiance, one_sided ? 1 : 0);
    return index;
  }

  // Triangles are kept in double until the origin is known.
  struct Triangle {
    std::array<dvec3, 3> corner, normal;
    int material;
  };

  void add_triangles(const BaseMesh& mesh, int material) {
    for (const auto& t : mesh.triangle) {
      Triangle triangle;
      for (size_t k = 0; k < 3; ++k) {
        triangle.corner[k] = mesh.position[t[k]];
        triangle.normal[k] = mesh.normal[t[k]];
      }
      triangle.material = material;
      triangles_.push_back(triangle);
    }
  }

  void add_quad(const dvec3& centre, const dvec3& half_u, const dvec3& half_v, int material) {
    const dvec3 n = glm::normalize(glm::cross(half_u, half_v));
    const std::array<dvec3, 4> c = {centre - half_u - half_v, centre + half_u - half_v, centre + half_u + half_v,
                                    centre - half_u + half_v};
    triangles_.push_back({{c[0], c[1], c[2]}, {n, n, n}, material});
    triangles_.push_back({{c[0], c[2], c[3]}, {n, n, n}, material});
  }

  void add_objects() {
    for (const auto& object : scene_.objects) {
      const int material = add_material(scene_.materials.at(size_t(object.material)).surface);
      if (object.kind == ObjectScene::Kind::sphere) {
        spheres_.push_back({object.center, object.radius, material, -1});
        world_.sphere_names.push_back('"' + object.name + '"');
        bounds_.add(object.center - object.radius);
        bounds_.add(object.center + object.radius);
        continue;
      }
      world_.triangle_names.push_back('"' + object.name + '"');
      if (object.kind == ObjectScene::Kind::ground) {
        const dvec3 up = glm::normalize(object.up);
        const dvec3 side = std::abs(up.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 u = glm::normalize(glm::cross(side, up)), v = glm::cross(up, u);
        // Under the fabric, not under the world's zero: a ground that is far away wastes the floats' digits.
        dvec3 centre = bounds_.empty() ? dvec3(0) : bounds_.centre();
        centre += up * (object.height - glm::dot(centre, up));
        add_quad(centre, u * object.extent, v * object.extent, material);
      } else {
        BaseMesh mesh = load_mesh(object.mesh, loaders_);
        transform_mesh(mesh, object.transform);
        refuse_if_out_of_reach(mesh, object.name);
        bounds_.add(mesh);
        add_triangles(mesh, material);
      }
    }
  }

  void choose_origin() {
    world_.origin = !fabric_bounds_.empty() ? fabric_bounds_.centre()
                    : !bounds_.empty()      ? bounds_.centre()
                                            : scene_.camera.look_at;
  }

  void upload_triangle(const Triangle& t) {
    for (const auto& c : t.corner)
      for (int a = 0; a < 3; ++a) world_.triangles.push_back(float(c[a] - world_.origin[a]));
    for (const auto& n : t.normal)
      for (int a = 0; a < 3; ++a) world_.triangles.push_back(float(n[a]));
    world_.triangles.push_back(std::bit_cast<float>(uint32_t(t.material)));
    world_.triangles.push_back(0.0f);
  }

  void add_lights() {
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
    for (const auto& t : triangles_) upload_triangle(t);
    for (const auto& s : spheres_)
      world_.spheres.push_back({vec4(s.centre - world_.origin, s.radius), s.material, s.light, 0, 0});
    world_.lights = tables.finish(light_choice());
  }

  LightChoice light_choice() const {
    return scene_.integrator.light_choice == "uniform" ? LightChoice::uniform : LightChoice::power;
  }

  void name_light(const LightScene& light, const char* kind) {
    world_.light_names.push_back(light.name.empty() ? kind : fmt::format("\"{}\" ({})", light.name, kind));
  }

  void add_sphere_light(const LightScene& light, LightTableBuilder& tables) {
    const int material = add_emitter(light.radiance, false);
    const dvec3 c = light.position - world_.origin;
    const int index =
        tables.add_sphere(rgb3(light.radiance), {float(c.x), float(c.y), float(c.z)}, float(light.radius));
    world_.surface_materials[size_t(material)].light = index;
    spheres_.push_back({light.position, light.radius, material, index});
    name_light(light, "sphere");
    world_.sphere_names.push_back(world_.light_names.back());
  }

  // Registers triangles [first, end) as one light.
  void register_triangles(size_t first, const Rgb& radiance, bool one_sided, int material, LightTableBuilder& tables,
                          const LightScene& light, const char* kind) {
    std::vector<LightTriangle> corners;
    std::vector<int32_t> numbers;
    for (size_t i = first; i < triangles_.size(); ++i) {
      LightTriangle t;
      for (size_t k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) t[3 * k + size_t(a)] = float(triangles_[i].corner[k][a] - world_.origin[a]);
      corners.push_back(t);
      numbers.push_back(int32_t(i));
    }
    world_.surface_materials[size_t(material)].light = tables.add_mesh(rgb3(radiance), corners, numbers, one_sided);
    name_light(light, kind);
    world_.triangle_names.push_back(world_.light_names.back());
  }

  void add_quad_light(const LightScene& light, LightTableBuilder& tables) {
    const ViewFrame frame(light.position, light.look_at, light.up);
    const int material = add_emitter(light.radiance, !light.two_sided);
    const size_t first = triangles_.size();
    // right x up points against forward: the order below makes the front face look_at.
    add_quad(light.position, frame.up * (0.5 * light.height), frame.right * (0.5 * light.width), material);
    register_triangles(first, light.radiance, !light.two_sided, material, tables, light, "quad");
  }

  void add_mesh_light(const LightScene& light, LightTableBuilder& tables) {
    BaseMesh mesh = load_mesh(light.mesh, loaders_);
    transform_mesh(mesh, light.transform);
    const int material = add_emitter(light.radiance, false);
    const size_t first = triangles_.size();
    add_triangles(mesh, material);
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
    env.light = tables.add_environment(rgb3(mean), float(bounds_.radius()));
    name_light(light, "environment");
  }

  WCamera camera() const {
    const Bounds& b = fabric_bounds_.empty() ? bounds_ : fabric_bounds_;
    const CameraScene seen =
        scene_.camera_given ? scene_.camera
                            : framed_camera(scene_.camera, scene_.film, b.empty() ? dvec3(0) : b.centre(), b.radius());
    const WCamera made = device_camera(seen, scene_.film, world_.origin);
    refuse_if_pixels_are_rounded(made, glm::length(seen.position - world_.origin));
    return made;
  }

  struct Sphere {
    dvec3 centre;
    double radius;
    int material, light;
  };

  const Scene& scene_;
  const Loaders& loaders_;
  const BuildProgress& progress_;
  const WorldOptions& options_;
  World* previous_;
  bool done_ = false;
  World world_;
  Bounds bounds_, fabric_bounds_;
  size_t vertices_ = 0;  ///< of the fabrics so far
  std::vector<Triangle> triangles_;
  std::vector<Sphere> spheres_;
};

}  // namespace

void give_back_fabrics(World& from, World& previous) {
  for (size_t i = 0; i < from.fabrics.size(); ++i)
    for (size_t k = 0; k < previous.fabrics.size(); ++k)
      if (previous.knittings[k].number == from.knittings[i].number) std::swap(previous.fabrics[k], from.fabrics[i]);
}

World build_world(const Scene& scene, const Loaders& loaders, const BuildProgress& progress,
                  const WorldOptions& options) {
  World world = Builder(scene, loaders, progress, options).build();
  if (options.drop) drop_what_cannot_matter(world);
  return world;
}

}  // namespace wale
