// Building and updating: a knitted fabric's curves through Wale's warp, leaves and tree, and through Intel Embree's
// round linear curves, in one process, interleaved: embree_updates [segments] [repetitions] [rows.csv]. Prints medians
// of wall and CPU time on two threads each, and of the ratios of every repetition; appends the figures to the rows'
// file. A frame moves the base mesh; Embree is handed the new points ready made, Wale makes them. Last come the same
// from the new base mesh in double, as it is read, to the first ray's hit.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bench/growth_rows.h"
#include "bench/peers/embree_device.h"
#include "bench/wale_bench/clock.h"
#include "geom/base_mesh_generators.h"
#include "tests/kernels/fabric_tracer.h"

namespace {

using namespace wale;
using namespace wale::test;

using bench::median;
using bench::Seconds;

template <typename Work>
Seconds time_of(const Work& work) {
  const bench::Stopwatch watch;
  work();
  return watch.seconds();
}

/// A sheet of stockinette of about `segments` ply segments: 4 mm wales on a mesh of one vertex a wale or so.
Fabric sheet(double segments) {
  constexpr double kWale = 0.004;
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  const Pattern pattern = stockinette_pattern(kWale);
  const double per_area = double(estimate_segments(make_swatch(1, 1, 1, 1), pattern, spec));
  const double side = std::sqrt(segments / per_area);
  const int steps = std::max(2, int(side / kWale));
  return knit_fabric(make_swatch(side, side, steps, steps), pattern, spec);
}

/// The base mesh at a moment of its motion: a wave runs through the sheet. Metres.
void wave(const BaseMesh& flat, double time, BaseMesh& mesh) {
  for (size_t i = 0; i < flat.position.size(); ++i) {
    const dvec3& p = flat.position[i];
    const double height = 0.01, k = 60, a = k * p.x + time;
    mesh.position[i] = {p.x, p.y, p.z + height * std::sin(a)};
  }
}

std::atomic<int64_t> embree_bytes{0};

/// The peer's scene. Kept as one that is built once, or as one that changes.
class Peer {
 public:
  Peer(const char* label, RTCBuildQuality scene, RTCBuildQuality geometry, RTCSceneFlags flags)
      : name(label), quality_(scene), geometry_quality_(geometry), flags_(flags) {
    device_ = bench::open_embree(embree_bytes);
  }
  ~Peer() {
    clear();
    rtcReleaseDevice(device_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  void clear() {
    if (scene_) rtcReleaseScene(scene_);
    scene_ = nullptr;
  }

  Seconds build(const Fabric& fabric, const std::vector<float>& points) {
    clear();
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality_);
    rtcSetSceneFlags(scene_, flags_);
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    rtcSetGeometryBuildQuality(geometry_, geometry_quality_);
    size_t segments = 0;
    for (const PlyRun& run : fabric.runs) segments += size_t(run.plies) * (run.count - 1 - 2 * run.ghost_ends);
    vertices_ = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, points.size() / 3));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, 4, segments));
    auto* flags = static_cast<uint8_t*>(
        rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR, 1, segments));
    size_t n = 0;
    for (const PlyRun& run : fabric.runs)
      for (uint32_t ply = 0; ply < run.plies; ++ply) {
        const uint32_t first = run.first_vertex + ply * run.count, skip = run.ghost_ends;
        for (uint32_t i = 0; i < run.count; ++i) vertices_[4 * size_t(first + i) + 3] = run.radius;
        for (uint32_t k = skip; k + 1 + skip < run.count; ++k) {
          indices[n] = first + k;
          flags[n++] = uint8_t((k > 0 ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0) |
                               (k + 2 < run.count ? RTC_CURVE_FLAG_NEIGHBOR_RIGHT : 0));
        }
      }
    place(points);
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcReleaseGeometry(geometry_);
    const Seconds seconds = time_of([&] { rtcCommitScene(scene_); });
    bytes = embree_bytes;
    return seconds;
  }

  Seconds update(const std::vector<float>& points) {
    place(points);
    return time_of([&] {
      rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry_);
      rtcCommitScene(scene_);
    });
  }

  /// Sends one ray.
  void hit(dvec3 from, dvec3 along) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit r{};
    r.ray.org_x = float(from.x), r.ray.org_y = float(from.y), r.ray.org_z = float(from.z);
    r.ray.dir_x = float(along.x), r.ray.dir_y = float(along.y), r.ray.dir_z = float(along.z);
    r.ray.tfar = 1e30f;
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &r);
  }

  const char* name;
  int64_t bytes = 0;

 private:
  void place(const std::vector<float>& points) {
    for (size_t i = 0; i < points.size() / 3; ++i) std::copy_n(points.data() + 3 * i, 3, vertices_ + 4 * i);
  }

  RTCBuildQuality quality_, geometry_quality_;
  RTCSceneFlags flags_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCGeometry geometry_ = nullptr;
  float* vertices_ = nullptr;
};

