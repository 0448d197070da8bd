// Rays of a render kept while it runs, and sent again: for benchmarks.
#include <algorithm>

#include "geom/error.h"
#include "host/wavefront.h"

namespace wale {
namespace {

// Of every slot, or of those of a batch in its order.
std::vector<w_float4> gathered(const std::vector<w_float4>& all, const std::vector<uint32_t>& slots) {
  std::vector<w_float4> out;
  out.reserve(slots.size());
  for (const uint32_t slot : slots) out.push_back(all[slot]);
  return out;
}

}  // namespace

void Wavefront::keep_rays(const WFrame& frame, RayKind kind, const Buffer<uint32_t>& list, uint32_t count_index,
                          uint32_t depth) {
  RayBatch batch;
  batch.kind = kind;
  batch.frame = frame;
  batch.depth = depth;
  batch.tiles = tiles_.read(device_);
  batch.tiles.resize(frame.paths / frame.samples_in_wave / kTilePixels);
  batch.slots = list.read(device_);
  batch.slots.resize(queue_counts_.read(device_)[count_index]);
  if (batch.slots.empty()) return;
  const bool shadow = kind == RayKind::shadow;
  batch.o = gathered((shadow ? shadow_o_ : ray_o_).read(device_), batch.slots);
  batch.l = gathered((shadow ? shadow_l_ : ray_l_).read(device_), batch.slots);
  batch.d = gathered((shadow ? shadow_d_ : ray_d_).read(device_), batch.slots);
  if (!shadow) batch.found = gathered(hit_.read(device_), batch.slots);
  record_->batches.push_back(std::move(batch));
}

void Wavefront::load(const RayBatch& batch) {
  const bool shadow = batch.kind == RayKind::shadow;
  if (shadow && !features_.lights) bug("replay: shadow rays in a wavefront without lights");
  const uint32_t most = *std::max_element(batch.slots.begin(), batch.slots.end());
  if (most >= pool_) bug("replay: slot {} of a pool of {}", most, pool_);
  const auto scatter = [&](Buffer<w_float4>& to, const std::vector<w_float4>& values) {
    std::vector<w_float4> all(most + 1, w_float4{0, 0, 0, 0});
    for (size_t i = 0; i < values.size(); ++i) all[batch.slots[i]] = values[i];
    to.write(device_, all);
  };
  scatter(shadow ? shadow_o_ : ray_o_, batch.o);
  scatter(shadow ? shadow_l_ : ray_l_, batch.l);
  scatter(shadow ? shadow_d_ : ray_d_, batch.d);
  // One kind of light for every ray: what arrives is 1 where nothing is in the way.
  if (shadow) {
    scatter(shadow_c_, std::vector<w_float4>(batch.slots.size(), w_float4{1, 1, 1, 0}));
    radiance_.fill(device_, w_float4{0, 0, 0, 0});
  }
  tiles_.write(device_, batch.tiles);
  (shadow ? shadow_list_ : active_[0]).write(device_, batch.slots);
  queue_counts_.write(device_, {uint32_t(batch.slots.size())});
  set_frame(batch.frame);
  device_.queue().finish();
}

double Wavefront::trace_loaded(const RayBatch& batch) {
  if (batch.kind == RayKind::shadow)
    launch_connect(kGenerated, batch.depth, batch.slots.size());
  else
    launch_intersect(active_[0], kGenerated, batch.depth, batch.slots.size());
  device_.queue().finish();
  const double seconds = device_seconds(pending_.back().event);
  pending_.clear();
  return seconds;
}

std::vector<w_float4> Wavefront::read_found(const RayBatch& batch) const {
  return gathered((batch.kind == RayKind::shadow ? radiance_ : hit_).read(device_), batch.slots);
}

}  // namespace wale
