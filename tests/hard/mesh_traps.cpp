#include <fmt/format.h>

#include <algorithm>

#include "tests/hard/fixtures_meshes.h"
#include "tests/hard/fixtures_scenes.h"
#include "tests/hard/look_fabric.h"
#include "tests/hard/look_picture.h"
#include "tests/hard/trap.h"
#include "tests/kernels/fabric_tracer.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

const Loaders kLoaders{[](const auto& file) { return read_mesh(file); },
                       [](const auto& file) { return read_image(file, true); }};

struct View {
  dvec3 target{0, 0, 0}, direction{0, 0, -1};
};

/// Mesh traps share one promise in three parts: white cloth in a white furnace is exactly white; rays meet what brute
/// force in double meets; closed cloth has no slit in the views given.
struct MeshTrap {
  std::string name, breaks, promise;
  BaseMesh mesh;
  double view = 0.008;                                   ///< metres across the furnace's picture
  std::vector<View> closed = {};                         ///< views of 3 mm in which cloth fills the picture
  std::function<std::string(const World&)> report = {};  ///< empty when the report says what it must
};

Finding look_at_mesh(const MeshTrap& trap) {
  const Scene scene = white_furnace(trap.mesh, trap.view, 24);
  const World world = build_world(scene, kLoaders);
  Finding found = look_at_constant(scene, 1.0, 192);
  if (trap.report) found.broken += trap.report(world);
  const Agreement agree = compare_with_brute_force(world.fabrics[0], 10000);
  found.trials += agree.rays;
  if (agree.hits < agree.rays / 10) found.broken += fmt::format(" only {} of {} rays hit", agree.hits, agree.rays);
  if (agree.wrong) found.broken += fmt::format(" {} of {} rays differ from brute force", agree.wrong, agree.rays);
  if (double(agree.grazing) > tolerance::kGrazingShare * double(agree.rays))
    found.broken += fmt::format(" {} of {} grazing rays differ", agree.grazing, agree.rays);
  if (trap.closed.empty()) return found;
  const World closed = build_world(closed_cloth(trap.mesh), kLoaders);
  for (const View& view : trap.closed)
    if (const uint64_t passed = rays_that_pass(closed.fabrics[0], view.target, view.direction, 0.003, 150))
      found.broken += fmt::format(" {} of 22500 rays pass closed cloth at ({:.4f}, {:.4f}, {:.4f})", passed,
                                  view.target.x, view.target.y, view.target.z);
  return found;
}

Trap trap_of(const MeshTrap& trap) {
  return {trap.name, trap.breaks, trap.promise, "of the furnace's radiance", tolerance::kFurnacePicture, 0, [trap] {
            return look_at_mesh(trap);
          }};
}

std::string expect(bool good, const std::string& what) { return good ? "" : " " + what; }

/// Ply vertices on the cloth whose interpolated normal is more than 45 degrees off their triangle's plane, or gone.
std::string lost_normals(const World& world) {
  const Fabric& fabric = world.fabrics[0];
  const BaseMesh& mesh = fabric.mesh;
  size_t lost = 0;
  for (const Anchor& a : fabric.anchors) {
    const double b0 = 1.0 - a.b1 - a.b2, b1 = a.b1, b2 = a.b2;
    if (std::min({b0, b1, b2}) < 0) continue;
    const auto& t = mesh.triangle[a.triangle];
    const dvec3 n = b0 * mesh.normal[t[0]] + b1 * mesh.normal[t[1]] + b2 * mesh.normal[t[2]];
    const dvec3 face = glm::cross(mesh.position[t[1]] - mesh.position[t[0]], mesh.position[t[2]] - mesh.position[t[0]]);
    lost += !(glm::dot(n, face) > 0.7 * glm::length(face));
  }
  return expect(lost == 0, fmt::format("{} of {} vertices have no normal", lost, fabric.anchors.size()));
}

/// Hits of the exact stage that KNIT21's cells lose.
size_t lost_by_cells(const Fabric& fabric) {
  const FabricTracer exact(device(), fabric), cell(device(), fabric, -1, LocalStage::cell);
  const std::vector<Ray> rays = primary_rays(exact.bounds(), 5000, 7);
  const std::vector<Hit> a = exact.trace(rays), b = cell.trace(rays);
  size_t lost = 0;
  for (size_t i = 0; i < rays.size(); ++i) lost += a[i].kind == W_HIT_PLY && b[i].kind != W_HIT_PLY;
  return lost;
}

