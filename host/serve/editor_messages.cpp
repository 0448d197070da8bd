#include "host/serve/editor_messages.h"

#include <fmt/format.h>

#include <filesystem>

#include "host/json_text.h"
#include "host/serve/light_sides.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;

std::string json_list(const Texts& texts) {
  Texts out;
  for (const std::string& text : texts) out.push_back(json_string(text));
  return fmt::format("[{}]", fmt::join(out, ", "));
}

}  // namespace

std::vector<EditorView> editor_views(const EditorState& state, const CameraScene& camera) {
  std::vector<EditorView> views;
  const EditedScene& edited = state.scene;
  const std::string& lit = state.settings.lit;
  if (lit == "scene") views.push_back({"as in the scene", {}});
  if (lit == "front" || lit == "both") views.push_back({"from the front", light_sides(edited, camera, LitSide::front)});
  if (lit == "back" || lit == "both") views.push_back({"from behind", light_sides(edited, camera, LitSide::back)});
  return views;
}

std::string state_message(const TriedEdits& edits, const std::vector<EditorView>& views) {
  const auto& [edited, settings] = edits.newest();
  const std::optional<RefusedEdit>& refused = edits.refusal();
  Texts commands, names;
  const std::string goal = fmt::format(" --error {:g}", settings.goal);
  for (const EditorView& view : views) {
    commands.push_back(edited.command(view.more, goal));
    names.push_back(view.name);
  }
  return fmt::format(
      "{{\"revision\": {}, \"scene\": {}, \"views\": {}, \"commands\": {}, \"can_undo\": {}, \"can_redo\": {}, "
      "\"edits\": {},\n \"fault\": {},\n \"controls\": {}}}\n",
      edits.revision(), json_string(std::filesystem::path(edited.scene().file).filename().string()), json_list(names),
      json_list(commands), edited.can_undo(), edited.can_redo(), json_list(edited.edits()),
      refused
          ? fmt::format("{{\"control\": {}, \"line\": {}}}", json_string(refused->control), json_string(refused->line))
          : "null",
      controls_json(controls_of(edited, settings)));
}

std::string cost_message(const std::string& status, uint64_t revision, double goal, const LiveViews& views,
                         const Redone& redone, size_t viewers) {
  const ViewsProgress p = views.progress(goal);
  return fmt::format(
      "{{\"status\": \"{}\", \"revision\": {}, \"samples\": {}, \"error\": {:.4g}, \"goal\": {:g}, "
      "\"seconds\": {:.3g}, \"seconds_to_goal\": {}, \"mrays\": {:.3g}, \"segments\": {}, "
      "\"knitted\": {}, \"geometry\": {}, \"edit_seconds\": {:.3g}, \"viewers\": {}, "
      "\"not_finite\": {}, \"not_finite_since_start\": {}}}",
      status, revision, p.samples, p.error, goal, p.seconds, p.to_goal ? fmt::format("{:.3g}", *p.to_goal) : "null",
      p.mrays, views.segments(), redone.knitted, redone.fabrics, redone.host_seconds + redone.device_seconds, viewers,
      p.not_finite, p.not_finite_since_start);
}

}  // namespace wale