constexpr int kPeers = 2;

struct Row {
  std::vector<double> wall, cpu, wall_ratio, cpu_ratio;
  void add(Seconds s, Seconds other) {
    wall.push_back(s.wall);
    cpu.push_back(s.cpu);
    wall_ratio.push_back(other.wall / s.wall);
    cpu_ratio.push_back(other.cpu / s.cpu);
  }
  void print(const std::string& name, bool ratios) const {
    fmt::print("| {} | {:.4g} | {:.4g} |", name, 1e3 * median(wall), 1e3 * median(cpu));
    if (ratios)
      fmt::print(" {:.3f} ({:.3f} to {:.3f}) | {:.3f} |\n", median(wall_ratio),
                 *std::min_element(wall_ratio.begin(), wall_ratio.end()),
                 *std::max_element(wall_ratio.begin(), wall_ratio.end()), median(cpu_ratio));
    else
      fmt::print(" | |\n");
  }
};

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const int repetitions = argc > 2 ? std::atoi(argv[2]) : 5;
  bench::GrowthRows rows(argc > 3 ? argv[3] : nullptr);
  const Device& device = test_device();
  Fabric fabric;
  const Seconds knit = time_of([&] { fabric = sheet(wanted); });
  const std::vector<PlyPatch> patches = patches_of(fabric, -1);
  const double segments = double(fabric.report.segments);
  const FabricInput input{&fabric, 0, -1};
  fmt::print("{} {}, Embree {}, {} segments, {} mesh vertices\n\n", device.traits().name, device.traits().driver,
             RTC_VERSION_STRING, fabric.report.segments, fabric.mesh.position.size());
  fmt::print("| | wall, ms | CPU, ms | Wale / Embree, wall | CPU |\n| --- | --- | --- | --- | --- |\n");
  fmt::print("| knit: stitch, plies, cut | {:.4g} | {:.4g} | | |\n", 1e3 * knit.wall, 1e3 * knit.cpu);

  // Scenes of default or low quality take as long as one of high quality.
  Peer peers[kPeers] = {{"high quality", RTC_BUILD_QUALITY_HIGH, RTC_BUILD_QUALITY_HIGH, RTC_SCENE_FLAG_NONE},
                        {"dynamic, refit", RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_REFIT, RTC_SCENE_FLAG_DYNAMIC}};
  Row upload_row, tree_row, update_row, refit_row, commit_row[kPeers], build_row[kPeers], first_row,
      peer_first_row[kPeers];
  int64_t peer_bytes[kPeers] = {};
  const FabricWarp still(device, {&input, 1}, {0, 0, 0});
  const std::vector<float> points = still.points().read(device);
  build_ply_tree(device, patches, still.points());  // compiles the kernels
  size_t trace_bytes = 0;
  for (int k = 0; k < repetitions; ++k) {
    upload_row.add(time_of([&] { const FabricWarp warp(device, {&input, 1}, {0, 0, 0}); }), {});
    Seconds ours;
    {
      PlyTree tree;
      ours = time_of([&] { tree = build_ply_tree(device, patches, still.points()); });
      trace_bytes = tree.leaves.bytes() + tree.tree_bytes();
    }
    tree_row.add(ours, {});
    for (int i = 0; i < kPeers; ++i) {
      const Seconds theirs = peers[i].build(fabric, points);
      build_row[i].add(theirs, ours);
      peer_bytes[i] = peers[i].bytes;
      peers[i].clear();
    }
  }
  upload_row.print("warp: upload and first run", false);
  tree_row.print("leaves and tree", false);
  for (int i = 0; i < kPeers; ++i) build_row[i].print(fmt::format("Embree build, {}", peers[i].name), true);

  size_t shade_bytes = 0, update_bytes = 0;
  {
    FabricDevice moving = upload_fabrics(device, {&input, 1}, {0, 0, 0}, LocalStage::exact, true);
    shade_bytes = trace_bytes + moving.frames.bytes();
    update_bytes = moving.bytes;
    FabricTracer tracer(device, fabric, -1, LocalStage::exact, true);
    const BaseMesh flat = fabric.mesh;
    const dvec3 from(0.0007, 0.0003, 0.1), along(0, 0, -1);
    Ray ray;
    for (int a = 0; a < 3; ++a) ray.o[a] = float(from[a]), ray.d[a] = float(along[a]);
    double time = 0;
    for (int i = 0; i < kPeers; ++i) {
      peers[i].build(fabric, points);
      for (int k = -1; k < repetitions; ++k) {  // the first one is not counted
        wave(flat, time += 0.7, fabric.mesh);
        compute_normals(fabric.mesh);
        const MeshVertices mesh = mesh_vertices({&input, 1}, {0, 0, 0});
        const Seconds whole = time_of([&] { update_fabrics(device, moving, mesh.positions, mesh.normals); });
        const std::vector<float> moved = moving.warp->points().read(device);
        const Seconds theirs = peers[i].update(moved);
        const Seconds nodes = time_of([&] { refit(device, moving.tree); });
        // Once more, each to its first hit; the peer's scene is dirty again.
        const Seconds first = time_of([&] {
          compute_normals(fabric.mesh);
          const MeshVertices now = mesh_vertices({&input, 1}, {0, 0, 0});
          tracer.move(now.positions, now.normals);
          tracer.trace({ray});
        });
        Seconds peer_first = peers[i].update(moved);
        peer_first += time_of([&] { peers[i].hit(from, along); });
        if (k < 0) continue;
        commit_row[i].add(theirs, whole);
        update_row.add(whole, {});
        refit_row.add(nodes, {});
        first_row.add(first, {});
        peer_first_row[i].add(peer_first, first);
      }
      peers[i].clear();
    }
    fabric.mesh = flat;
  }
  update_row.print("update: warp, leaves and nodes", false);
  refit_row.print("of it leaves and nodes", false);
  for (int i = 0; i < kPeers; ++i) commit_row[i].print(fmt::format("Embree commit, {}", peers[i].name), true);
  first_row.print("new base mesh to first hit", false);
  for (int i = 0; i < kPeers; ++i)
    peer_first_row[i].print(fmt::format("Embree commit to first hit, {}", peers[i].name), true);
  fmt::print("\nbytes a segment: {:.1f} to trace, {:.1f} to shade too, {:.1f} to update too; Embree",
             double(trace_bytes) / segments, double(shade_bytes) / segments, double(update_bytes) / segments);
  for (int i = 0; i < kPeers; ++i)
    fmt::print("{} {:.1f} ({})", i ? "," : "", double(peer_bytes[i]) / segments, peers[i].name);
  fmt::print("\n");

  const auto add = [&](const char* form, const char* quantity, double cpu) {
    rows.add(fabric.report.segments, form, quantity, "CPU seconds", cpu);
  };
  // As a user of Embree would choose: the faster of its two scenes.
  const auto faster = [](const Row(&row)[kPeers]) { return std::min(median(row[0].cpu), median(row[1].cpu)); };
  add("stored", "knit", knit.cpu);
  add("stored", "build", median(tree_row.cpu));
  add("embree", "build", faster(build_row));
  add("stored", "update", median(update_row.cpu));
  add("embree", "update", faster(commit_row));
}
