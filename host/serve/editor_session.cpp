#include "host/serve/editor_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/display_picture.h"
#include "host/json_text.h"
#include "host/serve/camera_move.h"
#include "host/serve/control_values.h"
#include "host/serve/light_sides.h"

namespace wale {
namespace {

using Kind = EditorRequest::Kind;
using Clock = std::chrono::steady_clock;
using Texts = std::vector<std::string>;

constexpr int kJpegQuality = 90;
constexpr std::chrono::milliseconds kStateInterval{40}, kIdle{100};
constexpr uint32_t kMostSamples = 1 << 16;

std::string json_list(const Texts& texts) {
  Texts out;
  for (const std::string& text : texts) out.push_back(json_string(text));
  return fmt::format("[{}]", fmt::join(out, ", "));
}

// The scene's film, made smaller until it fits.
void fit(FilmScene& film, int width, int height) {
  const double share = std::min({1.0, double(width) / film.width, double(height) / film.height});
  film.width = std::max(1, int(std::lround(share * film.width)));
  film.height = std::max(1, int(std::lround(share * film.height)));
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

EditorSession::EditorSession(EditedScene scene, const EditorOptions& options)
    : options_(options), feed_(options.viewers), edited_(std::move(scene)) {}

HttpReply EditorSession::handle(const EditorRequest& request) {
  switch (request.kind) {
    case Kind::stream:
      publish_state(false);
      return feed_.join();
    case Kind::state: {
      const std::lock_guard lock(mutex_);
      HttpReply reply;
      reply.body = state_json();
      return reply;
    }
    case Kind::edit:
      return changed([&] { edited_.edit(request.set, request.gesture); }, request.control);
    case Kind::control:
      return changed([&] { set_control(request); }, request.control);
    case Kind::camera:
      return changed([&] { move_camera(request); }, "camera");
    case Kind::undo:
      return changed([&] { edited_.undo(); }, "");
    case Kind::redo:
      return changed([&] { edited_.redo(); }, "");
    case Kind::reset:
      return changed([&] { edited_.reset(); }, "");
    case Kind::save:
      return save(request);
    case Kind::picture:
      return picture(request.view);
    case Kind::stop: {
      stop();
      HttpReply reply;
      reply.body = "{\"stopping\": true}\n";
      return reply;
    }
    case Kind::page:
      break;
  }
  return refusal(404, "no such path");
}

HttpReply EditorSession::changed(const std::function<void()>& change, const std::string& control) {
  HttpReply reply;
  {
    const std::lock_guard lock(mutex_);
    try {
      change();
      ++revision_;
      control_ = control;
      fault_.reset();
      dirty_ = true;
      reply.body = fmt::format("{{\"revision\": {}}}\n", revision_);
    } catch (const Error& error) {
      reply = refusal(error.fault() == Fault::user ? 400 : 500, error.what());
    }
  }
  wake_.notify_all();
  publish_state(false);
  return reply;
}

void EditorSession::set_control(const EditorRequest& request) {
  const std::vector<Control> controls = controls_of(edited_, settings_);
  const auto found =
      std::find_if(controls.begin(), controls.end(), [&](const Control& c) { return c.id == request.control; });
  if (found == controls.end()) user_error("\"{}\": there is no such control", one_line(request.control));
  if (!found->set) return set_setting(settings_, *found, request.value);
  if (const Texts set = overrides_of(*found, request.value); !set.empty()) edited_.edit(set, request.gesture);
}

CameraScene EditorSession::camera() const { return edited_.scene().camera_given ? edited_.scene().camera : framed_; }

void EditorSession::move_camera(const EditorRequest& r) {
  const CameraScene now = camera();
  const CameraScene next = moved_camera(now, {r.orbit[0], r.orbit[1], r.pan[0], r.pan[1], r.zoom});
  const double unit = edited_.metres_per_unit();
  const auto point = [&](const dvec3& p) { return point_text(p, unit); };
  Texts set;
  if (!edited_.scene().camera_given)
    set.push_back(fmt::format("camera={{\"position\": {}, \"look_at\": {}, \"up\": [0,1,0], \"fov\": {}}}",
                              point(next.position), point(next.look_at), plain_number(next.fov * 57.29577951308232)));
  else
    set = {"camera.position=" + point(next.position), "camera.look_at=" + point(next.look_at)};
  if (next.orthographic) set.push_back("camera.height=" + plain_number(next.height / unit));
  edited_.edit(set, r.gesture);
}

HttpReply EditorSession::save(const EditorRequest& request) {
  const std::lock_guard lock(mutex_);
  try {
    const auto file = edited_.save(request.file, request.replace);
    if (file.empty())
      return refusal(409, fmt::format("{} exists; save under another name, or replace it", request.file));
    HttpReply reply;
    reply.body = fmt::format("{{\"saved\": {}}}\n", json_string(file.filename().string()));
    return reply;
  } catch (const Error& error) {
    return refusal(400, error.what());
  }
}

HttpReply EditorSession::picture(int view) {
  std::shared_ptr<const Shown> shown;
  {
    const std::lock_guard lock(mutex_);
    if (size_t(view) < shown_.size()) shown = shown_[size_t(view)];
  }
  if (!shown) return refusal(404, "there is no picture yet");
  HttpReply reply;
  reply.type = "image/png";
  reply.body = display_png(shown->image, shown->exposure, shown->view);
  reply.headers.emplace_back("Content-Disposition", "attachment; filename=\"picture.png\"");
  return reply;
}

// Under the lock.
std::vector<EditorSession::View> EditorSession::views_of() const {
  std::vector<View> views;
  const auto add = [&](const char* name, Texts more) {
    View view{name, std::move(more), {}};
    view.scene = view.more.empty() ? edited_.scene() : edited_.scene_with(view.more);
    fit(view.scene.film, options_.width, options_.height);
    views.push_back(std::move(view));
  };
  const std::string& lit = settings_.lit;
  if (lit == "scene") add("as in the scene", {});
  if (lit == "front" || lit == "both") add("from the front", light_sides(edited_, camera(), LitSide::front));
  if (lit == "back" || lit == "both") add("from behind", light_sides(edited_, camera(), LitSide::back));
  return views;
}

EditorSession::Version EditorSession::newest() {
  const std::lock_guard lock(mutex_);
  return {revision_, edited_.version(), edited_.edits(), views_of(), control_, settings_.goal};
}

std::string EditorSession::state_json() {
  Texts commands, names;
  const std::string goal = fmt::format(" --error {:g}", settings_.goal);
  for (const View& view : views_of()) {
    commands.push_back(edited_.command(view.more, goal));
    names.push_back(view.name);
  }
  return fmt::format(
      "{{\"revision\": {}, \"scene\": {}, \"views\": {}, \"commands\": {}, \"can_undo\": {}, \"can_redo\": {}, "
      "\"edits\": {},\n \"fault\": {},\n \"controls\": {}}}\n",
      revision_, json_string(std::filesystem::path(edited_.scene().file).filename().string()), json_list(names),
      json_list(commands), edited_.can_undo(), edited_.can_redo(), json_list(edited_.edits()),
      fault_ ? fmt::format("{{\"control\": {}, \"line\": {}}}", json_string(fault_->control), json_string(fault_->line))
             : "null",
      controls_json(controls_of(edited_, settings_)));
}

// Not for each of many edits that come at once.
void EditorSession::publish_state(bool now) {
  const std::lock_guard lock(mutex_);
  if (!dirty_ || (!now && Clock::now() - last_state_ < kStateInterval)) return;
  feed_.publish("state", "application/json", state_json());
  dirty_ = false;
  last_state_ = Clock::now();
}

void EditorSession::publish_cost(const std::string& status, const Version& version, const LiveScene& live,
                                 const Redone& redone, const std::vector<std::unique_ptr<ProgressiveRender>>& renders) {
  size_t segments = 0;
  for (const Fabric& fabric : live.world().fabrics) segments += fabric.report.segments;
  uint32_t samples = renders.empty() ? 0 : kMostSamples;
  double error = 0, mrays = 0, left = 0, seconds = 0;
  bool known = !renders.empty();
  for (const auto& render : renders) {
    const RenderState& s = render->state();
    samples = std::min(samples, s.samples);
    error = std::max(error, s.error);
    mrays += s.mrays / double(renders.size());
    seconds += s.seconds;
    const auto to_goal = render->seconds_to(version.goal);
    known &= to_goal.has_value();
    left += to_goal.value_or(0);
  }
  feed_.publish(
      "cost", "application/json",
      fmt::format("{{\"status\": \"{}\", \"revision\": {}, \"samples\": {}, \"error\": {:.4g}, \"goal\": {:g}, "
                  "\"seconds\": {:.3g}, \"seconds_to_goal\": {}, \"mrays\": {:.3g}, \"segments\": {}, "
                  "\"knitted\": {}, \"geometry\": {}, \"edit_seconds\": {:.3g}, \"viewers\": {}}}",
                  status, version.revision, samples, error, version.goal, seconds,
                  known ? fmt::format("{:.3g}", left) : "null", mrays, segments, redone.knitted, redone.fabrics,
                  redone.host_seconds + redone.device_seconds, feed_.viewers()));
}

void EditorSession::publish_picture(size_t view, uint64_t revision, const Scene& scene, ProgressiveRender& render) {
  auto shown = std::make_shared<Shown>(Shown{render.picture(), scene.film.exposure, scene.film.view});
  const std::string jpeg = display_jpeg(shown->image, shown->exposure, shown->view, kJpegQuality);
  const RenderState& s = render.state();
  feed_.publish(fmt::format("picture.{}", view), "image/jpeg", jpeg,
                {{"X-Wale-Revision", std::to_string(revision)},
                 {"X-Wale-Size", fmt::format("{}x{}", scene.film.width, scene.film.height)},
                 {"X-Wale-Shrink", std::to_string(s.shrink)},
                 {"X-Wale-Samples", std::to_string(s.samples)}});
  const std::lock_guard lock(mutex_);
  shown_.resize(std::max(shown_.size(), view + 1));
  shown_[view] = std::move(shown);
}

// The version before it stays on the device and, where nobody has edited on, in the document.
void EditorSession::refuse(const Version& version, const std::string& line) {
  {
    const std::lock_guard lock(mutex_);
    if (revision_ == version.revision) {
      edited_.withdraw(version.scene);
      ++revision_;
      fault_ = Refused{version.control, line};
      dirty_ = true;
    }
  }
  publish_state(true);
}

void EditorSession::run(std::span<const Device> device, const Loaders& loaders,
                        const std::function<bool()>& stop_asked) {
  LiveScene live(device, loaders, {ProgressiveRender::options(options_.kernel_dir), true});
  Version version;
  std::vector<std::unique_ptr<ProgressiveRender>> renders;
  size_t on_device = 0;  // view
  Redone redone;
  bool first = true, idle = false;
  while (!stop_asked() && !stopped()) {
    publish_state(false);
    {
      std::unique_lock lock(mutex_);
      if (idle && revision_ == version.revision && !stop_) wake_.wait_for(lock, kIdle);
    }
    bool edited = false;
    {
      const std::lock_guard lock(mutex_);
      edited = first || revision_ != version.revision;
    }
    if (edited) {
      Version next = newest();
      publish_cost(first ? "starting" : "changing", next, live, redone, renders);
      try {
        redone = live.apply(next.views[0].scene);
      } catch (const Error& error) {
        if (error.fault() != wale::Fault::user || first) throw;
        version.revision = next.revision;  // refuse() makes another one when nobody else did
        refuse(next, error.what());
        continue;
      }
      version = std::move(next);
      while (renders.size() < version.views.size())
        renders.push_back(std::make_unique<ProgressiveRender>(device[0], options_.kernel_dir));
      while (renders.size() > version.views.size()) {
        renders.pop_back();
        feed_.forget(fmt::format("picture.{}", renders.size()));
      }
      for (size_t v = 0; v < renders.size(); ++v) {
        if (v > 0) live.apply(version.views[v].scene);
        renders[v]->restart(live.world(), live.scene().integrator, *live.devices()[0].scene);
      }
      on_device = renders.size() - 1;
      const std::lock_guard lock(mutex_);
      shown_.resize(renders.size());
      edited_.confirm(version.scene, version.edits);
      if (first) framed_ = camera_of(live.world());
      first = idle = false;
    }
    // The view that is farthest behind goes on until its picture is due.
    const auto behind = std::min_element(renders.begin(), renders.end(), [](const auto& a, const auto& b) {
      const auto rank = [](const RenderState& s) { return std::pair(s.shrink ? 4 / s.shrink : 0, s.samples); };
      return rank(a->state()) < rank(b->state());
    });
    const size_t v = size_t(behind - renders.begin());
    const RenderState& state = renders[v]->state();
    idle = state.samples >= 16 && ((state.error > 0 && state.error <= version.goal) || state.samples >= kMostSamples);
    if (idle) {
      publish_cost("done", version, live, redone, renders);
      continue;
    }
    if (v != on_device) {
      live.apply(version.views[v].scene);
      renders[v]->resume(live.world(), live.scene().integrator, *live.devices()[0].scene);
      on_device = v;
    }
    const auto newer = [&] {
      const std::lock_guard lock(mutex_);
      return stop_ || revision_ != version.revision;
    };
    bool due = false;
    while (!due && !newer() && !stop_asked()) due = renders[v]->step();
    if (!due) continue;
    publish_picture(v, version.revision, version.views[v].scene, *renders[v]);
    publish_cost("rendering", version, live, redone, renders);
  }
  stop();
}

void EditorSession::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  feed_.close();
}

bool EditorSession::stopped() const {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace wale
