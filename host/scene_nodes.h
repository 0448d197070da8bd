#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "geom/vec.h"
#include "host/json_document.h"
#include "host/scene.h"

// Values of nodes that the schema has checked already.
namespace wale {

/// Throws the user error "place: path: ..." of a node.
template <typename... Args>
[[noreturn]] void fail(const JsonNode& node, const std::string& path, fmt::format_string<Args...> format,
                       Args&&... args) {
  fail_at(node.place, path, fmt::format(format, std::forward<Args>(args)...));
}

inline double number_of(const JsonNode& node, std::string_view key) { return node[key].number; }
inline int integer_of(const JsonNode& node, std::string_view key) { return static_cast<int>(node[key].number); }

inline std::string text_or(const JsonNode& node, std::string_view key, const std::string& otherwise) {
  return node.has(key) ? node[key].text : otherwise;
}

inline dvec3 vector_of(const JsonNode& node) {
  return {node.items[0].number, node.items[1].number, node.items[2].number};
}
inline dvec2 pair_of(const JsonNode& node) { return {node.items[0].number, node.items[1].number}; }
inline Rgb color_of(const JsonNode& node) { return {node.items[0].number, node.items[1].number, node.items[2].number}; }

inline std::optional<double> maybe_number(const JsonNode& node, std::string_view key) {
  return node.has(key) ? std::optional(number_of(node, key)) : std::nullopt;
}

inline std::optional<Rgb> maybe_color(const JsonNode& node, std::string_view key) {
  return node.has(key) ? std::optional(color_of(node[key])) : std::nullopt;
}

inline dvec3 nonzero_direction(const JsonNode& node, const std::string& path) {
  const dvec3 v = vector_of(node);
  if (glm::length(v) < 1e-9) fail(node, path, "a direction of length 0");
  return v;
}

}  // namespace wale
