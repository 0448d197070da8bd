#include "host/serve/progressive_render.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "geom/error.h"
#include "host/driver_crash.h"
#include "host/tile_error.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kWaveSeconds = 0.05;     // an edit waits for one wave at most
constexpr double kPreviewSeconds = 0.06;  // the first picture takes that, where its pixels can be so few
constexpr uint32_t kLeastPaths = 4096;

WCamera shrunk(WCamera camera, int shrink) {
  camera.width = std::max(1, (camera.width + shrink - 1) / shrink);
  camera.height = std::max(1, (camera.height + shrink - 1) / shrink);
  return camera;
}

uint64_t rays_of(const Wavefront& wave) {
  const WaveCounts counts = wave.counts();
  return counts.primary + counts.bounce + counts.shadow;
}

}  // namespace

RenderOptions ProgressiveRender::options(const std::filesystem::path& kernel_dir) {
  RenderOptions options;
  options.also = Features::everything();
  options.also.aovs = false;
  options.kernel_dir = kernel_dir;
  return options;
}

ProgressiveRender::ProgressiveRender(const Device& device, std::filesystem::path kernel_dir)
    : device_(device), options_(options(kernel_dir)), levels_{Level{8}, Level{4}, Level{2}, Level{1}} {}

void ProgressiveRender::bind(const World& world, const IntegratorScene& integrator, const SceneDevice& scene) {
  const DeviceTraits& traits = device_.traits();
  features_ = features_of(traits, world, integrator, options_);
  frame_ = frame_of(world, integrator);
  scene_ = &scene;
  camera_ = world.camera;
  pool_ = pool_of(traits, integrator, options_);
  // Such a driver compiles kernels once more for large launches, which waves this short do not need.
  if (traits.compiles_at_launch) pool_ = std::min(pool_, uint32_t(Device::kLargeGrid) - 64);
  for (Level& level : levels_) {
    const WCamera camera = shrunk(camera_, level.shrink);
    level.bound = false;
    level.tiles = uint32_t(padded_pixels(camera.width, camera.height)) / kTilePixels;
  }
}

// A level's film is emptied when its turn comes, which may be never: edits come faster.
Wavefront& ProgressiveRender::bound(Level& level) {
  if (level.bound) return *level.wave;
  const WCamera camera = shrunk(camera_, level.shrink);
  if (level.wave && level.width == camera.width && level.height == camera.height &&
      level.wave->serves(*scene_, features_)) {
    level.wave->rebind(*scene_, features_, camera, !level.empty);
  } else {
    const uint32_t pixels = level.tiles * kTilePixels;
    level.wave.reset();
    level.wave = std::make_unique<Wavefront>(device_, *scene_, features_, camera,
                                             std::min(pool_, std::max(pixels, 64u)), options_.kernel_dir);
    level.width = camera.width;
    level.height = camera.height;
  }
  level.empty = false;
  level.bound = true;
  return *level.wave;
}

// The finest that is there in time, as the version before was traced.
size_t ProgressiveRender::first_level() const {
  size_t level = 0;
  if (seconds_per_path_ <= 0) return level;
  while (level + 2 < levels_.size() && levels_[level + 1].tiles * kTilePixels * seconds_per_path_ <= kPreviewSeconds)
    ++level;
  return level;
}

void ProgressiveRender::restart(const World& world, const IntegratorScene& integrator, const SceneDevice& scene) {
  bind(world, integrator, scene);
  for (Level& level : levels_) level.empty = true;
  level_ = first_level();
  sample_ = tile_ = 0;
  last_picture_ = 0;
  rays_ = 0;
  state_ = {};
}

void ProgressiveRender::resume(const World& world, const IntegratorScene& integrator, const SceneDevice& scene) {
  bind(world, integrator, scene);
}

