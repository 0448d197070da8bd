#include <fmt/format.h>

#include <algorithm>

#include "host/accuracy.h"
#include "host/serve/control_table.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;

void view(ControlTable& table) {
  Control& lit = table.choice("view.lit", "View", "Lit from", "the lamps as they are, or all on one side of the cloth",
                              {{"scene", "as in the scene"},
                               {"front", "the front"},
                               {"back", "behind"},
                               {"both", "front and behind, side by side"}},
                              table.settings.lit);
  lit.path.clear();
  lit.set = nullptr;
  if (table.scene().camera_given && !table.scene().camera.orthographic)
    table.number("camera.fov", "View", "Angle of view", "vertical", 2, 90, 0.5,
                 table.scene().camera.fov * 57.29577951308232, "°");
  table.number("film.exposure", "View", "Exposure", "stops; of the picture on the screen", -6, 6, 0.1,
               table.scene().film.exposure, "stops");
  table.choice("film.view", "View", "Tone curve", "of the picture on the screen",
               {{"neutral", "neutral"}, {"srgb", "none (sRGB)"}}, table.scene().film.view);
}

void accuracy(ControlTable& table) {
  std::vector<std::pair<std::string, std::string>> words;
  std::string now;
  for (const AccuracyPreset& preset : accuracy_presets()) {
    words.emplace_back(preset.name, preset.name + ": " + preset.doc);
    const bool all = std::all_of(preset.levels.begin(), preset.levels.end(), [&](const auto& level) {
      return accuracy_option(level.first).at(table.scene()) == level.second;
    });
    if (all && now.empty()) now = preset.name;
  }
  if (now.empty()) words.emplace_back(now = "(the scene's)", "the scene's own mixture");
  Control& c = table.choice("accuracy", "Accuracy", "Preset", "what every accuracy option is set to (docs/accuracy.md)",
                            words, now);
  c.path = "integrator, fabrics.*";
  c.set = [](double, const std::string& text) {
    return text == "(the scene's)" ? Texts{} : accuracy_preset(text).overrides();
  };
  Control& goal = table.add(
      {"view.goal", "Accuracy", "Goal", "", "error of the picture's tiles at which it is done", Control::Kind::choice});
  goal.words = {{"0.2", "20 %"}, {"0.1", "10 %"}, {"0.05", "5 %"}, {"0.02", "2 %"}, {"0.01", "1 %"}};
  goal.text = fmt::format("{:g}", table.settings.goal);
}

}  // namespace

void add_view_controls(ControlTable& table) {
  view(table);
  accuracy(table);
}

}  // namespace wale
