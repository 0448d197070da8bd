#include "host/scene_materials.h"

#include <algorithm>

#include "host/material_schema.h"
#include "host/scattering_keys.h"
#include "host/scene_nodes.h"
#include "host/suggest.h"

namespace wale {
namespace {

/// Keys that say the same thing in different ways: giving one of them drops the others of the file.
bool excludes(const std::string& own, const std::string& other) {
  for (const KeyGroup& group : ply_material_groups()) {
    const auto holds = [&](const std::string& key) {
      return std::find(group.keys.begin(), group.keys.end(), key) != group.keys.end();
    };
    if (holds(own) && holds(other)) return true;
  }
  const auto colors = [](const std::string& key) { return key == "color" || key == "fibre_color"; };
  const auto bodies = [](const std::string& key) { return key == "reflect" || key == "transmit"; };
  return (colors(own) && bodies(other)) || (bodies(own) && colors(other));
}

void join(JsonNode& own, const JsonNode& base, bool top) {
  const size_t given = own.members.size();
  for (const auto& member : base.members) {
    JsonNode* same = own.find(member.key);
    if (same && same->kind == JsonNode::Kind::object && member.value.kind == JsonNode::Kind::object) {
      join(*same, member.value, false);
      continue;
    }
    bool drop = same != nullptr;
    for (size_t i = 0; top && !drop && i < given; ++i) drop = excludes(own.members[i].key, member.key);
    // The optical radius may stand in two places.
    if (const JsonNode* s = own.find("scattering"); top && s && s->kind == JsonNode::Kind::object)
      drop |= s->has("optical_radius") && (member.key == "optical_radius" || member.key == "translucency");
    if (!drop) own.members.push_back(member);
  }
}

void check_pairs(const std::string& path, const JsonNode& node) {
  if (node.has("reflect") != node.has("transmit")) {
    const bool reflect = node.has("reflect");
    fail(node[reflect ? "reflect" : "transmit"], path + (reflect ? ".reflect" : ".transmit"),
         "\"reflect\" and \"transmit\" are given both or not at all; \"{}\" is missing",
         reflect ? "transmit" : "reflect");
  }
  for (const char* key : {"color", "fibre_color"})
    if (node.has(key) && node.has("reflect"))
      fail(node[key], path + "." + key, "cannot be given together with \"reflect\" and \"transmit\"");
  if (!node.has("scattering") || !node["scattering"].has("optical_radius")) return;
  for (const char* key : {"optical_radius", "translucency"})
    if (node.has(key)) fail(node[key], path + "." + key, "cannot be given together with \"scattering.optical_radius\"");
}

Fibres fibres_of(const JsonNode& node) {
  Fibres f;
  if (node.has("count")) f.count = integer_of(node, "count");
  if (node.has("seed")) f.seed = static_cast<uint32_t>(number_of(node, "seed"));
  const std::pair<const char*, std::optional<double>*> numbers[] = {
      {"packing", &f.packing},
      {"twist", &f.twist},
      {"radial_beta", &f.radial_beta},
      {"radial_epsilon", &f.radial_epsilon},
      {"migration_min", &f.migration_min},
      {"migration_rate", &f.migration_rate},
      {"transmit_width", &f.transmit_width},
      {"transmit_azimuth_width", &f.transmit_azimuth_width}};
  for (const auto& [key, value] : numbers) *value = maybe_number(node, key);
  return f;
}

PlyAppearance ply_of(const JsonNode& node) {
  PlyAppearance ply;
  ply.preset = node["preset"].text;
  ply.color = maybe_color(node, "color");
  ply.fibre_color = maybe_color(node, "fibre_color");
  ply.forward = maybe_color(node, "transmit");
  ply.back = maybe_color(node, "reflect");
  ply.roughness = maybe_number(node, "roughness");
  ply.gloss = maybe_number(node, "gloss");
  ply.ior = maybe_number(node, "ior");
  ply.optical_radius = maybe_number(node, "optical_radius");
  ply.translucency = maybe_number(node, "translucency");
  ply.fibre_twist = maybe_number(node, "fibre_twist");
  if (const JsonNode* scattering = node.find("scattering"))
    for (const ScatteringKey& k : kScatteringKeys) ply.scattering.*k.given = maybe_number(*scattering, k.key);
  if (const JsonNode* fibres = node.find("fibres")) ply.fibres = fibres_of(*fibres);
  if (const JsonNode* plies = node.find("plies"))
    for (const JsonNode& color : plies->items) ply.plies.push_back(color_of(color));
  if (const JsonNode* stripes = node.find("stripes"))
    for (const JsonNode& stripe : stripes->items)
      ply.stripes.push_back({color_of(stripe["color"]), number_of(stripe, "length")});
  if (const JsonNode* heather = node.find("heather")) {
    ply.heather_yarn = number_of(*heather, "yarn");
    ply.heather_ply = number_of(*heather, "ply");
  }
  return ply;
}

}  // namespace

void join_material_files(JsonNode& scene, const std::filesystem::path& folder) {
  JsonNode* materials = scene.find("materials");
  if (!materials || materials->kind != JsonNode::Kind::object) return;
  for (auto& [name, place, node] : materials->members) {
    const JsonNode* file = node.find("file");
    if (!file || file->kind != JsonNode::Kind::string || file->text.empty()) continue;
    const auto path = std::filesystem::absolute(folder / file->text).lexically_normal();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    join_material(name, node, read_json(path));
  }
}

void join_material(const std::string& name, JsonNode& node, JsonNode base) {
  if (base.kind != JsonNode::Kind::object)
    fail(base, "materials." + name, "a ply material is needed in this file, not {}", base.describe());
  if (const JsonNode* type = base.find("type"); type && type->kind == JsonNode::Kind::string && type->text != "ply")
    fail(*type, "materials." + name, "a material of type \"ply\" is needed in this file, not \"{}\"", type->text);
  if (JsonNode* fitted = base.find("scattering"); fitted && (node.has("optical_radius") || node.has("translucency")))
    std::erase_if(fitted->members, [](const JsonNode::Member& m) { return m.key == "optical_radius"; });
  if (const JsonNode* again = base.find("file"))
    fail(*again, "materials." + name + ".file", "a material file cannot name another one");
  join(node, base, true);
}

MaterialSpec material_of(const std::string& name, const JsonNode& node) {
  MaterialSpec material;
  material.name = name;
  material.ply = node["type"].text == "ply";
  if (material.ply) {
    check_pairs("materials." + name, node);
    material.yarn = ply_of(node);
    return material;
  }
  material.surface.coated = node["type"].text == "coated";
  material.surface.color = color_of(node["color"]);
  if (material.surface.coated) {
    material.surface.roughness = number_of(node, "roughness");
    material.surface.ior = number_of(node, "ior");
  }
  return material;
}

int find_material(Scene& scene, const JsonNode& user, const std::string& path, bool ply) {
  const JsonNode* name = user.find("material");
  const std::string wanted = name ? name->text : ply ? "(wool)" : "(grey)";
  std::vector<std::string> fitting;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const MaterialSpec& material = scene.materials[i];
    if (material.name == wanted && material.ply == ply) return int(i);
    if (material.name == wanted)
      fail(*name, path + ".material", "\"{}\" is a {} material; {} is needed here", wanted,
           material.ply              ? "ply"
           : material.surface.coated ? "coated"
                                     : "diffuse",
           ply ? "one of type \"ply\"" : "one of type \"diffuse\" or \"coated\"");
    if (material.ply == ply) fitting.push_back(material.name);
  }
  if (name) fail(*name, path + ".material", "no material is named \"{}\"; {}", wanted, nearest_choice(wanted, fitting));
  MaterialSpec made;
  made.name = wanted;
  made.ply = ply;
  scene.materials.push_back(made);
  return int(scene.materials.size()) - 1;
}

}  // namespace wale
