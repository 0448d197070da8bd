#include "host/render.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "geom/error.h"
#include "host/device_fault.h"
#include "host/driver_crash.h"
#include "host/error_goal.h"
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

// Pixels of the film that are read at once.
constexpr uint32_t kReadPixels = 1 << 16;

// Shares of a wave: less than the smallest is not worth starting before the time is up. Waves are planned for a part of
// what is left, as a small wave takes longer per path than the one before, by which it is planned.
constexpr double kSmallestWave = 1.0 / 32, kPlannedShare = 0.8;

// One render, shared.
class Job {
 public:
  Job(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
      const RenderOptions& options, const std::function<void(double)>& progress)
      : devices_(devices), options_(options), progress_(progress), frame_(frame_of(world, integrator)) {
    pixels_ = uint32_t(padded_pixels(world.camera.width, world.camera.height));
    waves_.resize(devices.size());
    result_.devices.resize(devices.size());
    seconds_per_path_.resize(devices.size());
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
    block_pixels_ = options.error > 0 ? kTilePixels : block_size(pool, pixels_, devices.size());
    const uint32_t blocks = (pixels_ + block_pixels_ - 1) / block_pixels_;
    list_ = std::make_unique<WorkList>(blocks, options.error > 0 ? 0 : uint32_t(options.spp), uint32_t(devices.size()),
                                       options.seconds > 0);
  }