bool ProgressiveRender::step() {
  const DriverCall guard;
  Level& level = levels_[level_];
  Wavefront& wave = bound(level);
  const auto start = Clock::now();
  const uint64_t before = rays_of(wave);
  const double wanted = seconds_per_path_ > 0 ? kWaveSeconds / seconds_per_path_ : kLeastPaths;
  const uint32_t least = std::min(kLeastPaths, wave.pool());
  const uint32_t paths = uint32_t(std::clamp(wanted, double(least), double(wave.pool())));
  const uint32_t count = std::min(std::max(1u, paths / kTilePixels), level.tiles - tile_);
  std::vector<uint32_t> tiles(count);
  std::iota(tiles.begin(), tiles.end(), tile_);
  wave.trace(frame_, tiles, sample_, 1);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  seconds_per_path_ = seconds / (double(count) * kTilePixels);
  rays_ += rays_of(wave) - before;
  state_.seconds += seconds;
  state_.mrays = 1e-6 * double(rays_) / state_.seconds;
  tile_ += count;
  if (tile_ < level.tiles) return false;
  tile_ = 0;
  state_.shrink = level.shrink;
  if (level_ + 1 < levels_.size()) {
    ++level_;
    return true;
  }
  state_.samples = ++sample_;
  // Often at first, when a pass changes much, then so that showing costs little beside tracing; and at counts that
  // pictures of every version have, to compare them.
  const double due = std::min(1.0, 0.1 + 0.1 * state_.seconds);
  if (!std::has_single_bit(sample_) && state_.seconds - last_picture_ < due) return false;
  last_picture_ = state_.seconds;
  return true;
}

Image ProgressiveRender::picture() {
  if (state_.shrink == 1 && tile_ > 0) bug("render: a picture in the middle of a pass");
  const Level& level =
      *std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.shrink == state_.shrink; });
  const int w = level.width, h = level.height;
  const PixelSums sums = level.wave->film().read(0, level.tiles * kTilePixels);
  if (state_.samples >= 2) {
    constexpr size_t kTileSums = kTilePixels * kScrambles;
    std::vector<double> light(level.tiles), errors(level.tiles);
    const auto tile = [&](uint32_t t) { return std::span(sums.radiance).subspan(t * kTileSums, kTileSums); };
    for (uint32_t t = 0; t < level.tiles; ++t) light[t] = tile_luminance(tile(t));
    const double floor = error_floor(light);
    for (uint32_t t = 0; t < level.tiles; ++t) errors[t] = tile_error(tile(t), floor);
    const Reached all = reached(std::move(errors), std::vector<uint32_t>(level.tiles, state_.samples), 0, floor);
    state_.error = std::isfinite(all.p95) ? all.p95 : 0;
  }
  FilmSums film{w, h, std::vector<w_float4>(size_t(w) * size_t(h) * kScrambles, w_float4{0, 0, 0, 0}), {}, {}};
  scatter(sums, 0, film);
  Image image;
  image.width = w;
  image.height = h;
  image.channels = {"R", "G", "B"};
  image.pixels.resize(size_t(w) * size_t(h) * 3);
  for (size_t i = 0; i < size_t(w) * size_t(h); ++i) {
    float rgb[3] = {0, 0, 0}, n = 0;
    for (size_t s = 0; s < kScrambles; ++s) {
      const w_float4& sum = film.radiance[i * kScrambles + s];
      rgb[0] += sum.x, rgb[1] += sum.y, rgb[2] += sum.z, n += sum.w;
    }
    for (size_t c = 0; c < 3; ++c) image.pixels[3 * i + c] = n > 0 ? rgb[c] / n : 0;
  }
  return image;
}

std::optional<double> ProgressiveRender::seconds_to(double goal) const {
  if (state_.error <= 0) return std::nullopt;
  const double ratio = state_.error / goal;  // noise falls as 1 / sqrt(samples)
  return std::max(0.0, state_.seconds * (ratio * ratio - 1));
}

}  // namespace wale
