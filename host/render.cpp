#include "host/render.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <future>
#include <numeric>

#include "geom/error.h"
#include "host/device_fault.h"
#include "host/driver_crash.h"
#include "host/error_goal.h"
#include "host/shared_film.h"
#include "host/stop.h"
#include "host/work_list.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Blocks small enough to be shared fairly: each device makes waves of as many as fill its pool.
uint32_t block_size(uint32_t smallest_pool, uint64_t pixels, size_t devices) {
  const uint64_t tiles = std::min<uint64_t>(smallest_pool / kScrambles, pixels / (32 * devices)) / 64;
  return uint32_t(std::max<uint64_t>(1, tiles)) * 64;
}

// Shares of a wave: less than the smallest is not worth starting before the time is up. Waves are planned for a part of
// what is left, as a small wave takes longer per path than the one before, by which it is planned.
constexpr double kSmallestWave = 1.0 / 32, kPlannedShare = 0.8;

// One render, shared.
class Job {
 public:
  Job(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
      const RenderOptions& options, const std::function<void(double)>& progress)
      : devices_(devices),
        options_(options),
        progress_(progress),
        aovs_(options.aovs || options.also.aovs || options.gradients),
        frame_(frame_of(world, integrator)),
        origin_(world.origin) {
    width_ = world.camera.width, height_ = world.camera.height;
    pixels_ = uint32_t(padded_pixels(width_, height_));
    waves_.resize(devices.size());
    result_.devices.resize(devices.size());
    seconds_per_path_.resize(devices.size());
    const auto start = Clock::now();
    on_every_device([&](uint32_t d) {
      const Device& device = *devices[d].device;
      const Features features = features_of(device.traits(), world, integrator, options);
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
    const bool in_passes = options.error > 0 || options.moments > 1;
    list_ = std::make_unique<WorkList>(blocks, in_passes ? 0 : uint32_t(options.spp), uint32_t(devices.size()),
                                       options.seconds > 0);
    if (options.moments > 1) expected_ = double(blocks) * options.spp;
    std::vector<const FilmDevice*> films;
    for (const auto& wave : waves_) films.push_back(&wave->film());
    film_ = std::make_unique<SharedFilm>(std::move(films), *list_, pixels_, block_pixels_);
  }

  Rendered run(const IntegratorScene& integrator) {
    if (options_.ready) options_.ready();
    start_ = Clock::now();
    const std::clock_t cpu = std::clock();
    if (options_.error > 0)
      work_towards_goal();
    else if (options_.moments > 1)
      work_on_moments(integrator);
    else
      work_on_all();
    result_.seconds = since(start_);
    result_.cpu_seconds = double(std::clock() - cpu) / CLOCKS_PER_SEC;
    result_.stopped |= !list_->complete();
    for (size_t d = 0; d < waves_.size(); ++d) {
      DeviceShare& share = result_.devices[d];
      share.counts = waves_[d]->counts();
      share.pool = waves_[d]->pool();
      share.path_bytes = waves_[d]->bytes();
      result_.counts += share.counts;
    }
    const double origin[3] = {origin_.x, origin_.y, origin_.z};
    result_.reached = film_->reached(options_.error, floor_.value_or(0));
    const FilmSums sums = film_->gather(width_, height_, aovs_);
    result_.image = options_.gradients ? develop_gradients(sums) : develop(sums, origin);
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

  // A run of every pixel's samples at each moment: runs of the sequence that the samples are of are even in themselves.
  void work_on_moments(const IntegratorScene& integrator) {
    if (options_.error > 0 || options_.seconds > 0) bug("render: a goal would not reach every moment");
    std::vector<uint32_t> blocks((pixels_ + block_pixels_ - 1) / block_pixels_);
    std::iota(blocks.begin(), blocks.end(), 0u);
    const uint64_t spp = uint64_t(options_.spp), moments = std::min<uint64_t>(options_.moments, spp);
    for (uint64_t k = 0; k < moments; ++k) {
      if (k > 0) {
        for (const auto& wave : waves_) wave->leave_scene();
        const Moment moment = options_.at_moment(uint32_t(k));
        if (moment.devices.size() != waves_.size()) bug("render: a moment on other devices");
        const WCamera& camera = moment.world->camera;
        if (camera.width != width_ || camera.height != height_)
          user_error(
              "motion blur: film.size is {} x {} at one moment of a frame and {} x {} at another one; give its keys "
              "\"hold\" on whole frames, or close the shutter",
              width_, height_, camera.width, camera.height);
        frame_ = frame_of(*moment.world, integrator);
        for (size_t d = 0; d < waves_.size(); ++d) {
          const DriverCall guard;
          const Features features =
              features_of(moment.devices[d].device->traits(), *moment.world, integrator, options_);
          if (!waves_[d]->serves(*moment.devices[d].scene, features))
            user_error(
                "motion blur: the scene needs other programs at another moment of this frame; build them all in with "
                "--features all");
          waves_[d]->rebind(*moment.devices[d].scene, features, moment.world->camera, true);
          waves_[d]->shift_positions(moment.world->origin - origin_);
        }
      }
      list_->ask(blocks, uint32_t((k + 1) * spp / moments));
      work_on_all();
      if (list_->stopped()) {
        result_.stopped = true;
        return;
      }
    }
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
      if (!floor_) floor_ = error_floor(film_->measure(goal.open(), tile_luminance));
      goal.judge(film_->measure(goal.open(), [&](auto sums) { return tile_error(sums, *floor_); }));
    }
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
    const double all = expected_ > 0 ? expected_ : double(list_->asked());
    // What a goal takes is guessed anew in every pass; the bar does not go back.
    fraction_ = std::max(fraction_, std::min(1.0, double(list_->done()) / all));
    if (options_.seconds > 0) fraction_ = std::max(fraction_, std::min(1.0, elapsed / options_.seconds));
    if (progress_) progress_(fraction_);
  }

  std::span<const RenderDevice> devices_;
  const RenderOptions& options_;
  const std::function<void(double)>& progress_;
  bool aovs_;
  WFrame frame_;
  dvec3 origin_;  ///< that positions in the film count from
  int width_ = 0, height_ = 0;
  uint32_t pixels_ = 0, block_pixels_ = kTilePixels;
  std::vector<double> seconds_per_path_;  ///< of each device's last wave
  std::optional<double> floor_;           ///< of errors, since the first checkpoint
  double expected_ = 0, fraction_ = 0;    ///< samples that the goal will take; progress
  std::vector<std::unique_ptr<Wavefront>> waves_;
  std::unique_ptr<WorkList> list_;
  std::unique_ptr<SharedFilm> film_;
  std::mutex mutex_;
  Rendered result_;
  Clock::time_point start_;
};

}  // namespace

Rendered render(std::span<const RenderDevice> devices, const World& world, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double)>& progress) {
  return Job(devices, world, integrator, options, progress).run(integrator);
}

Rendered render(const Device& device, const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double)>& progress) {
  const RenderDevice one{&device, &scene};
  return render(std::span(&one, 1), world, integrator, options, progress);
}

}  // namespace wale
