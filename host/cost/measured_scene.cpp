#include "host/cost/measured_scene.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "host/memory_needs.h"

namespace wale::cost {
namespace {

size_t channel(const Image& image, const std::string& name) {
  return size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin());
}

}  // namespace

MeasuredScenes::MeasuredScenes(const Device& device, const Loaders& loaders, uint64_t most_bytes,
                               std::filesystem::path kernel_dir)
    : device_(device), loaders_(loaders), most_bytes_(most_bytes), kernel_dir_(std::move(kernel_dir)) {}

std::shared_ptr<const Prepared> MeasuredScenes::prepare(const Unit& unit) {
  if (const auto found = kept_.find(unit.geometry); found != kept_.end()) return found->second;
  if (passing_name_ == unit.geometry && passing_) return passing_;
  passing_.reset();  // before another one takes its room
  auto made = std::make_shared<Prepared>();
  const IntegratorScene& integrator = unit.scene.integrator;
  made->world = build_world(unit.scene, loaders_);
  const Features features = analyse(made->world, integrator, true, device_.traits());
  const uint32_t pool = pool_of(device_.traits(), integrator, {});
  const std::vector<MemoryNeed> needs = memory_needs(made->world, features, pool, device_.traits());
  require_memory(device_, needs);
  made->on_device = std::make_unique<SceneDevice>(device_, made->world);
  const FabricDevice& fabric = made->on_device->fabric();
  made->start = {made->world.seconds.at("knit"), fabric.warp_seconds + fabric.pack_seconds, fabric.build_seconds, 0, 0};
  for (const auto& [name, bytes] : made->on_device->bytes()) made->start.bytes += bytes;
  if (bytes_ + made->start.bytes <= most_bytes_) {
    bytes_ += made->start.bytes;
    kept_[unit.geometry] = made;
  } else {
    passing_name_ = unit.geometry;
    passing_ = made;
  }
  return made;
}

void MeasuredScenes::forget(const Unit& unit) {
  if (passing_name_ == unit.geometry) passing_.reset();
  if (const auto found = kept_.find(unit.geometry); found != kept_.end()) {
    bytes_ -= found->second->start.bytes;
    kept_.erase(found);
  }
}

Rendered MeasuredScenes::run(const Unit& unit, int samples, unsigned seed) {
  const std::shared_ptr<const Prepared> geometry = prepare(unit);
  IntegratorScene integrator = unit.scene.integrator;
  integrator.seed = seed;
  RenderOptions options;
  options.spp = samples;
  options.aovs = true;  // as for an .exr, so that first hits and pictures come from the same programs
  options.kernel_dir = kernel_dir_;
  return render(device_, geometry->world, *geometry->on_device, integrator, options);
}

Repetition MeasuredScenes::render_once(const Unit& unit, int samples, unsigned seed) {
  const Rendered r = run(unit, samples, seed);
  Repetition out;
  out.cpu = r.cpu_seconds;
  out.wall = r.seconds;
  out.program_seconds = r.program_seconds;
  out.nan_samples = r.counts.events[W_EVENT_NAN];
  out.complete = !r.stopped;
  const size_t pixels = size_t(r.image.width) * size_t(r.image.height), stride = r.image.channels.size();
  const size_t color = channel(r.image, "R"), variance = channel(r.image, "variance.R");
  out.picture = {r.image.width, r.image.height, std::vector<float>(pixels * 3)};
  out.variance.resize(pixels * 3);
  for (size_t p = 0; p < pixels; ++p)
    for (size_t c = 0; c < 3; ++c) {
      out.picture.rgb[3 * p + c] = r.image.pixels[p * stride + color + c];
      out.variance[3 * p + c] = r.image.pixels[p * stride + variance + c];
    }
  return out;
}

Hits MeasuredScenes::first_hits(const Unit& unit, unsigned seed) {
  const Rendered r = run(unit, 1, seed);
  const size_t stride = r.image.channels.size(), place = channel(r.image, "position.X"),
               ply = channel(r.image, "ply.id"), covered = channel(r.image, "coverage");
  Hits out;
  for (size_t i = 0; i < r.image.pixels.size(); i += stride) {
    const float* pixel = &r.image.pixels[i];
    if (pixel[covered] > 0 && pixel[ply] >= 0) out.push_back({pixel[place], pixel[place + 1], pixel[place + 2]});
  }
  return out;
}

uint64_t memory_to_use(const DeviceTraits& traits) {
  uint64_t most = traits.global_bytes / 2;
  if (!traits.cpu) return most;
  // The device is the host, whose own part of the world takes about as much again; half is left to others.
  std::ifstream memory("/proc/meminfo");
  for (std::string line; std::getline(memory, line);) {
    unsigned long long kilobytes = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %llu kB", &kilobytes) == 1)
      most = std::min<uint64_t>(most, 1024 * uint64_t(kilobytes) / 4);
  }
  return most;
}

}  // namespace wale::cost
