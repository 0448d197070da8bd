#include "host/live_scene.h"

#include <chrono>
#include <future>

#include "host/knit_fabrics.h"
#include "host/memory_needs.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

LiveScene::LiveScene(std::span<const Device> devices, const Loaders& loaders, const Options& options)
    : devices_(devices), loaders_(loaders), options_(options) {}

Redone LiveScene::apply(const Scene& scene, const BuildProgress& progress) {
  Redone redone;
  auto start = Clock::now();
  if (most_segments_ > 0) refuse_more_segments(scene, loaders_, &world_, most_segments_);
  World next = build_world(scene, loaders_, progress, {true, options_.editable, &world_});
  redone.host_seconds = since(start);
  start = Clock::now();
  std::vector<std::unique_ptr<SceneDevice>> uploaded(devices_.size());
  try {
    for (const Device& device : devices_) {
      const DeviceTraits& traits = device.traits();
      const Features features = features_of(traits, next, scene.integrator, options_.render);
      require_memory(device, memory_needs(next, features, pool_of(traits, scene.integrator, options_.render), traits));
    }
    // At the same time: each device warps, packs and builds its own tree, as its rounding may be its own.
    const auto policy = devices_.size() > 1 ? std::launch::async : std::launch::deferred;
    std::vector<std::future<void>> uploads;
    for (size_t d = 0; d < devices_.size(); ++d)
      uploads.push_back(std::async(policy, [&, d] {
        const SceneDevice* before = on_device_.empty() ? nullptr : on_device_[d].get();
        uploaded[d] = std::make_unique<SceneDevice>(devices_[d], next, before, SceneDeviceOptions{});
      }));
    std::exception_ptr failed;
    for (auto& upload : uploads) {
      try {
        upload.get();
      } catch (...) {
        if (!failed) failed = std::current_exception();
      }
    }
    if (failed) std::rethrow_exception(failed);
  } catch (...) {
    give_back_fabrics(next, world_);
    throw;
  }
  for (const Knitting& made : next.knittings) {
    const auto same = [&](const Knitting& other) { return other.number == made.number; };
    redone.knitted += std::none_of(world_.knittings.begin(), world_.knittings.end(), same);
  }
  redone.fabrics = !uploaded.front()->shares_fabrics();
  redone.moved = uploaded.front()->moved_fabrics();
  redone.device_seconds = since(start);
  scene_ = scene;
  world_ = std::move(next);
  on_device_ = std::move(uploaded);
  list_.clear();
  for (size_t d = 0; d < devices_.size(); ++d) list_.push_back({&devices_[d], on_device_[d].get()});
  return redone;
}

}  // namespace wale
