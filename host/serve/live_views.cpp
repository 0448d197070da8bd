#include "host/serve/live_views.h"

#include <algorithm>

namespace wale {
namespace {

constexpr uint32_t kFewestSamples = 16, kMostSamples = 1 << 16;

bool done(const RenderState& state, double goal) {
  return state.samples >= kFewestSamples && ((state.error > 0 && state.error <= goal) || state.samples >= kMostSamples);
}

}  // namespace

LiveViews::LiveViews(std::span<const Device> devices, const Loaders& loaders, const std::filesystem::path& kernel_dir)
    : device_(devices[0]),
      kernel_dir_(kernel_dir),
      live_(devices.first(1), loaders, {ProgressiveRender::options(kernel_dir), true}) {}

uint64_t LiveViews::not_finite_on_device() const {
  return live_.devices().empty() ? 0 : live_.devices()[0].scene->read_events()[W_EVENT_NAN];
}

// Counters go with the scene that they are counted for.
Redone LiveViews::apply(const Scene& scene) {
  const uint64_t counted = not_finite_on_device();
  const Redone redone = live_.apply(scene);
  not_finite_gone_ += counted;
  return redone;
}

Redone LiveViews::show(const std::vector<Scene>& scenes) {
  const Redone redone = apply(scenes[0]);
  not_finite_earlier_ = not_finite_gone_;
  scenes_ = scenes;
  renders_.resize(std::min(renders_.size(), scenes.size()));
  while (renders_.size() < scenes.size()) renders_.push_back(std::make_unique<ProgressiveRender>(device_, kernel_dir_));
  for (size_t v = 0; v < scenes.size(); ++v) {
    if (v > 0) apply(scenes[v]);
    renders_[v]->restart(live_.world(), live_.scene().integrator, *live_.devices()[0].scene);
    on_device_ = v;
  }
  return redone;
}

bool LiveViews::all_seen() const {
  return std::all_of(renders_.begin(), renders_.end(), [](const auto& render) { return render->state().shrink > 0; });
}

size_t LiveViews::segments() const {
  size_t sum = 0;
  for (const Fabric& fabric : live_.world().fabrics) sum += fabric.report.segments;
  return sum;
}

std::optional<size_t> LiveViews::next(double goal) const {
  const auto rank = [](const RenderState& s) { return std::pair(s.shrink ? 8 / s.shrink : 0, s.samples); };
  std::optional<size_t> least;
  for (size_t v = 0; v < renders_.size(); ++v)
    if (!done(renders_[v]->state(), goal) && (!least || rank(renders_[v]->state()) < rank(renders_[*least]->state())))
      least = v;
  return least;
}

bool LiveViews::step(size_t view) {
  if (view != on_device_) {
    apply(scenes_[view]);
    renders_[view]->resume(live_.world(), live_.scene().integrator, *live_.devices()[0].scene);
    on_device_ = view;
  }
  return renders_[view]->step();
}

ViewsProgress LiveViews::progress(double goal) const {
  ViewsProgress out;
  out.not_finite_since_start = not_finite_gone_ + not_finite_on_device();
  out.not_finite = out.not_finite_since_start - not_finite_earlier_;
  if (renders_.empty()) return out;
  out.samples = kMostSamples;
  out.to_goal = 0;
  for (const auto& render : renders_) {
    const RenderState& s = render->state();
    out.samples = std::min(out.samples, s.samples);
    out.error = std::max(out.error, s.error);
    out.mrays += s.mrays / double(renders_.size());
    out.seconds += s.seconds;
    const auto left = render->seconds_to(goal);
    out.to_goal = left && out.to_goal ? std::optional(*out.to_goal + *left) : std::nullopt;
  }
  return out;
}

}  // namespace wale