/// Cells lose no more far from 0 than whole tiles nearer: a float of far UVs would span several cells.
std::string lost_cells(const World& world) {
  BaseMesh near = world.fabrics[0].mesh;
  const Pattern pattern = stockinette_pattern();
  const dvec2 tiles = glm::floor(near.uv[0][0] / pattern.period) * pattern.period;
  for (auto& t : near.uv)
    for (dvec2& uv : t) uv -= tiles;
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  const size_t far = lost_by_cells(knit_fabric(world.fabrics[0].mesh, pattern, spec)),
               here = lost_by_cells(knit_fabric(near, pattern, spec));
  return expect(double(far) < 1.02 * double(here) + 5, fmt::format("cells lose {} hits, {} near 0", far, here));
}

const MeshReport& report_of(const World& world) { return world.fabric_mesh_reports[0]; }

constexpr const char* kWhite = "white cloth in a white furnace is white, rays meet what brute force in double meets";

std::vector<MeshTrap> list() {
  const std::vector<View> middle = {{}};
  return {
      {"needle triangles", "UV gradients and face normals of triangles 1 nm wide are rounding", kWhite, needle_sheet(),
       0.008, middle},
      {"pancake triangles", "a vertex 1 nm from the opposite edge: weights and normals are rounding", kWhite,
       pancake_sheet(), 0.008, middle},
      {"UVs of no area",
       "a division by the UV area puts NaN into frames",
       kWhite,
       sheet_with_uv_point(),
       0.008,
       {},
       [](const World& w) { return expect(report_of(w).zero_area_uv == 2, "the report hides UVs without area"); }},
      {"flipped UV",
       "points fall into two triangles or none",
       kWhite,
       sheet_with_flipped_uv(),
       0.008,
       {},
       [](const World& w) { return expect(report_of(w).flipped_uv > 0, "the report hides flips"); }},
      {"faces wound both ways", "normals of neighbours cancel", kWhite, sheet_wound_both_ways(), 0.008, middle},
      {"UV far from 0", "float UVs lose the stitch", kWhite, sheet_with_far_uv(), 0.008, middle, lost_cells},
      {"UV seam through a stitch",
       "yarns end at the seam, which gapes",
       kWhite,
       tube_with_seam_in_a_stitch(),
       0.01,
       {{dvec3(0, 0, 0.006), dvec3(-1, 0, 0)}, {dvec3(0, 0, 0.006), dvec3(1, 0, 0)}},
       [](const World& w) {
         return expect(w.fabrics[0].report.snapped_repeats == std::vector{ivec2(9, 0)}, "repeats do not snap to 9");
       }},
      {"charts in one place", "a point finds the other chart's triangle", kWhite, two_charts_in_one_place(), 0.008,
       middle},
      {"chart over itself",
       "a yarn jumps between the layers",
       kWhite,
       chart_over_itself(),
       0.008,
       {},
       [](const World& w) { return expect(report_of(w).chart_overlap > 0.9, "the report hides the overlap"); }},
      {"pole of a sphere",
       "all wales meet in a point without a normal or a metric",
       kWhite,
       ball_with_poles(),
       0.012,
       {{dvec3(0), dvec3(1, 0, 0)}, {dvec3(0), dvec3(0, 0, 1)}, {dvec3(0), dvec3(0, 0, -1)}}},
      {"Moebius strip",
       "vertex normals cancel where the strip meets its own back",
       kWhite,
       moebius_strip(),
       0.024,
       {{dvec3(0.008, 0, 0), dvec3(0, 0, -1)}},
       lost_normals},
      {"double sheet", "coincident cloths hit each other where a path starts", kWhite, double_sheet(), 0.008, middle},
      {"three sheets on an edge",
       "an edge with three sides has no other side",
       kWhite,
       three_sheets_on_an_edge(),
       0.008,
       {},
       [](const World& w) {
         return lost_normals(w) + expect(report_of(w).non_manifold_edges > 0, "the report hides the edge");
       }},
      {"loose triangles", "every triangle is a chart of its own, and frays", kWhite, sheet_of_loose_triangles(), 0.008,
       middle},
      {"stray vertex", "a vertex that no face uses moves the origin and takes the cloth's digits", kWhite,
       sheet_with_stray_vertex(), 0.008, middle},
      {"one triangle", "a chart without neighbours has no inside", kWhite, one_triangle(0.006), 0.008},
      {"triangles that are points",
       "a face without area has no normal",
       kWhite,
       sheet_with_spatial_point(),
       0.008,
       {},
       [](const World& w) { return expect(report_of(w).degenerate_triangles > 0, "the report hides them"); }},
  };
}

}  // namespace

std::vector<Trap> mesh_traps() {
  std::vector<Trap> traps;
  for (const MeshTrap& trap : list()) traps.push_back(trap_of(trap));
  return traps;
}

}  // namespace wale::test
