// The thread of the editor that owns the device.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geom/error.h"
#include "host/display_picture.h"
#include "host/serve/editor_session.h"

namespace wale {
namespace {

constexpr std::chrono::milliseconds kIdle{100};
// An edit that would knit for minutes is refused: more than these, and than twice what the scene was opened with.
constexpr double kMostSegments = 2e7;

// The scene's film, made smaller until it fits.
void fit(FilmScene& film, int width, int height) {
  const double share = std::min({1.0, double(width) / film.width, double(height) / film.height});
  film.width = std::max(1, int(std::lround(share * film.width)));
  film.height = std::max(1, int(std::lround(share * film.height)));
}

// What tracing depends on; the rest is how the picture is shown.
std::vector<Scene> traced(std::vector<Scene> scenes) {
  for (Scene& scene : scenes) {
    scene.film.exposure = FilmScene{}.exposure;
    scene.film.view = FilmScene{}.view;
  }
  return scenes;
}

CameraScene camera_of(const World& world) {
  const WCamera& c = world.camera;
  const auto vec = [](const w_float4& v) { return dvec3(v.x, v.y, v.z); };
  CameraScene out;
  out.position = world.origin + vec(c.origin);
  out.look_at = out.position + double(c.focus) * vec(c.forward);
  out.up = vec(c.up);
  return out;
}

}  // namespace

EditorSession::Version EditorSession::next_version() {
  std::unique_lock lock(mutex_);
  Version version{edits_.next()};
  const CameraScene seen_by = camera(version.trial.state);
  lock.unlock();
  const EditedScene& edited = version.trial.state.scene;
  try {
    for (const EditorView& view : editor_views(version.trial.state, seen_by)) {
      version.scenes.push_back(view.more.empty() ? edited.scene() : edited.scene_with(view.more));
      fit(version.scenes.back().film, options_.width, options_.height);
    }
  } catch (const Error& error) {  // a file that it names has gone
    if (error.fault() != wale::Fault::user) throw;
    version.fault = error.what();
  }
  return version;
}

void EditorSession::publish_picture(size_t view, const Version& version, Shown shown) {
  const FilmScene& film = version.scenes[view].film;
  shown.exposure = film.exposure;
  shown.view = film.view;
  const std::string jpeg = display_jpeg(shown.image, shown.exposure, shown.view, kJpegQuality);
  feed_.publish(fmt::format("picture.{}", view), "image/jpeg", jpeg,
                {{"X-Wale-Revision", std::to_string(version.trial.revision)},
                 {"X-Wale-Size", fmt::format("{}x{}", film.width, film.height)},
                 {"X-Wale-Shrink", std::to_string(shown.shrink)},
                 {"X-Wale-Samples", std::to_string(shown.samples)}});
  const std::lock_guard lock(mutex_);
  shown_.resize(std::max(shown_.size(), view + 1));
  shown_[view] = std::make_shared<const Shown>(std::move(shown));
}

void EditorSession::refuse(const Version& version, const std::string& line) {
  {
    const std::lock_guard lock(mutex_);
    edits_.refused(version.trial, line);
    dirty_ = true;
  }
  publish_state(true);
}

// It is what the views show.
void EditorSession::confirm(const Version& version) {
  {
    const std::lock_guard lock(mutex_);
    for (size_t v = version.scenes.size(); v < shown_.size(); ++v) feed_.forget(fmt::format("picture.{}", v));
    shown_.resize(version.scenes.size());
    const uint64_t before = edits_.revision();
    const bool told = edits_.refusal().has_value();
    edits_.shown(version.trial);
    dirty_ = dirty_ || edits_.revision() != before || edits_.refusal().has_value() != told;
  }
  publish_state(false);
}

bool EditorSession::stopped_for_files() const {
  const std::lock_guard lock(mutex_);
  return edits_.stopped();
}

bool EditorSession::another_pending() const {
  const std::lock_guard lock(mutex_);
  return edits_.pending();
}

void EditorSession::run(std::span<const Device> device, const Loaders& loaders,
                        const std::function<bool()>& stop_asked) {
  LiveViews views(device, loaders, options_.kernel_dir);
  std::optional<Version> version;  // that the views are of, or were until files that they need changed
  bool visible = false;
  Redone redone;
  uint64_t told = 0;  // samples that were not finite
  const auto publish_cost = [&](const std::string& status, const Version& of) {
    feed_.publish(
        "cost", "application/json",
        cost_message(status, of.trial.revision, of.trial.state.settings.goal, views, redone, feed_.viewers()));
  };
  const auto wait = [&] {
    std::unique_lock lock(mutex_);
    if (!edits_.pending() && !stop_) wake_.wait_for(lock, kIdle);
  };
  // What is begun is seen once, in all views: while a control is dragged, the next version is always there already.
  const auto next_wanted = [&] { return (!visible || views.all_seen()) && another_pending(); };
  while (!stop_asked() && !stopped()) {
    publish_state(false);
    if (next_wanted()) {
      Version next = next_version();
      if (visible && next.fault.empty() && traced(next.scenes) == traced(version->scenes)) {
        version = std::move(next);
        confirm(*version);
        visible = !stopped_for_files();
        // As they were seen last: some tiles may have a sample more by now, whose pass has not ended.
        for (size_t v = 0; v < views.count(); ++v)
          if (views.render(v).state().shrink > 0) publish_picture(v, *version, *shown_[v]);
        publish_cost("rendering", *version);
        continue;
      }
      publish_cost(version ? "changing" : "starting", next);
      try {
        if (!next.fault.empty()) user_error("{}", next.fault);
        redone = views.show(next.scenes);
      } catch (const Error& error) {
        if (error.fault() != wale::Fault::user || (!version && next.trial.revision == 1)) throw;
        visible = false;
        refuse(next, error.what());
        continue;
      }
      const bool first = !version;
      version = std::move(next);
      visible = true;
      if (first) {
        views.limit_segments(std::max(kMostSegments, 2.0 * double(views.segments())));
        const std::lock_guard lock(mutex_);
        framed_ = camera_of(views.world());
      }
      confirm(*version);
      visible = !stopped_for_files();
      continue;
    }
    if (!visible) {
      publish_cost("stopped", *version);
      wait();
      continue;
    }
    const double goal = version->trial.state.settings.goal;
    const auto view = views.next(goal);
    if (!view) {
      publish_cost("done", *version);
      wait();
      continue;
    }
    bool due = false;
    try {
      while (!due && !next_wanted() && !stop_asked() && !stopped()) due = views.step(*view);
    } catch (const Error& error) {  // two views take turns on the device, and files are read anew
      if (error.fault() != wale::Fault::user) throw;
      visible = false;
      refuse(*version, error.what());
      continue;
    }
    if (!due) continue;
    ProgressiveRender& render = views.render(*view);
    publish_picture(*view, *version, {render.picture(), render.state().shrink, render.state().samples});
    publish_cost("rendering", *version);
    if (const uint64_t now = views.progress(goal).not_finite_since_start; now > told) {
      if (told == 0 || now >= 2 * told) {  // a line each time that it has doubled
        fmt::print(stderr, "wale: render: {} samples so far were not finite; the pictures are without them\n", now);
        told = now;
      }
    }
  }
  stop();
  if (const uint64_t count = views.progress(1).not_finite_since_start)
    bug("render: {} samples were not finite; the pictures were shown without them", count);
}

}  // namespace wale
