#include "host/scene_fabrics.h"

#include "host/scene_materials.h"
#include "host/scene_nodes.h"

namespace wale {
namespace {

FabricScale scale_of(const JsonNode& node) {
  constexpr double kPerMetre = 10;  // gauge is per 10 cm
  FabricScale scale;
  if (node.has("repeats")) {
    scale.repeats = pair_of(node["repeats"]);
  } else if (node.has("gauge")) {
    const JsonNode& gauge = node["gauge"];
    scale.kind = FabricScale::Kind::gauge;
    scale.gauge = {kPerMetre * number_of(gauge, "wales"),
                   gauge.has("courses") ? kPerMetre * number_of(gauge, "courses") : 0.0};
  } else {
    scale.kind = FabricScale::Kind::uv_metres;
  }
  return scale;
}

Detail detail_of(const std::string& word) {
  return word == "none"    ? Detail::none
         : word == "paper" ? Detail::paper
         : word == "maps"  ? Detail::maps
                           : Detail::fibres;
}

Storage storage_of(const std::string& word) {
  return word == "auto" ? Storage::automatic : word == "stored" ? Storage::stored : Storage::procedural;
}

FlyawaySpec flyaways_of(const JsonNode& node, const std::string& path) {
  constexpr double kPerMillimetre = 1e3;
  for (const auto& [key, most] : {std::pair{"length", kLongestFlyaway}, std::pair{"radius", kThickestFlyaway}})
    if (number_of(node, key) > most)
      fail(node[key], path + ".flyaways." + key, "{:g} mm is longer than any; valid: 0 to {:g} mm",
           kPerMillimetre * number_of(node, key), kPerMillimetre * most);
  return {kPerMillimetre * number_of(node, "hairs"), kPerMillimetre * number_of(node, "loops"),
          number_of(node, "length"), number_of(node, "radius")};
}

}  // namespace

FabricScene fabric_of(Scene& scene, const JsonNode& node, size_t index, const SceneMoment& moment) {
  const std::string path = fmt::format("fabrics.{}", index);
  const JsonNode& yarn = node["yarn"];
  FabricScene fabric;
  fabric.spec.name = text_or(node, "name", fmt::format("fabric{}", index));
  fabric.spec.scale = scale_of(node);
  fabric.spec.plies = integer_of(yarn, "plies");
  fabric.spec.twist_pitch = number_of(yarn, "twist_pitch");
  fabric.spec.thickness = number_of(yarn, "thickness");
  fabric.spec.ply_radius = number_of(yarn, "ply_radius");
  fabric.spec.height_offset = number_of(node, "height_offset");
  fabric.spec.tolerance = number_of(node, "tolerance");
  fabric.spec.flyaways = flyaways_of(node["flyaways"], path);
  fabric.spec.detail = detail_of(node["detail"].text);
  fabric.spec.strain = node["strain"].text == "relaxed" ? LoopStrain::relaxed : LoopStrain::affine;
  fabric.spec.storage = storage_of(node["storage"].text);
  fabric.spec.lattice = integer_of(node, "lattice");
  fabric.mesh = mesh_of(node["mesh"], moment);
  fabric.transform = transform_of(node["transform"]);
  fabric.pattern = pattern_of(node["pattern"]);
  fabric.material = find_material(scene, node, path, true);
  if (const JsonNode* palette = node.find("palette")) {
    fabric.palette.emplace();
    for (const JsonNode& color : palette->items) fabric.palette->push_back(color_of(color));
  }
  if (const JsonNode* image = node.find("color_image"))
    fabric.color_image = {(*image)["file"].text, (*image)["map"].text == "stitches", pair_of((*image)["origin"]),
                          pair_of((*image)["size"]), (*image)["repeat"].boolean};
  return fabric;
}

}  // namespace wale
