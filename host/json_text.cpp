#include "host/json_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace wale {
namespace {

constexpr size_t kLine = 100;  // characters

std::string scalar(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Kind::integer:
    case JsonNode::Kind::number:
      return fmt::format("{}", node.number);
    case JsonNode::Kind::string:
      return json_string(node.text);
    default:
      return "null";
  }
}

std::string text_of(const JsonNode& node, size_t indent) {
  const bool list = node.kind == JsonNode::Kind::array;
  if (!list && node.kind != JsonNode::Kind::object) return scalar(node);
  std::vector<std::string> parts;
  size_t length = 0;
  for (const JsonNode& item : node.items)
    if (list) parts.push_back(text_of(item, indent + 2));
  if (!list)
    for (const auto& member : node.members)
      parts.push_back(json_string(member.key) + ": " + text_of(member.value, indent + 2));
  bool lines = indent == 0;
  for (const std::string& part : parts) {
    length += part.size() + 2;
    lines |= part.find('\n') != std::string::npos;
  }
  const char *open = list ? "[" : "{", *close = list ? "]" : "}";
  if (parts.empty() || (!lines && indent + length < kLine))
    return open + fmt::format("{}", fmt::join(parts, ", ")) + close;
  const std::string margin(indent + 2, ' ');
  return fmt::format("{}\n{}{}\n{}{}", open, margin, fmt::join(parts, ",\n" + margin), std::string(indent, ' '), close);
}

}  // namespace

std::string json_text(const JsonNode& node) { return text_of(node, 0) + "\n"; }

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace wale
