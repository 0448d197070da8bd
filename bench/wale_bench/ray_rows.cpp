#include "bench/wale_bench/ray_rows.h"

#include <algorithm>
#include <cstring>

#include "shared/visits.h"

namespace wale::bench {
namespace {

// Least arithmetic of a visit, from kernels/geometry: a node's 16 boxes (w_node_hits: 6 multiply-adds, 7 minima and
// maxima, a comparison each), and the coarse test of a leaf's lanes (w_ply_lanes up to `near`).
constexpr double kNodeOperations = 16 * 20, kLeafOperations = W_LEAF_LANES * 55;

constexpr const char* kNames[] = {"primary", "bounce", "shadow"};

bool same(const std::vector<w_float4>& a, const std::vector<w_float4>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(w_float4)) == 0;
}

}  // namespace

std::string RayRow::name() const { return kNames[size_t(kind)]; }

RayReplay::RayReplay(const Device& device, const World& world, const SceneDevice& scene, const Features& features,
                     const RayRecord& record, uint32_t pool, bool opaque, const std::filesystem::path& kernel_dir)
    : device_(device),
      world_(world),
      scene_(scene),
      features_(features),
      record_(record),
      pool_(pool),
      opaque_(opaque),
      kernel_dir_(kernel_dir),
      wavefront_(device, scene, features, world.camera, pool, kernel_dir),
      found_(record.batches.size()) {
  for (const RayKind kind : {RayKind::primary, RayKind::bounce, RayKind::shadow})
    if (const uint64_t rays = record.rays(kind)) {
      rows_.emplace_back();
      rows_.back().kind = kind;
      rows_.back().attenuated = !opaque;
      rows_.back().rays = rays;
    }
}

RayRow& RayReplay::row(RayKind kind) {
  return *std::find_if(rows_.begin(), rows_.end(), [&](const RayRow& r) { return r.kind == kind; });
}

void RayReplay::repeat() {
  if (warm_)
    for (RayRow& r : rows_) r.device.push_back(0), r.cpu.push_back(0);
  for (size_t i = 0; i < record_.batches.size(); ++i) {
    const RayBatch& batch = record_.batches[i];
    wavefront_.load(batch);
    const Stopwatch watch;
    const double seconds = wavefront_.trace_loaded(batch);
    const double cpu = watch.seconds().cpu;
    RayRow& r = row(batch.kind);
    if (warm_) r.device.back() += seconds, r.cpu.back() += cpu;
    std::vector<w_float4> found = wavefront_.read_found(batch);
    if (found_[i].empty()) {
      // What the render met, where it sent the very same rays against the very same plies.
      if (!opaque_ && batch.kind != RayKind::shadow && !same(found, batch.found)) r.repeats = false;
      found_[i] = std::move(found);
    } else if (!same(found, found_[i])) {
      r.repeats = false;
    }
  }
  warm_ = true;
}

void RayReplay::count_visits() {
  Device counting = device_;
  counting.traits().build_options += " -DW_COUNT_VISITS";
  Wavefront wavefront(counting, scene_, features_, world_.camera, pool_, kernel_dir_);
  const PlyTree& tree = scene_.fabric().tree;
  const double node_bytes = double(tree.ray_nodes().bytes()) / double(std::max<size_t>(1, tree.node_count));
  const double leaf_bytes = double(tree.leaves.bytes()) / double(std::max<size_t>(1, tree.leaf_offset.size()));
  for (const RayBatch& batch : record_.batches) {
    wavefront.load(batch);
    const auto before = scene_.read_events();
    wavefront.trace_loaded(batch);
    const auto after = scene_.read_events();
    const auto visits = [&](uint32_t what) { return double(after[what] - before[what]); };  // wraps as the counter does
    RayRow& r = row(batch.kind);
    r.nodes += visits(W_VISIT_NODE) / double(r.rays);
    r.leaves += visits(W_VISIT_LEAF) / double(r.rays);
    r.bytes += visits(W_VISIT_TRIANGLES) * W_TRI_LEAF_WORDS * 4 / double(r.rays);
  }
  for (RayRow& r : rows_) {
    r.bytes += r.nodes * node_bytes + r.leaves * leaf_bytes;
    r.operations = r.nodes * kNodeOperations + r.leaves * kLeafOperations;
  }
}

std::vector<RayRow> RayReplay::finish(size_t samples) {
  count_visits();
  const Oracle oracle(device_, world_, scene_.fabric(), opaque_);
  for (RayRow& r : rows_) {
    std::vector<CheckedRay> rays;
    for (size_t i = 0; i < record_.batches.size(); ++i) {
      const RayBatch& batch = record_.batches[i];
      if (batch.kind != r.kind) continue;
      // Each batch in proportion to its rays.
      const size_t share = size_t(double(samples) * double(batch.slots.size()) / double(r.rays) + 0.5);
      if (share == 0) continue;
      const auto some = oracle.sample(batch, found_[i], share);
      rays.insert(rays.end(), some.begin(), some.end());
    }
    r.agreement = oracle.check(rays);
  }
  return rows_;
}

}  // namespace wale::bench