  Rendered run(const World& world) {
    if (options_.ready) options_.ready();
    start_ = Clock::now();
    if (options_.error > 0)
      work_towards_goal();
    else
      work_on_all();
    result_.seconds = since(start_);
    result_.stopped |= !list_->complete();
    for (size_t d = 0; d < waves_.size(); ++d) {
      DeviceShare& share = result_.devices[d];
      share.counts = waves_[d]->counts();
      share.pool = waves_[d]->pool();
      share.path_bytes = waves_[d]->bytes();
      result_.counts += share.counts;
    }
    const double origin[3] = {world.origin.x, world.origin.y, world.origin.z};
    const FilmSums film = gather(world.camera.width, world.camera.height);
    result_.reached = reached_by(film);
    result_.image = develop(film, origin);
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

  std::vector<uint32_t> tiles_of(const WorkUnit& unit) const {
    std::vector<uint32_t> tiles;
    for (const uint32_t block : unit.blocks)
      for (uint32_t i = 0; i < pixels_in(block, 1) / kTilePixels; ++i)
        tiles.push_back(block * (block_pixels_ / kTilePixels) + i);
    return tiles;
  }

  void work_on_all() {
    on_every_device([&](uint32_t d) {
      try {
        work(d);
      } catch (...) {
        list_->stop();  // the others do not wait for this one's blocks
        throw;
      }
    });
  }

  // Pass after pass: all tiles that are open are brought to the next checkpoint and judged there.
  void work_towards_goal() {
    ErrorGoal goal(options_.error, uint32_t(options_.spp), pixels_ / kTilePixels);
    while (!goal.open().empty()) {
      expected_ = double(list_->done()) + goal.expected();
      list_->ask(goal.open(), goal.checkpoint());
      work_on_all();
      if (list_->stopped()) {
        result_.stopped = true;
        return;
      }
      if (!floor_) floor_ = error_floor(measure(goal.open(), tile_luminance));
      goal.judge(measure(goal.open(), [&](auto sums) { return tile_error(sums, *floor_); }));
    }
  }

  // A number of each of these tiles, from its sums.
  std::vector<double> measure(const std::vector<uint32_t>& tiles,
                              const std::function<double(std::span<const w_float4>)>& of) const {
    std::vector<double> values;
    for (size_t i = 0; i < tiles.size();) {
      const size_t end = run_end(i, tiles.size(), [&](size_t k) { return tiles[k]; });
      const PixelSums sums =
          waves_[*list_->owner(tiles[i])]->film().read(tiles[i] * kTilePixels, uint32_t(end - i) * kTilePixels);
      constexpr size_t kValues = kTilePixels * kScrambles;
      for (size_t k = 0; k < end - i; ++k) values.push_back(of(std::span(sums.radiance).subspan(k * kValues, kValues)));
      i = end;
    }
    return values;
  }

  // End of the run of blocks that lie one behind the other on one device, from entry i of a list of blocks on.
  size_t run_end(size_t i, size_t count, const std::function<uint32_t(size_t)>& block) const {
    const size_t most = i + kReadPixels / block_pixels_ + 1;
    size_t end = i + 1;
    while (end < std::min(count, most) && block(end) == block(end - 1) + 1 &&
           list_->owner(block(end)) == list_->owner(block(i)))
      ++end;
    return end;
  }

  // Paths of the next wave: a full one, until what is left of the time is shorter; 0 when it is up.
  uint32_t wave_paths(uint32_t pool, double seconds_per_path) const {
    if (options_.seconds <= 0 || !list_->all_begun()) return pool;
    const double left = options_.seconds - since(start_);
    if (left <= 0) return 0;
    if (seconds_per_path == 0) return pool;
    const double paths = kPlannedShare * left / seconds_per_path;
    return paths < kSmallestWave * pool ? 0 : uint32_t(std::min(double(pool), paths));
  }

  void work(uint32_t d) {
    const DriverCall guard;
    Wavefront& wave = *waves_[d];
    DeviceShare& share = result_.devices[d];
    while (true) {
      const uint32_t paths = wave_paths(wave.pool(), seconds_per_path_[d]);
      if (paths == 0) list_->stop();
      const auto unit = list_->take(d, paths, block_pixels_, kScrambles);
      if (!unit) break;
      const auto taken = Clock::now();
      for (const auto& [block, owner] : unit->elsewhere) {
        const uint32_t first = block * block_pixels_;
        wave.film().write(first, waves_[owner]->film().read(first, pixels_in(block, 1)));
        ++share.moved_blocks;
      }
      const std::vector<uint32_t> tiles = tiles_of(*unit);
      wave.trace(frame_, tiles, unit->first_sample, unit->samples);
      list_->finish(*unit);
      const double seconds = since(taken);
      share.busy_seconds += seconds;
      seconds_per_path_[d] = seconds / (double(tiles.size()) * kTilePixels * unit->samples);
      ++share.units;
      report();
    }
  }

  void report() {
    const double elapsed = since(start_);
    if (stop_requested()) list_->stop();
    const std::lock_guard lock(mutex_);
    if (result_.first_sample_seconds == 0) result_.first_sample_seconds = elapsed;
    const double all = options_.error > 0 ? expected_ : double(list_->asked());
    // What a goal takes is guessed anew in every pass; the bar does not go back.
    fraction_ = std::max(fraction_, std::min(1.0, double(list_->done()) / all));
    if (options_.seconds > 0) fraction_ = std::max(fraction_, std::min(1.0, elapsed / options_.seconds));
    if (progress_) progress_(fraction_);
  }

  FilmSums gather(int width, int height) {
    const size_t pixels = size_t(width) * size_t(height);
    FilmSums film{width, height, std::vector<w_float4>(pixels * kScrambles, w_float4{0, 0, 0, 0}), {}, {}};
    if (options_.aovs) {
      film.aov.assign(pixels * 4, w_float4{0, 0, 0, 0});
      film.ply.assign(pixels, W_NONE);
    }
    const size_t blocks = (pixels_ + block_pixels_ - 1) / block_pixels_;
    for (size_t i = 0; i < blocks;) {
      const size_t end = run_end(i, blocks, [](size_t k) { return uint32_t(k); });
      const uint32_t first = uint32_t(i) * block_pixels_;
      if (const auto owner = list_->owner(uint32_t(i)))
        scatter(waves_[*owner]->film().read(first, pixels_in(uint32_t(i), uint32_t(end - i))), first, film);
      i = end;
    }
    return film;
  }

  Reached reached_by(const FilmSums& film) const {
    const uint32_t tiles = pixels_ / kTilePixels;
    std::vector<double> errors(tiles), luminances(tiles);
    std::vector<uint32_t> samples(tiles);
    if (!floor_)
      for (uint32_t t = 0; t < tiles; ++t) luminances[t] = tile_luminance(radiance_of_tile(film, t));
    const double floor = floor_ ? *floor_ : error_floor(luminances);
    for (uint32_t t = 0; t < tiles; ++t) {
      errors[t] = tile_error(radiance_of_tile(film, t), floor);
      samples[t] = list_->samples(t / (block_pixels_ / kTilePixels));
    }
    return reached(errors, samples, options_.error, floor);
  }

  std::span<const RenderDevice> devices_;
  const RenderOptions& options_;
  const std::function<void(double)>& progress_;
  WFrame frame_;
  uint32_t pixels_ = 0, block_pixels_ = kTilePixels;
  std::vector<double> seconds_per_path_;  ///< of each device's last wave
  std::optional<double> floor_;           ///< of errors, since the first checkpoint
  double expected_ = 0, fraction_ = 0;    ///< samples that the goal will take; progress
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
