#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/json_text.h"
#include "host/serve/control_table.h"
#include "host/serve/control_values.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;

void light(ControlTable& table, size_t l) {
  const LightScene& light = table.scene().lights[l];
  const JsonNode& node = table.edited.document()["lights"].items[l];
  const std::string at = fmt::format("lights.{}.", l);
  const bool sky = light.kind == LightScene::Kind::environment;
  const std::string name = sky ? "Sky" : node.has("name") ? light.name : fmt::format("Light {}", l + 1);
  const JsonNode* intensity = node.find("intensity");
  table.number(at + "intensity", "Light", name + " brightness", "factor on its radiance", 0, 4, 0.02,
               intensity && intensity->is_number() ? intensity->number : 1);
  if (sky && !light.file.empty())
    table.number(at + "rotation", "Light", "Sky rotation", "about up", -180, 180, 1, light.rotation * 57.29577951308232,
                 "°");
  if (light.kind != LightScene::Kind::quad && light.kind != LightScene::Kind::sphere) return;
  const dvec3 target = light.kind == LightScene::Kind::quad ? light.look_at : table.scene().camera.look_at;
  const dvec3 up = table.scene().camera_given ? table.edited.opened().camera.up : dvec3(0, 1, 0);
  const double distance = glm::length(light.position - target);
  if (!(distance > 0)) return;
  const LightAngles now = light_angles(light.position - target, up);
  const auto angle = [&](const char* part, const std::string& label, double range, double value, bool around) {
    Control& c = table.number(at + "position", "Light", label, "where it stands around what it shines at", -range,
                              range, 1, value, "°");
    c.id += part;
    c.set = [=, unit = table.edited.metres_per_unit(), quad = light.kind == LightScene::Kind::quad](
                double v, const std::string&) {
      const dvec3 out = light_direction(around ? LightAngles{v, now.above} : LightAngles{now.around, v}, up);
      Texts set{at + "position=" + point_text(target + distance * out, unit)};
      // A quad's own up must not point along its direction.
      if (quad && glm::length(glm::cross(glm::normalize(light.up), out)) < 0.02)
        set.push_back(at + "up=" + point_text(light_direction({now.around, now.above + 90}, up), 1));
      return set;
    };
  };
  angle(".around", name + " around", 180, now.around, true);
  angle(".above", name + " above", 85, now.above, false);
}

void new_sky(ControlTable& table) {
  Control& c = table.number("lights", "Light", "Sky brightness", "radiance of a sky all around", 0, 4, 0.02, 0);
  c.id = "lights.sky";
  JsonNode list = table.edited.document()["lights"];
  c.set = [list](double v, const std::string&) {
    std::string text = json_text(list);
    text = text.substr(0, text.rfind(']'));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return Texts{"lights=" + text + (list.items.empty() ? "" : ", ") +
                 fmt::format("{{\"type\": \"environment\", \"radiance\": 1, \"intensity\": {}}}]", plain_number(v))};
  };
}

}  // namespace

void add_light_controls(ControlTable& table) {
  const std::vector<LightScene>& lights = table.scene().lights;
  for (size_t l = 0; l < lights.size(); ++l) light(table, l);
  if (std::none_of(lights.begin(), lights.end(),
                   [](const LightScene& l) { return l.kind == LightScene::Kind::environment; }))
    new_sky(table);
}

}  // namespace wale
