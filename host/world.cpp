#include "host/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "geom/error.h"
#include "host/analysis.h"
#include "host/bounds.h"
#include "host/features.h"
#include "host/knit_fabrics.h"
#include "host/materials.h"
#include "host/placement.h"
#include "host/ply_colors.h"
#include "host/surface_set.h"
#include "host/viewpoint.h"
#include "host/world_lights.h"

namespace wale {
namespace {

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
      add_lights(world_, surfaces_, scene_, loaders_, bounds_.radius(), kept_before());
      surfaces_.place(world_);
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
      add_bounds(made, fabric.transform);
      world_.fabric_material.push_back(uint32_t(world_.ply_materials.size()));
      const MadeYarn& material = make_yarn(yarn, made.report.fibres > 0);
      world_.ply_materials.push_back(material.ply);
      world_.fibres.add(fibre_recipe(yarn), made.ply_radius, fabric.spec.detail,
                        previous_ ? &previous_->fibres : nullptr);
      const bool fibres = made.report.fibres > 0;
      world_.fabric_fibre_material.push_back(fibres ? uint32_t(world_.fibre_materials.size()) : W_NONE);
      if (fibres) world_.fibre_materials.push_back(*material.fibre);
      color_plies(made, yarn, fabric.color_image, knitted[f].yarn_colors);
    }
  }

  // As an earlier version has it, if it is the same.
  const MadeYarn& make_yarn(const PlyAppearance& yarn, bool fibres) {
    if (previous_)
      for (const MadeYarn& made : previous_->made_yarns)
        if (made.from == yarn && made.fibre.has_value() == fibres) return world_.made_yarns.emplace_back(made);
    MadeYarn made{yarn, ply_material(yarn), {}};
    if (fibres) made.fibre = fibre_material(yarn);
    return world_.made_yarns.emplace_back(std::move(made));
  }

  void take(KnittedFabric& knitted) {
    world_.fabrics.emplace_back();
    if (const auto from = knitted.of_previous) {
      world_.fabric_mesh_reports.push_back(previous_->fabric_mesh_reports[*from]);
      world_.knittings.push_back(previous_->knittings[*from]);
      std::swap(world_.fabrics.back(), previous_->fabrics[*from]);
      if (!knitted.moved.triangle.empty()) world_.knittings.back().place = knitted.knitting.place;
    } else {
      world_.fabric_mesh_reports.push_back(knitted.mesh_report);
      world_.knittings.push_back(std::move(knitted.knitting));
      world_.fabrics.back() = std::move(knitted.fabric);
    }
    if (!knitted.moved.triangle.empty()) follow_mesh(world_.fabrics.back(), knitted.moved);
    for (const auto& notes : {world_.knittings.back().notes, knitted.frame_notes})
      world_.notes.insert(world_.notes.end(), notes.begin(), notes.end());
  }

  // A cloth that moves counts as it is at rest: neither the ground nor a camera that nobody placed follows every fold.
  void add_bounds(const Fabric& fabric, const Transform& transform) {
    Bounds here;
    here.add(fabric.mesh);
    if (world_.knittings.back().place) {
      moving_.add(here.centre());
      BaseMesh rest = *fabric.mesh.rest;
      transform_mesh(rest, {1, transform.rotate, transform.translate});
      bounds_.add(rest), fabric_bounds_.add(rest);
    } else {
      bounds_.add(fabric.mesh), fabric_bounds_.add(fabric.mesh);
    }
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

  const KeptMeshes* kept_before() const { return previous_ ? &previous_->kept_meshes : nullptr; }

  void add_objects() {
    for (const auto& object : scene_.objects) {
      const int material = SurfaceSet::add_material(world_, scene_.materials.at(size_t(object.material)).surface);
      if (object.kind == ObjectScene::Kind::sphere) {
        surfaces_.add_sphere(object.center, object.radius, material, -1);
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
        surfaces_.add_quad(centre, u * object.extent, v * object.extent, material);
      } else {
        BaseMesh mesh = *world_.kept_meshes.load(object.mesh, loaders_, kept_before(), world_.notes);
        transform_mesh(mesh, object.transform);
        refuse_if_out_of_reach(mesh, object.name);
        bounds_.add(mesh);
        surfaces_.add_mesh(mesh, material);
      }
    }
  }

  void choose_origin() {
    world_.origin = !fabric_bounds_.empty() ? fabric_bounds_.centre()
                    : !bounds_.empty()      ? bounds_.centre()
                                            : scene_.camera.look_at;
    if (!moving_.empty()) {
      // Only an origin that stays lets a fabric be moved in place: that of a coarse grid near the cloth, which costs
      // three bits of a float at most.
      const double grid = std::exp2(std::ceil(std::log2(8 * fabric_bounds_.radius())));
      world_.origin = grid * glm::round(moving_.centre() / grid);
    }
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

  const Scene& scene_;
  const Loaders& loaders_;
  const BuildProgress& progress_;
  const WorldOptions& options_;
  World* previous_;
  bool done_ = false;
  World world_;
  Bounds bounds_, fabric_bounds_;
  Bounds moving_;        ///< of the middles of fabrics that follow their mesh
  size_t vertices_ = 0;  ///< of the fabrics so far
  SurfaceSet surfaces_;
};

}  // namespace

void give_back_fabrics(World& from, World& previous) {
  for (size_t i = 0; i < from.fabrics.size(); ++i)
    for (size_t k = 0; k < previous.fabrics.size(); ++k)
      if (previous.knittings[k].number == from.knittings[i].number) {
        std::swap(previous.fabrics[k], from.fabrics[i]);
        previous.knittings[k].place = from.knittings[i].place;  // its mesh has been moved
      }
}

World build_world(const Scene& scene, const Loaders& loaders, const BuildProgress& progress,
                  const WorldOptions& options) {
  World world = Builder(scene, loaders, progress, options).build();
  if (options.drop) drop_what_cannot_matter(world);
  return world;
}

}  // namespace wale
