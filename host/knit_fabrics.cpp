#include "host/knit_fabrics.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "geom/error.h"
#include "geom/lattice_fabric.h"
#include "geom/mesh_repair.h"
#include "geom/run_tasks.h"
#include "host/accuracy.h"
#include "host/features.h"
#include "host/materials.h"
#include "host/placement.h"
#include "host/ply_colors.h"
#include "host/storage.h"

namespace wale {
namespace {

// Colours that vary are stored per vertex; the cell stages list stored segments.
std::string lattice_obstacle_of_scene(const Scene& scene, const std::vector<Pattern>& patterns) {
  if (const std::string& stage = scene.integrator.local_stage; stage != "exact") {
    const std::string& preset = scene.accuracy_preset;
    std::string set_by;
    if (!preset.empty())
      for (const auto& [option, level] : accuracy_preset(preset).levels)
        if (option == "local_stage" && level == stage)
          set_by = fmt::format(" (--preset {} sets it; --set integrator.local_stage=exact undoes that)", preset);
    return fmt::format("integrator.local_stage is \"{}\"{}", stage, set_by);
  }
  for (size_t i = 0; i < scene.fabrics.size(); ++i) {
    const FabricScene& fabric = scene.fabrics[i];
    if (colors_vary(scene.materials.at(size_t(fabric.material)).yarn, fabric.color_image,
                    yarn_colors(fabric, patterns[i])))
      return fmt::format("colours vary over fabric \"{}\"", fabric.spec.name);
  }
  return {};
}

std::string lattice_note(const Fabric& fabric, const StorageChoice& choice) {
  double change = 0;
  for (const LatticeChart& chart : fabric.lattice)
    for (const TileYarn& yarn : chart.tile.yarns) change = std::max(change, std::abs(yarn.twist_change));
  return fmt::format(
      "fabric \"{}\": held as a lattice of {} cell(s) along a tile's side, {} ({}); its twist changes by {:.3g} turns "
      "per metre so that tiles join",
      fabric.name, fabric.lattice[0].lattice.cells,
      choice.storage == Storage::procedural ? "points warped where needed" : "points stored", choice.because, change);
}

// A segment takes 16 bytes of frame and about 25 in leaves and nodes on the device, and 12 of position and 32 of
// anchor until its leaf is packed; the host holds it once more while it knits.
void refuse_if_too_large(const BaseMesh& mesh, const Pattern& pattern, const FabricSpec& spec) {
  // A procedural one keeps a few bytes; its boxes and its tree take some forty while they are built.
  const double bytes = spec.storage == Storage::procedural ? 48 : 16 + 25 + 12 + 32 + 160;
  const double segments = double(estimate_segments(mesh, pattern, spec));
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  if (segments * bytes > 0.8 * memory)
    user_error(
        "fabric \"{}\": about {:.3g} ply segments would need {:.3g} GB, this machine has {:.3g} GB; use fewer "
        "repeats, a coarser gauge or a larger tolerance",
        spec.name, segments, segments * bytes * 1e-9, memory * 1e-9);
}

FabricSpec resolved(const Scene& scene, const FabricScene& fabric) {
  const PlyAppearance& yarn = scene.materials.at(size_t(fabric.material)).yarn;
  FabricSpec spec = fabric.spec;
  spec.fibres = fibre_recipe(yarn);
  spec.places = colors_need_places(yarn, fabric.color_image);
  spec.cell_lists = local_stage(scene.integrator) != LocalStage::exact;
  return spec;
}

// Fabrics that follow their mesh keep points, frames and tree; the others are knitted anew for every frame: where the
// knit itself follows from the mesh, by its triangles, its strain or a lattice.
bool follows_mesh(const FabricScene& fabric) {
  return fabric.moves && !(fabric.mesh.sequence && fabric.mesh.sequence->changing) &&
         fabric.spec.strain == LoopStrain::affine && fabric.spec.lattice == 0 &&
         fabric.spec.storage != Storage::procedural;
}

// Of a fabric that is knitted anew: its scale is that of the mesh at rest.
std::shared_ptr<const BaseMesh> rest_of(const FabricScene& fabric, const Loaders& loaders) {
  if (!fabric.mesh.sequence) return nullptr;
  auto rest = std::make_shared<BaseMesh>(load_rest_mesh(fabric.mesh, loaders));
  require_uv(*rest);
  join_duplicate_vertices(*rest);
  transform_mesh(*rest, fabric.transform);
  return rest;
}

void knit(const Pattern& pattern, BaseMesh mesh, KnittedFabric& out) {
  require_uv(mesh);
  FabricSpec spec = out.knitting.order.spec;
  std::vector<std::string>& notes = out.knitting.notes;
  if (const size_t joined = join_duplicate_vertices(mesh))
    notes.push_back(
        fmt::format("fabric \"{}\": {} vertices in the place of another one are joined to it", spec.name, joined));
  transform_mesh(mesh, out.knitting.order.transform);
  refuse_if_out_of_reach(mesh, spec.name);
  const StorageChoice choice = choose_storage(mesh, pattern, spec, out.knitting.order.obstacle);
  spec.storage = choice.storage;
  refuse_if_too_large(mesh, pattern, spec);
  out.mesh_report = validate(mesh);
  part_opposed_seams(mesh);
  out.fabric =
      choice.lattice ? knit_lattice(std::move(mesh), pattern, spec) : knit_fabric(std::move(mesh), pattern, spec);
  if (choice.lattice) notes.push_back(lattice_note(out.fabric, choice));
  if (out.knitting.place) out.fabric.mesh.rest = std::make_shared<BaseMesh>(out.fabric.mesh);
}

KnitOrder order_of(const Scene& scene, const FabricScene& fabric, const std::string& obstacle) {
  KnitOrder order{fabric.mesh, fabric.transform, fabric.pattern, resolved(scene, fabric), obstacle};
  if (!follows_mesh(fabric)) return order;
  order.mesh.frame = 0;
  order.transform.rotate = order.transform.translate = {0, 0, 0};
  order.spec.storage = Storage::stored;
  return order;
}

std::optional<size_t> find_same(const World* previous, const KnitOrder& order,
                                const std::vector<KnittedFabric>& taken) {
  if (!previous) return {};
  for (size_t i = 0; i < previous->fabrics.size(); ++i)
    if (serves(previous->knittings[i].order, previous->fabrics[i], order) &&
        std::none_of(taken.begin(), taken.end(), [&](const KnittedFabric& other) { return other.of_previous == i; }))
      return i;
  return {};
}

}  // namespace

void follow_mesh(Fabric& fabric, const BaseMesh& moved) {
  BaseMesh& mesh = fabric.mesh;
  if (mesh.triangle.size() != moved.triangle.size())
    bug("fabric \"{}\": {} triangles cannot follow {}", fabric.name, mesh.triangle.size(), moved.triangle.size());
  // Backwards, so that a vertex that stands for several is where the first of them is.
  for (size_t t = mesh.triangle.size(); t-- > 0;)
    for (size_t k = 3; k-- > 0;) mesh.position[mesh.triangle[t][k]] = moved.position[moved.triangle[t][k]];
  compute_normals(mesh);
}

void refuse_more_segments(const Scene& scene, const Loaders& loaders, const World* previous, double most) {
  std::vector<Pattern> patterns;
  for (const FabricScene& fabric : scene.fabrics) patterns.push_back(load_pattern(fabric.pattern));
  const std::string obstacle = lattice_obstacle_of_scene(scene, patterns);
  for (size_t i = 0; i < scene.fabrics.size(); ++i) {
    const KnitOrder order = order_of(scene, scene.fabrics[i], obstacle);
    if (find_same(previous, order, {})) continue;
    BaseMesh mesh = load_rest_mesh(order.mesh, loaders);
    require_uv(mesh);
    transform_mesh(mesh, order.transform);
    refuse_if_out_of_reach(mesh, order.spec.name);
    if (const double segments = double(estimate_segments(mesh, patterns[i], order.spec)); segments > most)
      user_error(
          "fabric \"{}\": about {:.3g} segments, at most {:.3g} here; use a coarser gauge, fewer hairs or less detail",
          order.spec.name, segments, most);
  }
}

std::vector<KnittedFabric> knit_fabrics(const Scene& scene, const Loaders& loaders,
                                        const std::function<void(double)>& progress, const World* previous) {
  static std::atomic<uint64_t> knitted_so_far{0};
  const size_t count = scene.fabrics.size();
  std::vector<Pattern> patterns;
  for (const FabricScene& fabric : scene.fabrics) patterns.push_back(load_pattern(fabric.pattern));
  const std::string obstacle = lattice_obstacle_of_scene(scene, patterns);
  std::vector<KnittedFabric> out(count);
  std::vector<BaseMesh> meshes(count);
  std::vector<size_t> numbers;  // to be knitted
  for (size_t i = 0; i < count; ++i) {
    const FabricScene& fabric = scene.fabrics[i];
    const KnitOrder order = order_of(scene, fabric, obstacle);
    std::optional<MeshPlace> place;
    if (follows_mesh(fabric)) place = MeshPlace{fabric.mesh.frame, fabric.transform.rotate, fabric.transform.translate};
    out[i].yarn_colors = yarn_colors(fabric, patterns[i]);
    out[i].of_previous = find_same(previous, order, out);
    // Meshes are read one after the other: their readers keep a state.
    if (place && !(out[i].of_previous && previous->knittings[*out[i].of_previous].place == place)) {
      out[i].moved = load_mesh(fabric.mesh, loaders, &out[i].frame_notes);
      transform_mesh(out[i].moved, fabric.transform);
      refuse_if_out_of_reach(out[i].moved, fabric.spec.name);
    }
    out[i].knitting = {order, 0, {}, place};
    if (out[i].of_previous) continue;
    out[i].knitting.number = ++knitted_so_far;
    if (place) {
      meshes[i] = load_rest_mesh(fabric.mesh, loaders);
    } else {
      meshes[i] = load_mesh(fabric.mesh, loaders, &out[i].frame_notes);
      meshes[i].rest = rest_of(fabric, loaders);
    }
    numbers.push_back(i);
  }
  std::vector<std::exception_ptr> failed(count);
  std::mutex mutex;
  size_t done = 0;
  const size_t knitting = numbers.size();
  std::reverse(numbers.begin(), numbers.end());  // taken from the back
  // Parts of knitting that have one thread only then fill each other's gaps.
  const auto threads = unsigned(std::min<size_t>(knitting, std::max(1u, std::thread::hardware_concurrency())));
  run_tasks(threads, std::move(numbers), [&](size_t i, const auto&) {
    try {
      knit(patterns[i], std::move(meshes[i]), out[i]);
    } catch (...) {
      failed[i] = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    progress(double(++done) / double(knitting));
  });
  for (const auto& failure : failed)
    if (failure) std::rethrow_exception(failure);
  return out;
}

}  // namespace wale
