#pragma once
#include <string>
#include <vector>

#include "host/serve/live_views.h"
#include "host/serve/tried_edits.h"

namespace wale {

/// One picture on the page: the edited scene, with more overrides that are not kept.
struct EditorView {
  std::string name;
  std::vector<std::string> more;
};

/// The views that the settings ask for, seen by this camera.
std::vector<EditorView> editor_views(const EditorState& state, const CameraScene& camera);

/// The message `state`: what is edited, as JSON.
std::string state_message(const TriedEdits& edits, const std::vector<EditorView>& views);

/// The message `cost`: how far the pictures are and what it took. `status`: starting, changing, rendering, done, or
/// stopped where no version can be shown until the next edit.
std::string cost_message(const std::string& status, uint64_t revision, double goal, const LiveViews& views,
                         const Redone& redone, size_t viewers);

}  // namespace wale
