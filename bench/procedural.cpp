// Stored against procedural leaves of one lattice. Usage: procedural_bench [segments] [rays per side] [cells] [stored]
// [rows.csv]. Prints how far the lattice's warp is from the mesh's, bytes a segment, seconds of the build, million rays
// per CPU-second and the ratio of the two, each the median of five interleaved launches, and how many hits differ;
// appends the figures to the rows' file. With 0 as `stored` the procedural form is measured alone.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "bench/growth_rows.h"
#include "bench/wale_bench/clock.h"
#include "geom/base_mesh_generators.h"
#include "geom/lattice_fabric.h"
#include "geom/warp.h"
#include "tests/kernels/fabric_tracer.h"

namespace {

using namespace wale;
using namespace wale::test;
using bench::median;

// A square of cloth with folds as long as a third of it.
BaseMesh sheet(double side) {
  BaseMesh mesh = make_swatch(side, side, 48, 48);
  for (dvec3& p : mesh.position) p.z = 0.03 * side * std::sin(18 * p.x / side) * std::cos(9 * p.y / side);
  compute_normals(mesh);
  return mesh;
}

constexpr const char* form_of(Storage storage) {
  return storage == Storage::stored ? "stored of lattice" : "procedural";
}

std::unique_ptr<FabricTracer> hold(const BaseMesh& mesh, const Pattern& pattern, FabricSpec spec, Storage storage,
                                   bench::GrowthRows& rows) {
  spec.storage = storage;
  const bench::Stopwatch knit;
  const Fabric fabric = knit_lattice(mesh, pattern, spec);
  const bench::Seconds knitted = knit.seconds();
  const bench::Stopwatch upload;
  auto tracer = std::make_unique<FabricTracer>(test_device(), fabric);
  const bench::Seconds uploaded = upload.seconds();
  const FabricDevice& f = tracer->fabric();
  const double n = double(f.segment_count), lattice = double(f.lattice.bytes()) / n;
  const double nodes = double(f.tree.tree_bytes()) / n, leaves = double(f.tree.leaves.bytes()) / n;
  const double trace = nodes + leaves + lattice * (storage == Storage::procedural);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print(
      "{:17} {} segments, {} leaves, {:.2f} B a segment to trace ({:.2f} nodes, {:.2f} lattice and tile tables, {:.2f} "
      "leaves), {:.2f} in frames; lattice {:.2f} s, upload {:.2f} s (warp {:.2f}, pack {:.2f}, tree {:.2f}), CPU "
      "{:.3f} and {:.3f} s; peak {:.0f} MB\n",
      form_of(storage), f.segment_count, f.patch_count, trace, nodes, lattice, leaves, double(f.frames.bytes()) / n,
      knitted.wall, uploaded.wall, f.warp_seconds, f.pack_seconds, f.build_seconds, knitted.cpu, uploaded.cpu,
      double(usage.ru_maxrss) / 1024);
  rows.add(f.segment_count, form_of(storage), "memory to trace", "bytes a segment", trace);
  rows.add(f.segment_count, form_of(storage), "build", "CPU seconds", uploaded.cpu);
  return tracer;
}

// Distance of the lattice's warp from that of the mesh, in ply radii: median and largest over the plies' vertices.
void print_accuracy(const BaseMesh& mesh, const Pattern& pattern, FabricSpec spec) {
  for (const int cells : {1, 2, 4, 8}) {
    spec.lattice = cells;
    const Fabric fabric = knit_lattice(mesh, pattern, spec);
    const Chart& chart = fabric.charts[0];
    const auto& [lattice, tile] = fabric.lattice[0];
    const ChartLocator locator(mesh, chart);
    const dvec2 tile_uv = (chart.uv_max - chart.uv_min) / dvec2(lattice.tiles);
    std::vector<double> radii;
    const int step = std::max(1, lattice.tiles.x / 16);
    for (int y = 0; y < lattice.tiles.y; y += step)
      for (int x = 0; x < lattice.tiles.x; x += step)
        for (const TileYarn& yarn : tile.yarns)
          for (uint32_t k = 0; k < yarn.samples; ++k) {
            const TileVertex& v = yarn.at(0, int(k));
            dvec3 warped(0);
            double height = 0;
            for (int c = 0; c < 4; ++c) {
              const ivec2 at = v.cell + ivec2(c & 1, c >> 1);
              const size_t i = size_t(int64_t(lattice.corner({x, y})) + at.x + int64_t(at.y) * lattice.size.x);
              warped += double(v.w[c]) * lattice.position[i] + double(v.h[c]) * lattice.normal[i];
              height += double(v.h[c]);
            }
            const dvec2 f(double(v.w[1]) + v.w[3], double(v.w[2]) + v.w[3]);
            ChartPoint point;
            const dvec2 uv = chart.uv_min + tile_uv * (dvec2(x, y) + (dvec2(v.cell) + f) / double(cells));
            if (locator.locate(uv, 0, chart.metres_per_uv, point))
              radii.push_back(glm::length(warped - warp_point(mesh, point, height)) / fabric.ply_radius);
          }
    std::sort(radii.begin(), radii.end());
    fmt::print("{} cells along a tile of {:.2f} mm: off the mesh's warp by {:.4f} radii (median), {:.4f} (largest)\n",
               cells, 1e3 * fabric.report.tile_metres.x, radii[radii.size() / 2], radii.back());
  }
}

uint32_t every_second_bit(uint32_t x) {
  uint32_t out = 0;
  for (int k = 0; k < 16; ++k) out |= (x >> (2 * k) & 1u) << k;
  return out;
}

std::vector<Ray> grid_of_rays(const Box& b, uint32_t side) {
  const dvec3 lo(b.lo[0], b.lo[1], b.lo[2]), hi(b.hi[0], b.hi[1], b.hi[2]), middle = 0.5 * (lo + hi);
  const dvec3 eye = middle + dvec3(0.1, -0.2, 1.2) * glm::length(hi - lo);
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < side * side; ++i) {
    const dvec3 target(lo.x + (hi.x - lo.x) * (every_second_bit(i) + 0.5) / side,
                       lo.y + (hi.y - lo.y) * (every_second_bit(i >> 1) + 0.5) / side, middle.z);
    rays.push_back(make_ray(eye, target - eye, i));
  }
  return rays;
}

