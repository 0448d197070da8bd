#include "host/render.h"

#include <algorithm>
#include <chrono>

#include "geom/error.h"
#include "host/stop.h"

namespace wale {

Rendered render(const Device& device, const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                const RenderOptions& options, const std::function<void(double)>& progress) {
  using Clock = std::chrono::steady_clock;
  const Features features = analyse(world, integrator, options.aovs, int(device.traits().lanes));
  const uint32_t pool = options.pool ? options.pool : integrator.pool ? integrator.pool : device.traits().pool;
  Wavefront wavefront(device, scene, features, world.camera, pool, options.kernel_dir);
  wavefront.record(options.record);
  wavefront.count_cpu_time(options.count_cpu_time);
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };

  WFrame frame{};
  frame.seed = integrator.seed;
  frame.max_depth = uint32_t(integrator.max_depth);
  frame.roulette_depth = uint32_t(integrator.russian_roulette_depth);
  frame.light_sampling = integrator.light_sampling == "mis" ? 0 : integrator.light_sampling == "light" ? 1 : 2;
  frame.lights = uint32_t(world.lights.lights.size());
  frame.spheres = uint32_t(world.spheres.size());

  Rendered result;
  const uint32_t pixels = wavefront.padded_pixels();
  const uint64_t total = uint64_t(pixels) * uint64_t(options.spp);
  uint64_t done = 0;
  // A pass is one sample of each scramble for every pixel, so that a stopped picture is even.
  for (int sample = 0; sample < options.spp && !result.stopped;) {
    const uint32_t samples =
        std::min<uint32_t>({uint32_t(options.spp - sample), uint32_t(Wavefront::kScrambles), wavefront.pool()});
    const uint32_t block = std::max(1u, wavefront.pool() / samples);
    for (uint32_t first = 0; first < pixels && !result.stopped; first += block) {
      const uint32_t count = std::min(block, pixels - first);
      wavefront.trace(frame, first, count, uint32_t(sample), samples);
      done += uint64_t(count) * samples;
      const double share = double(done) / double(total);
      if (progress) progress(options.seconds > 0 ? std::max(share, std::min(1.0, elapsed() / options.seconds)) : share);
      result.stopped = done < total && (stop_requested() || (options.seconds > 0 && elapsed() >= options.seconds));
    }
    sample += int(samples);
    result.samples = sample;
  }
  result.seconds = elapsed();
  FilmSums sums{world.camera.width, world.camera.height, wavefront.read_film(), wavefront.read_aov(),
                wavefront.read_ply()};
  const double origin[3] = {world.origin.x, world.origin.y, world.origin.z};
  result.image = develop(sums, origin);
  result.counts = wavefront.counts();
  result.pool = wavefront.pool();
  result.path_bytes = wavefront.bytes();
  return result;
}

}  // namespace wale
