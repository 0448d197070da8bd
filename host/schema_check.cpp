#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/error.h"
#include "host/file_fence.h"
#include "host/schema.h"
#include "host/suggest.h"

namespace wale {
namespace {

using Kind = SchemaType::Kind;
using Node = JsonNode::Kind;

std::string joined(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

class Checker {
 public:
  explicit Checker(const SchemaContext& context) : context_(context) {}

  void check(const SchemaType& type, JsonNode& node, const std::string& path) const {
    switch (type.kind) {
      case Kind::truth:
        return check_truth(type, node, path);
      case Kind::integer:
      case Kind::number:
        return check_number(type, node, path, type.kind == Kind::integer);
      case Kind::string:
        return need(node, Node::string, "a text", path);
      case Kind::word:
        return check_word(type, node, path);
      case Kind::choice_of_integers:
        return check_choice(type, node, path);
      case Kind::file:
        return check_file(node, path);
      case Kind::color:
        return check_color(type, node, path);
      case Kind::radiance:
        return check_radiance(type, node, path);
      case Kind::vector:
        return check_vector(type, node, path);
      case Kind::list:
        return check_list(type, node, path);
      case Kind::map:
        return check_map(type, node, path);
      case Kind::object:
        return check_object(type, node, path, "");
      case Kind::tagged:
        return check_tagged(type, node, path);
      case Kind::either:
        return check_either(type, node, path);
      case Kind::any:
        return;
    }
  }

 private:
  template <typename... Args>
  [[noreturn]] static void fail(const Place& place, const std::string& path, fmt::format_string<Args...> format,
                                Args&&... args) {
    fail_at(place, path.empty() ? "the scene" : path, fmt::format(format, std::forward<Args>(args)...));
  }

  [[noreturn]] static void wrong_type(const JsonNode& node, const std::string& wanted, const std::string& path) {
    fail(node.place, path, "{} is needed here, not {}", wanted, node.describe());
  }

  static void need(const JsonNode& node, Node kind, const std::string& wanted, const std::string& path) {
    if (node.kind != kind) wrong_type(node, wanted, path);
  }

  static void check_truth(const SchemaType& type, const JsonNode& node, const std::string& path) {
    need(node, Node::boolean, type.only_true ? "true" : "true or false", path);
    if (type.only_true && !node.boolean) wrong_type(node, "true (or leave the key out)", path);
  }

  void check_number(const SchemaType& type, JsonNode& node, const std::string& path, bool whole) const {
    if (!node.is_number()) wrong_type(node, whole ? "a whole number" : "a number", path);
    if (whole && node.key_with_fraction) wrong_type(*node.key_with_fraction, "a whole number", path);
    if (whole && node.between_keys) node.number = std::round(node.number);
    if (whole && node.number != std::floor(node.number)) wrong_type(node, "a whole number", path);
    if (!type.range.contains(node.number))
      fail(node.place, path, "{:g} is out of range; valid: {}", node.number, type.range.text());
    if (type.unit == Unit::length) node.number *= context_.metres_per_unit;
    if (type.unit == Unit::angle) node.number *= std::numbers::pi / 180;
  }

  static void check_word(const SchemaType& type, const JsonNode& node, const std::string& path) {
    need(node, Node::string, fmt::format("one of \"{}\"", fmt::join(type.words, "\", \"")), path);
    if (std::find(type.words.begin(), type.words.end(), node.text) == type.words.end())
      fail(node.place, path, "\"{}\" is not known; {}", node.text, nearest_choice(node.text, type.words));
  }

  static void check_choice(const SchemaType& type, const JsonNode& node, const std::string& path) {
    if (node.key_with_fraction) return check_choice(type, *node.key_with_fraction, path);
    const bool known =
        node.is_number() && std::find(type.integers.begin(), type.integers.end(), node.number) != type.integers.end();
    if (!known)
      fail(node.place, path, "{} is not valid; valid: {}{}", node.describe(), fmt::join(type.integers, ", "),
           node.between_keys ? "; nothing lies between them, write the keys with \"hold\"" : "");
  }

  void check_file(JsonNode& node, const std::string& path) const {
    need(node, Node::string, "a file name", path);
    const auto full = std::filesystem::absolute(context_.folder / node.text).lexically_normal();
    std::error_code ignored;
    if (context_.fence && !context_.fence->admits(full))
      fail(node.place, path, "{}", context_.fence->refusal(node.text));
    if (node.text.empty() || !std::filesystem::exists(full, ignored))
      fail(node.place, path, "no file \"{}\" (looked for {}); {}", node.text, full.string(), beside(full));
    if (!std::filesystem::is_regular_file(full, ignored)) fail(node.place, path, "{} is not a file", full.string());
    node.text = full.string();
  }

  // The nearest name in the folder where the file should have been.
  static std::string beside(const std::filesystem::path& file) {
    std::error_code failed;
    std::vector<std::string> names;
    for (std::filesystem::directory_iterator at(file.parent_path(), failed), end;
         !failed && at != end && names.size() < 1000; at.increment(failed))
      names.push_back(at->path().filename().string());
    if (failed) return fmt::format("the folder {} cannot be read", file.parent_path().string());
    std::sort(names.begin(), names.end());
    const std::string advice = nearest_choice(file.filename().string(), names);
    return advice.starts_with("did") ? advice : "files are relative to the scene file";
  }

  static JsonNode number_node(double value, const Place& place) {
    JsonNode node;
    node.kind = Node::number;
    node.number = value;
    node.place = place;
    return node;
  }

  void check_color(const SchemaType& type, JsonNode& node, const std::string& path) const {
    if (node.kind == Node::string) {
      const std::string& hex = node.text;
      const bool good = hex.size() == 7 && hex[0] == '#' &&
                        std::all_of(hex.begin() + 1, hex.end(), [](unsigned char c) { return std::isxdigit(c); });
      if (!good) fail(node.place, path, "\"{}\" is no colour; valid: \"#rrggbb\" (sRGB) or [r, g, b] (linear)", hex);
      for (int i = 0; i < 3; ++i)
        node.items.push_back(
            number_node(srgb_to_linear(std::stoi(hex.substr(1 + 2 * i, 2), nullptr, 16) / 255.0), node.place));
      node.kind = Node::array;
      return;
    }
    if (node.kind != Node::array || node.items.size() != 3)
      wrong_type(node, "a colour [r, g, b] (linear, 0 to 1) or \"#rrggbb\" (sRGB)", path);
    for (size_t i = 0; i < 3; ++i) check_number(type, node.items[i], joined(path, std::to_string(i)), false);
  }

  void check_radiance(const SchemaType& type, JsonNode& node, const std::string& path) const {
    if (node.is_number()) {
      check_number(type, node, path, false);
      node.items.assign(3, number_node(node.number, node.place));
      node.kind = Node::array;
      return;
    }
    if (node.kind != Node::array || node.items.size() != 3) wrong_type(node, "a number or [r, g, b]", path);
    for (size_t i = 0; i < 3; ++i) check_number(type, node.items[i], joined(path, std::to_string(i)), false);
  }

  void check_vector(const SchemaType& type, JsonNode& node, const std::string& path) const {
    if (node.kind != Node::array || node.items.size() != type.length)
      wrong_type(node, fmt::format("a list of {} {}numbers", type.length, type.whole ? "whole " : ""), path);
    for (size_t i = 0; i < type.length; ++i)
      check_number(type, node.items[i], joined(path, std::to_string(i)), type.whole);
  }

  void check_list(const SchemaType& type, JsonNode& node, const std::string& path) const {
    need(node, Node::array, "a list", path);
    if (node.items.size() < type.length)
      fail(node.place, path, "the list is empty; give one or more, or leave the key out");
    for (size_t i = 0; i < node.items.size(); ++i) check(*type.item, node.items[i], joined(path, std::to_string(i)));
  }

  void check_map(const SchemaType& type, JsonNode& node, const std::string& path) const {
    need(node, Node::object, "an object {name: ...}", path);
    for (auto& member : node.members) check(*type.item, member.value, joined(path, member.key));
  }

  void check_object(const SchemaType& type, JsonNode& node, const std::string& path, const std::string& tag) const {
    need(node, Node::object, "an object", path);
    std::vector<std::string> keys;
    if (!tag.empty()) keys.push_back(tag);
    for (const auto& property : type.properties) keys.push_back(property.name);
    for (auto& member : node.members) {
      if (!tag.empty() && member.key == tag) continue;
      const auto property = std::find_if(type.properties.begin(), type.properties.end(),
                                         [&](const Property& p) { return p.name == member.key; });
      if (property == type.properties.end())
        fail(member.place, joined(path, member.key), "unknown key; {}", nearest_choice(member.key, keys));
      check(*property->type, member.value, joined(path, member.key));
    }
    check_groups(type, node, path);
    fill(type, node, path);
  }

  static void check_groups(const SchemaType& type, const JsonNode& node, const std::string& path) {
    for (const auto& group : type.groups) {
      const JsonNode::Member* first = nullptr;
      for (const auto& member : node.members) {
        if (std::find(group.keys.begin(), group.keys.end(), member.key) == group.keys.end()) continue;
        if (first)
          fail(member.place, joined(path, member.key), "cannot be given together with \"{}\"; choose one of \"{}\"",
               first->key, fmt::join(group.keys, "\", \""));
        first = &member;
      }
      if (!first && group.exactly_one)
        fail(node.place, path, "one of these keys is needed: \"{}\"", fmt::join(group.keys, "\", \""));
    }
  }

  void fill(const SchemaType& type, JsonNode& node, const std::string& path) const {
    for (const auto& property : type.properties) {
      if (node.has(property.name)) continue;
      if (property.required) fail(node.place, path, "the key \"{}\" is missing", property.name);
      if (property.preset.empty()) continue;
      // A preset says lengths in metres, whatever the file's units; it goes through the same check, so that the objects
      // in it are filled in turn.
      JsonNode value = parse_option_value(property.preset, "preset of " + joined(path, property.name));
      check_schema(*property.type, value, {1.0, context_.folder, context_.fence}, joined(path, property.name));
      value.place = node.place;
      node.members.push_back({property.name, node.place, std::move(value)});
    }
  }

  void check_tagged(const SchemaType& type, JsonNode& node, const std::string& path) const {
    need(node, Node::object, "an object", path);
    const JsonNode* tag = node.find(type.tag);
    std::string name = type.default_tag;
    if (tag) {
      check_word(type, *tag, joined(path, type.tag));
      name = tag->text;
    } else if (name.empty()) {
      fail(node.place, path, "the key \"{}\" is missing; valid: \"{}\"", type.tag, fmt::join(type.words, "\", \""));
    } else {
      JsonNode value;
      value.kind = Node::string;
      value.text = name;
      value.place = node.place;
      node.members.push_back({type.tag, node.place, std::move(value)});
    }
    const size_t at = std::find(type.words.begin(), type.words.end(), name) - type.words.begin();
    check_object(*type.alternatives[at], node, path, type.tag);
  }

  void check_either(const SchemaType& type, JsonNode& node, const std::string& path) const {
    std::vector<std::string> keys;
    for (size_t i = 0; i < type.alternatives.size(); ++i) {
      const std::string& key = type.told_by[i];
      if (key.empty() ? node.kind == Node::string : node.has(key)) return check(*type.alternatives[i], node, path);
      if (!key.empty()) keys.push_back(key);
    }
    if (node.kind != Node::object) wrong_type(node, "a file name or an object", path);
    // A misspelt key is the likeliest cause.
    for (const auto& member : node.members) {
      const std::string advice = nearest_choice(member.key, keys);
      if (advice.starts_with("did")) fail(member.place, joined(path, member.key), "unknown key; {}", advice);
    }
    fail(node.place, path, "one of these keys is needed: \"{}\"", fmt::join(keys, "\", \""));
  }

  const SchemaContext& context_;
};

}  // namespace

void check_schema(const SchemaType& type, JsonNode& node, const SchemaContext& context, const std::string& path) {
  Checker(context).check(type, node, path);
}

}  // namespace wale
