// The same segments and rays through Intel Embree's round linear curves and through Wale's kernels, in one process,
// interleaved: embree_peer [segments] [rays per side] [repetitions] [rows.csv]. Prints medians of paired ratios of CPU
// time over all threads, and of wall time (which says little on a shared machine), hit agreement and bytes; appends the
// figures to the rows' file. Fails where hits do not agree or a median is below its goal.
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "bench/cloth_rays.h"
#include "bench/growth_rows.h"
#include "bench/peers/embree_device.h"
#include "bench/wale_bench/clock.h"
#include "host/materials.h"

namespace {

using namespace wale;
using namespace wale::test;

using bench::median;
using bench::Seconds;
using bench::Stopwatch;

std::atomic<int64_t> embree_bytes{0};

/// The peer: one scene of round linear curves, a curve segment per ply segment, neighbours flagged.
class Peer {
 public:
  explicit Peer(const Strands& cloth) {
    device_ = bench::open_embree(embree_bytes);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const size_t vertices = cloth.positions.size() / 3, segments = cloth.segments();
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, vertices));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, 4, segments));
    auto* flags = static_cast<uint8_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR, 1, segments));
    size_t n = 0;
    for (const PlyPatch& patch : cloth.patches)
      for (uint32_t ply = 0; ply < patch.plies; ++ply)
        for (uint32_t k = 0; k < patch.intervals; ++k) {
          const uint32_t place = patch.first + k;
          indices[n] = patch.first_vertex + ply * patch.count + place;
          flags[n++] = uint8_t((place > 0 ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0) |
                               (place + 2 < patch.count ? RTC_CURVE_FLAG_NEIGHBOR_RIGHT : 0));
        }
    const float radius = cloth.patches.front().radius;
    for (size_t i = 0; i < vertices; ++i) {
      std::copy_n(cloth.positions.data() + 3 * i, 3, points + 4 * i);
      points[4 * i + 3] = radius;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    bytes = embree_bytes;
    radius_ = radius;
  }
  ~Peer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// `hits` receives distances, or 1e30.
  Seconds time(const std::vector<Ray>& rays, bool any, bool packets, std::vector<float>& hits) const {
    hits.resize(rays.size());
    std::atomic<size_t> next{0};
    const auto work = [&] {
      _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
      _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
      constexpr size_t kChunk = 4096;
      for (size_t begin; (begin = next.fetch_add(kChunk)) < rays.size();) {
        const size_t end = std::min(rays.size(), begin + kChunk);
        if (packets)
          for (size_t i = begin; i < end; i += 16) trace16(rays, i, std::min(end, i + 16), any, hits);
        else
          for (size_t i = begin; i < end; ++i) hits[i] = trace1(rays[i], any);
      }
    };
    const Stopwatch watch;
    std::thread other(work);
    work();
    other.join();
    return watch.seconds();
  }

  int64_t bytes = 0;

 private:
  /// Rays that leave a ply start a little off it, as a user of Embree would start them.
  float near(const Ray& ray) const { return ray.skip == W_NONE ? 0.0f : 0.02f * radius_; }

  float trace1(const Ray& ray, bool any) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit r{};
    r.ray.org_x = ray.o[0] + ray.l[0];
    r.ray.org_y = ray.o[1] + ray.l[1];
    r.ray.org_z = ray.o[2] + ray.l[2];
    r.ray.dir_x = ray.d[0];
    r.ray.dir_y = ray.d[1];
    r.ray.dir_z = ray.d[2];
    r.ray.tnear = near(ray);
    r.ray.tfar = ray.tmax;
    r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    if (any) {
      rtcOccluded1(scene_, &context, &r.ray);
      return r.ray.tfar < 0 ? 0.0f : 1e30f;
    }
    rtcIntersect1(scene_, &context, &r);
    return r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? 1e30f : r.ray.tfar;
  }

  void trace16(const std::vector<Ray>& rays, size_t begin, size_t end, bool any, std::vector<float>& hits) const {
    alignas(64) int valid[16];
    RTCRayHit16 r;
    for (size_t k = 0; k < 16; ++k) {
      valid[k] = begin + k < end ? -1 : 0;
      const Ray& ray = rays[std::min(begin + k, end - 1)];
      r.ray.org_x[k] = ray.o[0] + ray.l[0];
      r.ray.org_y[k] = ray.o[1] + ray.l[1];
      r.ray.org_z[k] = ray.o[2] + ray.l[2];
      r.ray.dir_x[k] = ray.d[0];
      r.ray.dir_y[k] = ray.d[1];
      r.ray.dir_z[k] = ray.d[2];
      r.ray.tnear[k] = near(ray);
      r.ray.tfar[k] = ray.tmax;
      r.ray.mask[k] = ~0u;
      r.ray.flags[k] = 0;
      r.ray.time[k] = 0;
      r.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (any)
      rtcOccluded16(valid, scene_, &context, &r.ray);
    else
      rtcIntersect16(valid, scene_, &context, &r);
    for (size_t k = begin; k < end; ++k) {
      const size_t lane = k - begin;
      if (any)
        hits[k] = r.ray.tfar[lane] < 0 ? 0.0f : 1e30f;
      else
        hits[k] = r.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID ? 1e30f : r.ray.tfar[lane];
    }
  }

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  float radius_ = 0;
};

struct Kind {
  const char* name;
  const std::vector<Ray>* rays;
  const char* kernel;
  bool any, attenuated;
  double goal = 0;  // least ratio up to 1M segments; kGoal beyond
};

struct Result {
  std::vector<double> ours, theirs, ratio, wall_ratio;
  std::vector<float> embree_hits;
};

