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

// Edits of one gesture that set the same keys are one stroke: the newest stands for them all.
EditorChange scene_change(const Texts& set, const std::string& gesture, const std::string& control) {
  EditorChange change;
  change.control = control;
  if (!set.empty())
    change.make = [=](EditorState& state) { return state.scene.edit(set, gesture), true; };
  else
    change.make = [](EditorState&) { return false; };
  if (gesture.empty()) return change;
  change.stroke = gesture;
  for (const std::string& one : set) change.stroke.append(1, '\n').append(one, 0, one.find('='));
  return change;
}

}  // namespace

EditorSession::EditorSession(EditedScene scene, const EditorOptions& options)
    : options_(options), feed_(options.viewers), edits_({std::move(scene), {}}) {}

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
      return changed([&] { return scene_change(request.set, request.gesture, request.control); });
    case Kind::control:
      return changed([&] { return control_change(request); });
    case Kind::camera:
      return changed([&] { return camera_change(request); });
    case Kind::undo:
      return changed([&] { return undo_of(edits_.newest()); });
    case Kind::redo:
      return changed([&] { return redo_of(edits_.newest()); });
    case Kind::reset:
      return changed([] { return EditorChange{[](EditorState& state) { return state.scene.reset(); }}; });
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

HttpReply EditorSession::changed(const std::function<EditorChange()>& change) {
  HttpReply reply;
  {
    const std::lock_guard lock(mutex_);
    try {
      edits_.change(change());
      dirty_ = true;
      reply.body = fmt::format("{{\"revision\": {}}}\n", edits_.revision());
    } catch (const Error& error) {
      reply = refusal(error.fault() == Fault::user ? 400 : 500, error.what());
    }
  }
  wake_.notify_all();
  publish_state(false);
  return reply;
}

EditorChange EditorSession::control_change(const EditorRequest& request) const {
  const EditorState& now = edits_.newest();
  const std::vector<Control> controls = controls_of(now.scene, now.settings);
  const auto found =
      std::find_if(controls.begin(), controls.end(), [&](const Control& c) { return c.id == request.control; });
  if (found == controls.end()) user_error("\"{}\": there is no such control", one_line(request.control));
  if (!found->set)
    return {[control = *found, value = request.value](EditorState& state) {
              return set_setting(state.settings, control, value), true;
            },
            request.control};
  return scene_change(overrides_of(*found, request.value), request.gesture, request.control);
}

CameraScene EditorSession::camera(const EditorState& state) const {
  return state.scene.scene().camera_given ? state.scene.scene().camera : framed_;
}

EditorChange EditorSession::camera_change(const EditorRequest& r) const {
  const EditedScene& edited = edits_.newest().scene;
  const CameraScene next = moved_camera(camera(edits_.newest()), {r.orbit[0], r.orbit[1], r.pan[0], r.pan[1], r.zoom});
  const double unit = edited.metres_per_unit();
  const auto point = [&](const dvec3& p) { return point_text(p, unit); };
  Texts set;
  if (!edited.scene().camera_given)
    set.push_back(fmt::format("camera={{\"position\": {}, \"look_at\": {}, \"up\": [0,1,0], \"fov\": {}}}",
                              point(next.position), point(next.look_at), plain_number(next.fov * 57.29577951308232)));
  else
    set = {"camera.position=" + point(next.position), "camera.look_at=" + point(next.look_at)};
  if (next.orthographic) set.push_back("camera.height=" + plain_number(next.height / unit));
  return scene_change(set, r.gesture, "camera");
}

HttpReply EditorSession::save(const EditorRequest& request) {
  const std::lock_guard lock(mutex_);
  try {
    const auto file = edits_.newest().scene.save(request.file, request.replace);
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
  return state_message(edits_, editor_views(edits_.newest(), camera(edits_.newest())));
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
