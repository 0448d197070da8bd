#include "host/serve/light_sides.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/json_text.h"
#include "host/serve/control_values.h"

namespace wale {

std::vector<std::string> light_sides(const EditedScene& scene, const CameraScene& camera, LitSide side) {
  std::vector<std::string> out;
  const dvec3 towards = glm::normalize(camera.position - camera.look_at);
  const auto& lights = scene.scene().lights;
  for (size_t l = 0; l < lights.size(); ++l) {
    const LightScene& light = lights[l];
    if (light.kind != LightScene::Kind::quad && light.kind != LightScene::Kind::sphere) continue;
    const double height = glm::dot(light.position - camera.look_at, towards);
    if ((height >= 0) == (side == LitSide::front)) continue;
    out.push_back(fmt::format("lights.{}.position={}", l,
                              point_text(light.position - 2 * height * towards, scene.metres_per_unit())));
  }
  const JsonNode* objects = scene.document().find("objects");
  if (side == LitSide::front || !objects) return out;
  JsonNode kept = *objects;
  std::erase_if(kept.items, [](const JsonNode& object) {
    const JsonNode* type = object.find("type");
    return type && type->text == "ground";
  });
  if (kept.items.size() < objects->items.size()) {
    std::string text = json_text(kept);
    std::replace(text.begin(), text.end(), '\n', ' ');
    out.push_back("objects=" + text);
  }
  return out;
}

}  // namespace wale
