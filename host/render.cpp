#include "host/render.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "geom/error.h"
#include "host/device_fault.h"
#include "host/driver_crash.h"
#include "host/stop.h"
#include "host/work_list.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

WFrame frame_of(const World& world, const IntegratorScene& integrator) {
  WFrame frame{};
  frame.seed = integrator.seed;
  frame.max_depth = uint32_t(integrator.max_depth);
  frame.roulette_depth = uint32_t(integrator.russian_roulette_depth);
  frame.light_sampling = integrator.light_sampling == "mis" ? 0 : integrator.light_sampling == "light" ? 1 : 2;
  frame.opaque_shadows = integrator.ply_shadows == "opaque";
  frame.lights = uint32_t(world.lights.lights.size());
  frame.spheres = uint32_t(world.spheres.size());
  return frame;
}

// Blocks small enough to be shared fairly: each device makes waves of as many as fill its pool.
uint32_t block_size(uint32_t smallest_pool, uint64_t pixels, size_t devices) {
  const uint64_t tiles = std::min<uint64_t>(smallest_pool / kScrambles, pixels / (32 * devices)) / 64;
  return uint32_t(std::max<uint64_t>(1, tiles)) * 64;
}

// One render, shared.
class Job {
 public:
  Job(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
      const RenderOptions& options, const std::function<void(double)>& progress)
      : devices_(devices), options_(options), progress_(progress), frame_(frame_of(world, integrator)) {
    pixels_ = uint32_t(padded_pixels(world.camera.width, world.camera.height));
    waves_.resize(devices.size());
    result_.devices.resize(devices.size());
    const auto start = Clock::now();
    on_every_device([&](uint32_t d) {
      const Device& device = *devices[d].device;
      const Features features = analyse(world, integrator, options.aovs, device.traits());
      const uint32_t pool = pool_of(device.traits(), integrator, options);
      waves_[d] =
          std::make_unique<Wavefront>(device, *devices[d].scene, features, world.camera, pool, options.kernel_dir);
      waves_[d]->record(options.record);
      waves_[d]->count_cpu_time(options.count_cpu_time);
    });
    result_.program_seconds = since(start);
    uint32_t pool = ~0u;
    for (const auto& wave : waves_) pool = std::min(pool, wave->pool());
    block_pixels_ = block_size(pool, pixels_, devices.size());
    list_ = std::make_unique<WorkList>((pixels_ + block_pixels_ - 1) / block_pixels_, uint32_t(options.spp),
                                       uint32_t(devices.size()));
  }

  Rendered run(const World& world) {
    if (options_.ready) options_.ready();
    start_ = Clock::now();
    on_every_device([&](uint32_t d) {
      try {
        work(d);
      } catch (...) {
        list_->stop();  // the others do not wait for this one's blocks
        throw;
      }
    });
    result_.seconds = since(start_);
    result_.samples = int(list_->most_samples());
    result_.stopped = !list_->complete();
    for (size_t d = 0; d < waves_.size(); ++d) {
      DeviceShare& share = result_.devices[d];
      share.counts = waves_[d]->counts();
      share.pool = waves_[d]->pool();
      share.path_bytes = waves_[d]->bytes();
      result_.counts += share.counts;
    }
    const double origin[3] = {world.origin.x, world.origin.y, world.origin.z};
    result_.image = develop(gather(world.camera.width, world.camera.height), origin);
    return std::move(result_);
  }

 private:
  // One thread per device; the first error is thrown when all are done.
  template <typename Work>
  void on_every_device(const Work& work) {
    const auto guarded = [&](uint32_t d) {
      try {
        work(d);
      } catch (const cl::Error& e) {
        device_error("device {} ({}): {}", devices_[d].device->number(), devices_[d].device->traits().name,
                     opencl_fault(e));
      }
    };
    std::vector<std::future<void>> others;
    for (uint32_t d = 1; d < devices_.size(); ++d) others.push_back(std::async(std::launch::async, guarded, d));
    std::exception_ptr error;
    const auto keep_first = [&](const auto& call) {
      try {
        call();
      } catch (...) {
        if (!error) error = std::current_exception();
      }
    };
    keep_first([&] { guarded(0); });
    for (auto& other : others) keep_first([&] { other.get(); });
    if (error) std::rethrow_exception(error);
  }

  uint32_t pixels_in(uint32_t first_block, uint32_t blocks) const {
    const uint64_t first = uint64_t(first_block) * block_pixels_;
    return uint32_t(std::min<uint64_t>(uint64_t(blocks) * block_pixels_, pixels_ - first));
  }

  void work(uint32_t d) {
    const DriverCall guard;
    Wavefront& wave = *waves_[d];
    DeviceShare& share = result_.devices[d];
    while (const auto unit = list_->take(d, wave.pool(), block_pixels_, kScrambles)) {
      const auto taken = Clock::now();
      for (const auto& [block, owner] : unit->elsewhere) {
        const uint32_t first = block * block_pixels_;
        wave.film().write(first, waves_[owner]->film().read(first, pixels_in(block, 1)));
        ++share.moved_blocks;
      }
      wave.trace(frame_, unit->first_block * block_pixels_, pixels_in(unit->first_block, unit->blocks),
                 unit->first_sample, unit->samples);
      list_->finish(*unit);
      share.busy_seconds += since(taken);
      ++share.units;
      report();
    }
  }

  void report() {
    const double done = list_->fraction(), elapsed = since(start_);
    const bool over = options_.seconds > 0 && elapsed >= options_.seconds;
    if (stop_requested() || over) list_->stop();
    const std::lock_guard lock(mutex_);
    if (result_.first_sample_seconds == 0) result_.first_sample_seconds = elapsed;
    if (progress_) progress_(options_.seconds > 0 ? std::max(done, std::min(1.0, elapsed / options_.seconds)) : done);
  }

  FilmSums gather(int width, int height) {
    const size_t pixels = size_t(width) * size_t(height);
    FilmSums film{width, height, std::vector<w_float4>(pixels * kScrambles, w_float4{0, 0, 0, 0}), {}, {}};
    if (options_.aovs) {
      film.aov.assign(pixels * 4, w_float4{0, 0, 0, 0});
      film.ply.assign(pixels, W_NONE);
    }
    for (uint32_t block = 0; uint64_t(block) * block_pixels_ < pixels_; ++block)
      if (const auto owner = list_->owner(block))
        scatter(waves_[*owner]->film().read(block * block_pixels_, pixels_in(block, 1)), block * block_pixels_, film);
    return film;
  }

  std::span<const RenderDevice> devices_;
  const RenderOptions& options_;
  const std::function<void(double)>& progress_;
  WFrame frame_;
  uint32_t pixels_ = 0, block_pixels_ = 64;
  std::vector<std::unique_ptr<Wavefront>> waves_;
  std::unique_ptr<WorkList> list_;
  std::mutex mutex_;
  Rendered result_;
  Clock::time_point start_;
};

}  // namespace

uint32_t pool_of(const DeviceTraits& traits, const IntegratorScene& integrator, const RenderOptions& options) {
  return options.pool ? options.pool : integrator.pool ? integrator.pool : traits.pool;
}

Rendered render(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double)>& progress) {
  return Job(devices, world, integrator, options, progress).run(world);
}

Rendered render(const Device& device, const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double)>& progress) {
  const RenderDevice one{&device, &scene};
  return render(std::span(&one, 1), world, integrator, options, progress);
}

}  // namespace wale
