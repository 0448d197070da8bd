#include "host/serve/editor_session.h"

#include <fmt/format.h>

#include <algorithm>

#include "geom/error.h"
#include "host/display_picture.h"
#include "host/json_text.h"
#include "host/serve/camera_move.h"
#include "host/serve/control_values.h"

namespace wale {
namespace {

using Kind = EditorRequest::Kind;
using Clock = std::chrono::steady_clock;
using Texts = std::vector<std::string>;

constexpr std::chrono::milliseconds kStateInterval{40};

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

std::string EditorSession::state_json() const {
  return state_message(revision_, edited_, settings_, editor_views(edited_, settings_, camera()), fault_);
}

// Not for each of many edits that come at once.
void EditorSession::publish_state(bool now) {
  const std::lock_guard lock(mutex_);
  if (!dirty_ || (!now && Clock::now() - last_state_ < kStateInterval)) return;
  feed_.publish("state", "application/json", state_json());
  dirty_ = false;
  last_state_ = Clock::now();
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
