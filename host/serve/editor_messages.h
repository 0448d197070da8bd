#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/serve/controls.h"
#include "host/serve/live_views.h"

namespace wale {

/// An edit that passed the schema and could not be made.
struct RefusedEdit {
  std::string control, line;
};

/// One picture on the page: the edited scene, with more overrides that are not kept.
struct EditorView {
  std::string name;
  std::vector<std::string> more;
};

/// The views that the settings ask for, seen by this camera.
std::vector<EditorView> editor_views(const EditedScene& edited, const EditorSettings& settings,
                                     const CameraScene& camera);

/// The message `state`: what is edited, as JSON.
std::string state_message(uint64_t revision, const EditedScene& edited, const EditorSettings& settings,
                          const std::vector<EditorView>& views, const std::optional<RefusedEdit>& refused);

/// The message `cost`: how far the pictures are and what it took. `status`: starting, changing, rendering or done.
std::string cost_message(const std::string& status, uint64_t revision, double goal, const LiveViews& views,
                         const Redone& redone, size_t viewers);

}  // namespace wale
