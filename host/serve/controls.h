#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/serve/edited_scene.h"

namespace wale {

/// What the editor shows that is no value of the scene.
struct EditorSettings {
  std::string lit = "scene";  ///< scene, front, back, both: which side of the cloth the lamps are on
  double goal = 0.05;         ///< error of a tile at which the picture is done (host/tile_error.h)

  bool operator==(const EditorSettings&) const = default;
};

/// One control of the page: what it is called, the scene's value behind it, and which overrides set it.
struct Control {
  enum class Kind { number, choice, color };
  std::string id, group, label;
  std::string path;  ///< key of the scene; empty for a setting of the editor
  std::string doc;   ///< one line for the user
  Kind kind = Kind::number;
  double low = 0, high = 1, step = 0.01;                     ///< number
  std::string unit{};                                        ///< number
  std::vector<std::pair<std::string, std::string>> words{};  ///< choice: value and what is shown
  double number = 0;                                         ///< value of a number
  std::string text{};                                        ///< value of a choice, or of a colour as "#rrggbb"
  std::function<std::vector<std::string>(double number, const std::string& text)> set{};  ///< overrides
};

/// The controls of a scene, in the order in which they are shown: one table, in control_table.h and the files of its
/// rows.
std::vector<Control> controls_of(const EditedScene& scene, const EditorSettings& settings);

/// Overrides that set a control to a value from the page. Throws a user error that names the control when the value is
/// of another kind or out of its bounds.
std::vector<std::string> overrides_of(const Control& control, const JsonNode& value);

/// The value that a setting of the editor is given, checked like overrides_of().
void set_setting(EditorSettings& settings, const Control& control, const JsonNode& value);

/// The controls as a JSON list.
std::string controls_json(const std::vector<Control>& controls);

}  // namespace wale