void compare(const char* kind, const char* kernel, const FabricTracer* stored, const FabricTracer& procedural,
             const std::vector<Ray>& rays, const std::vector<Ray>& same, bench::GrowthRows& rows) {
  std::vector<double> a, b, ratio;
  for (int k = 0; k < 6; ++k) {
    if (stored) a.push_back(stored->cpu_seconds(rays, kernel));
    b.push_back(procedural.cpu_seconds(same, kernel));
    if (stored) ratio.push_back(a.back() / b.back());
    if (k == 0) a.clear(), b.clear(), ratio.clear();  // warm
  }
  const double million = double(same.size()) * 1e-6;
  const auto speed = [&](const FabricTracer& tracer, Storage storage, double value) {
    rows.add(tracer.fabric().segment_count, form_of(storage), fmt::format("speed, {}", kind),
             "million rays a CPU second", value);
    return value;
  };
  const double alone = speed(procedural, Storage::procedural, million / median(b));
  if (!stored)
    fmt::print("{:8} procedural {:.2f} Mrays per CPU-second\n", kind, alone);
  else
    fmt::print("{:8} stored {:.2f}, procedural {:.2f} Mrays per CPU-second, ratio {:.3f} ({:.3f} to {:.3f})\n", kind,
               speed(*stored, Storage::stored, million / median(a)), alone, median(ratio),
               *std::min_element(ratio.begin(), ratio.end()), *std::max_element(ratio.begin(), ratio.end()));
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 256;
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.lattice = argc > 3 ? std::atoi(argv[3]) : 1;
  const bool both = argc <= 4 || std::atoi(argv[4]) != 0;
  bench::GrowthRows rows(argc > 5 ? argv[5] : nullptr);
  const Pattern pattern = stockinette_pattern();
  const BaseMesh probe = sheet(0.1);
  const double per_area = double(estimate_segments(probe, pattern, spec)) / 0.01;
  const BaseMesh mesh = sheet(std::sqrt(wanted / per_area));
  fmt::print("{}\n", test_device().traits().name);
  print_accuracy(mesh, pattern, spec);
  for (const Storage storage : {Storage::procedural, Storage::stored}) {  // compiles the kernels
    FabricSpec small = spec;
    small.storage = storage;
    const Fabric fabric = knit_lattice(probe, pattern, small);
    const FabricTracer tracer(test_device(), fabric);
  }
  const auto procedural = hold(mesh, pattern, spec, Storage::procedural, rows);
  std::unique_ptr<FabricTracer> stored;
  if (both) stored = hold(mesh, pattern, spec, Storage::stored, rows);

  const std::vector<Ray> rays = grid_of_rays(procedural->bounds(), side);
  const std::vector<Hit> hits = procedural->trace(rays);
  const std::vector<Ray> bounce = bounce_rays(rays, hits, procedural->surfaces(rays, hits), 1);
  std::vector<Ray> stored_bounce;
  if (both) {
    const std::vector<Hit> others = stored->trace(rays);
    stored_bounce = bounce_rays(rays, others, stored->surfaces(rays, others), 1);
    const std::vector<Hit> a = stored->trace(stored_bounce), b = procedural->trace(bounce);
    size_t differ = 0;
    const auto count = [&](const std::vector<Hit>& x, const std::vector<Hit>& y) {
      for (size_t i = 0; i < x.size(); ++i)
        differ += x[i].kind != y[i].kind || std::memcmp(&x[i].t, &y[i].t, 4) != 0 || x[i].occluded != y[i].occluded ||
                  std::memcmp(&x[i].u, &y[i].u, 4) != 0;
    };
    count(hits, others);
    count(a, b);
    fmt::print("hits that differ: {} of {}\n", differ, hits.size() + a.size());
  }
  compare("primary", "nearest", stored.get(), *procedural, rays, rays, rows);
  compare("shadow", "any_hit", stored.get(), *procedural, stored_bounce, bounce, rows);
  compare("bounce", "nearest", stored.get(), *procedural, stored_bounce, bounce, rows);
}