/// Embree's time is the shorter of its one ray at a time and its sixteen, in each repetition.
Result compare(Tracer& tracer, const Peer& peer, const Kind& kind, const std::string& options, int repetitions) {
  Result out;
  std::vector<float> hits16;
  for (int k = -1; k < repetitions; ++k) {  // the first one is not counted
    const Seconds one = peer.time(*kind.rays, kind.any, false, out.embree_hits);
    Seconds ours;
    ours.cpu = tracer.time(*kind.rays, options, kind.kernel, &ours.wall);
    const Seconds sixteen = peer.time(*kind.rays, kind.any, true, hits16);
    if (k < 0) continue;
    out.ours.push_back(ours.cpu);
    out.theirs.push_back(std::min(one.cpu, sixteen.cpu));
    out.ratio.push_back(out.theirs.back() / ours.cpu);
    out.wall_ratio.push_back(std::min(one.wall, sixteen.wall) / ours.wall);
  }
  return out;
}

/// Least ratio of the kinds that have a goal, at any size.
constexpr double kGoal = 1.8;

/// Least share of rays for which both agree whether they hit, in percent: fewer, and the speeds are not of one task.
constexpr double kAgreement = 99.9;

/// Prints them; false when too few agree.
bool print_hits(const Kind& kind, const std::vector<Hit>& found, const std::vector<float>& embree) {
  size_t agree = 0, ours = 0, theirs = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    const bool a = kind.any ? found[i].occluded != 0 : found[i].kind != W_HIT_NONE, b = embree[i] < 1e29f;
    ours += a;
    theirs += b;
    agree += a == b;
  }
  const double share = 100.0 / double(found.size());
  if (kind.attenuated)  // Embree's plies are opaque
    fmt::print("| {}, stopped | {:.3f} % | {:.3f} % | |\n", kind.name, share * double(ours), share * double(theirs));
  else
    fmt::print("| {}, hit or miss agrees | {:.3f} % | | |\n", kind.name, share * double(agree));
  return kind.attenuated || share * double(agree) >= kAgreement;
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 512;
  const int repetitions = argc > 3 ? std::atoi(argv[3]) : 5;
  bench::GrowthRows rows(argc > 4 ? argv[4] : nullptr);
  Strands cloth = bench::cloth(wanted);
  const Device& device = test_device();
  const std::string options = fmt::format("-DW_LANES={}", device.traits().lanes);
  Tracer tracer(device, cloth);
  PlyAppearance cotton;
  cotton.preset = "cotton";
  for (PlyPatch& patch : cloth.patches) patch.tau = ply_material(cotton).tau_e;
  Tracer attenuated(device, cloth);
  const Peer peer(cloth);
  const size_t segments = cloth.segments();
  fmt::print("{} {}, Embree {}\n", device.traits().name, device.traits().driver, RTC_VERSION_STRING);
  fmt::print("segments {}\n\n| | Wale | Embree round | ratio | wall |\n| --- | --- | --- | --- | --- |\n", segments);
  const double bytes = double(tracer.tree().leaves.bytes() + tracer.tree().tree_bytes()) / double(segments);
  const double peer_bytes = double(peer.bytes) / double(segments);
  fmt::print("| bytes a segment | {:.1f} | {:.1f} | {:.2f} | |\n", bytes, peer_bytes, bytes / peer_bytes);
  rows.add(segments, "stored", "memory to trace", "bytes a segment", bytes);
  rows.add(segments, "embree", "memory to trace", "bytes a segment", peer_bytes);

  const bench::ClothRays rays = bench::cloth_rays(tracer, side, options);
  // Embree has no rays that pass through: it sends the same rays against the same plies, opaque.
  std::vector<Kind> kinds = {{"primary, one by one", &rays.primary, "closest", false, false},
                             {"shadow", &rays.shadow, "occluded", true, false, 2.5},
                             {"shadow, attenuated", &rays.shadow, "occluded", true, true},
                             {"bounce", &rays.bounce, "closest", false, false, 2.3}};
  // As the renderer sends them, where the device's vectors are wide enough.
  if (device.traits().lanes == W_NODE_WIDTH)
    kinds.insert(kinds.begin(), {"primary", &rays.primary, "closest_packets", false, false, 2.2});
  bool agree = true, reached = true;
  for (const Kind& kind : kinds) {
    Tracer& against = kind.attenuated ? attenuated : tracer;
    const Result r = compare(against, peer, kind, options, repetitions);
    const double mega = double(kind.rays->size()) * 1e-6, ours = mega / median(r.ours),
                 theirs = mega / median(r.theirs);
    const auto [least, most] = std::minmax_element(r.ratio.begin(), r.ratio.end());
    fmt::print("| {}, Mrays per CPU-second | {:.2f} | {:.2f} | {:.2f} ({:.2f} to {:.2f}) | {:.2f} |\n", kind.name, ours,
               theirs, median(r.ratio), *least, *most, median(r.wall_ratio));
    for (const auto& [form, speed] : {std::pair("stored", ours), std::pair("embree", theirs)})
      rows.add(segments, form, "speed, " + std::string(kind.name), "million rays a CPU second", speed);
    const double goal = kind.goal == 0 ? 0 : segments > 1.1e6 ? kGoal : kind.goal;
    if (median(r.ratio) < goal) {
      fmt::print("| {}: below its goal of {} | | | |\n", kind.name, goal);
      reached = false;
    }
    agree &= print_hits(kind, against.trace(*kind.rays, options), r.embree_hits);
  }
  return agree && reached ? 0 : 1;
}
