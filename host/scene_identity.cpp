#include "host/scene_identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "geom/byte_source.h"
#include "host/accuracy.h"
#include "host/animation.h"
#include "host/json_document.h"
#include "host/scene_overrides.h"

namespace wale {
namespace {

// Removes what "key.path" names, "*" standing for every element of a list.
void remove(JsonNode& node, std::string_view path) {
  const size_t dot = path.find('.');
  const std::string_view key = path.substr(0, dot);
  const bool last = dot == std::string_view::npos;
  if (key == "*") {
    for (JsonNode& item : node.items) remove(item, path.substr(dot + 1));
  } else if (last) {
    std::erase_if(node.members, [&](const auto& member) { return member.key == key; });
  } else if (JsonNode* child = node.find(key)) {
    remove(*child, path.substr(dot + 1));
  }
}

// Members sorted; objects without any are left out, as they say nothing.
std::string canonical(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::null:
      return "null";
    case JsonNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Kind::integer:
    case JsonNode::Kind::number:
      return fmt::format("{}", node.number);
    case JsonNode::Kind::string:
      return fmt::format("\"{}:{}\"", node.text.size(), node.text);
    case JsonNode::Kind::array: {
      std::string out = "[";
      for (const JsonNode& item : node.items) out += canonical(item) + ",";
      return out + "]";
    }
    case JsonNode::Kind::object: {
      std::vector<std::string> members;
      for (const auto& member : node.members)
        if (const std::string value = canonical(member.value); value != "{}")
          members.push_back(fmt::format("{}:{}={}", member.key.size(), member.key, value));
      std::sort(members.begin(), members.end());
      std::string out = "{";
      for (const auto& member : members) out += member + ",";
      return out + "}";
    }
  }
  return {};
}

}  // namespace

std::string scene_identity(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  JsonNode document = read_json(file);
  apply_overrides(document, overrides);
  apply_key_frames(document);
  if (document.has("animation")) apply_overrides(document, overrides);
  forget_key_frames(document);
  for (const char* key : {"film.size", "film.exposure", "film.view", "integrator.spp", "integrator.seed",
                          "integrator.lanes", "integrator.pool"})
    remove(document, key);
  for (const AccuracyOption& option : accuracy_options())
    for (const AccuracyLevel& level : option.levels)
      for (const std::string& text : level.overrides) remove(document, text.substr(0, text.find('=')));
  return fmt::format("{:016x}", hash_bytes(canonical(document)));
}

std::string accuracy_settings(const Scene& scene) {
  std::string out;
  for (const AccuracyOption& option : accuracy_options())
    out += (out.empty() ? "" : ", ") + option.name + " " + option.at(scene);
  return out;
}

}  // namespace wale
