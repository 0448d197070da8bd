// The same segments and rays through Intel Embree's round linear curves and through Wale's kernels, in one process,
// interleaved: embree_peer [segments] [rays per side] [repetitions]. Prints medians of paired ratios of CPU time over
// all threads (wall times of two programs on a shared machine say little), hit agreement, bytes and build times.
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>

#include "bench/cloth_rays.h"
#include "bench/peers/embree_device.h"

namespace {

using namespace wale;
using namespace wale::test;

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

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
    const double start = cpu_seconds();
    rtcCommitScene(scene_);
    build_seconds = cpu_seconds() - start;
    bytes = embree_bytes;
    radius_ = radius;
  }
  ~Peer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// CPU seconds; `hits` receives distances, or 1e30.
  double time(const std::vector<Ray>& rays, bool any, bool packets, std::vector<float>& hits) const {
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
    const double start = cpu_seconds();
    std::thread other(work);
    work();
    other.join();
    return cpu_seconds() - start;
  }

  double build_seconds = 0;
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

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  const uint32_t side = argc > 2 ? uint32_t(std::atoi(argv[2])) : 512;
  const int repetitions = argc > 3 ? std::atoi(argv[3]) : 5;
  const Strands cloth = bench::cloth(wanted);
  const Device& device = test_device();
  const std::string options = fmt::format("-DW_LANES={}", device.traits().lanes);
  Tracer tracer(device, cloth);
  const Peer peer(cloth);
  const double segments = double(cloth.segments());
  fmt::print("{} {}, Embree {}\n", device.traits().name, device.traits().driver, RTC_VERSION_STRING);
  fmt::print("segments {}\n\n| | Wale | Embree round | ratio |\n| --- | --- | --- | --- |\n", cloth.segments());
  const double bytes = double(tracer.tree().leaves.bytes() + tracer.tree().tree_bytes());
  fmt::print("| bytes a segment | {:.1f} | {:.1f} | {:.2f} |\n", bytes / segments, double(peer.bytes) / segments,
             bytes / double(peer.bytes));

  const bench::ClothRays rays = bench::cloth_rays(tracer, side, options);
  struct Kind {
    const char* name;
    const std::vector<Ray>* rays;
    const char* kernel;
    bool any;
  };
  std::vector<Kind> kinds = {{"primary, one by one", &rays.primary, "closest", false},
                             {"shadow", &rays.shadow, "occluded", true},
                             {"bounce", &rays.bounce, "closest", false}};
  // As the renderer sends them, where the device's vectors are wide enough.
  if (device.traits().lanes == W_NODE_WIDTH)
    kinds.insert(kinds.begin(), {"primary", &rays.primary, "closest_packets", false});
  for (const Kind& kind : kinds) {
    std::vector<double> ours, theirs, ratios;
    std::vector<float> hits, hits16;
    tracer.time(*kind.rays, options, kind.kernel);
    peer.time(*kind.rays, kind.any, false, hits);
    for (int k = 0; k < repetitions; ++k) {
      const double one = peer.time(*kind.rays, kind.any, false, hits);
      const double a = tracer.time(*kind.rays, options, kind.kernel);
      const double sixteen = peer.time(*kind.rays, kind.any, true, hits16);
      const double best = std::min(one, sixteen);
      ours.push_back(a);
      theirs.push_back(best);
      ratios.push_back(best / a);
    }
    const std::vector<Hit> found = tracer.trace(*kind.rays, options);
    size_t agree = 0;
    for (size_t i = 0; i < found.size(); ++i)
      agree += (kind.any ? found[i].occluded != 0 : found[i].kind != W_HIT_NONE) == (hits[i] < 1e29f);
    const double n = double(kind.rays->size());
    fmt::print("| {}, Mrays per CPU-second | {:.2f} | {:.2f} | {:.2f} ({:.2f} to {:.2f}) |\n", kind.name,
               n / median(ours) * 1e-6, n / median(theirs) * 1e-6, median(ratios),
               *std::min_element(ratios.begin(), ratios.end()), *std::max_element(ratios.begin(), ratios.end()));
    fmt::print("| {}, hit or miss agrees | {:.3f} % | | |\n", kind.name, 100.0 * double(agree) / n);
  }
}
