#include "host/serve/controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/json_text.h"
#include "host/serve/control_table.h"
#include "host/serve/control_values.h"
#include "host/suggest.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;

void require(const Control& control, const JsonNode& value) {
  if (control.kind == Control::Kind::number) {
    if (!value.is_number()) user_error("{}: a number is needed here, not {}", control.label, value.describe());
    if (!(value.number >= control.low && value.number <= control.high))
      user_error("{}: {:g} is out of range; valid: {:.4g} to {:.4g}", control.label, value.number, control.low,
                 control.high);
    if (control.step == 1 && control.id.ends_with("plies") && value.number != std::floor(value.number))
      user_error("{}: a whole number is needed here, not {:g}", control.label, value.number);
    return;
  }
  if (value.kind != JsonNode::Kind::string)
    user_error("{}: a text is needed here, not {}", control.label, value.describe());
  if (control.kind == Control::Kind::color) {
    const std::string& hex = value.text;
    if (hex.size() != 7 || hex[0] != '#' || hex.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      user_error("{}: \"{}\" is no colour; valid: \"#rrggbb\"", control.label, one_line(hex.substr(0, 40)));
    return;
  }
  std::vector<std::string> names;
  for (const auto& [name, shown] : control.words) names.push_back(name);
  if (std::find(names.begin(), names.end(), value.text) == names.end())
    user_error("{}: \"{}\" is not known; {}", control.label, one_line(value.text.substr(0, 40)),
               nearest_choice(value.text.substr(0, 40), names));
}

}  // namespace

std::vector<Control> controls_of(const EditedScene& scene, const EditorSettings& settings) {
  ControlTable table(scene, settings);
  add_knit_controls(table);
  add_material_controls(table);
  add_light_controls(table);
  add_view_controls(table);
  return table.take();
}

std::vector<std::string> overrides_of(const Control& control, const JsonNode& value) {
  require(control, value);
  return control.set(value.number, value.text);
}

void set_setting(EditorSettings& settings, const Control& control, const JsonNode& value) {
  require(control, value);
  if (control.id == "view.lit") settings.lit = value.text;
  if (control.id == "view.goal") settings.goal = std::stod(value.text);
}

std::string controls_json(const std::vector<Control>& controls) {
  Texts out;
  for (const Control& c : controls) {
    std::string one =
        fmt::format("{{\"id\": {}, \"group\": {}, \"label\": {}, \"path\": {}, \"doc\": {}, ", json_string(c.id),
                    json_string(c.group), json_string(c.label), json_string(c.path), json_string(c.doc));
    if (c.kind == Control::Kind::number)
      one += fmt::format("\"type\": \"number\", \"min\": {}, \"max\": {}, \"step\": {}, \"unit\": {}, \"value\": {}}}",
                         plain_number(c.low), plain_number(c.high), plain_number(c.step), json_string(c.unit),
                         plain_number(c.number));
    else if (c.kind == Control::Kind::color)
      one += fmt::format("\"type\": \"color\", \"value\": {}}}", json_string(c.text));
    else {
      Texts words;
      for (const auto& [name, shown] : c.words)
        words.push_back(fmt::format("[{}, {}]", json_string(name), json_string(shown)));
      one += fmt::format("\"type\": \"choice\", \"words\": [{}], \"value\": {}}}", fmt::join(words, ", "),
                         json_string(c.text));
    }
    out.push_back(std::move(one));
  }
  return fmt::format("[{}]", fmt::join(out, ",\n "));
}

}  // namespace wale
