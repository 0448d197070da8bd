#include <nlohmann/json.hpp>

#include "geom/error.h"
#include "host/schema.h"

namespace wale {
namespace {

using nlohmann::ordered_json;
using Kind = SchemaType::Kind;

void add_range(ordered_json& out, const Range& range) {
  if (range.gap > 0) {
    out["anyOf"] = {{{"const", 0}},
                    {{"minimum", range.gap}, {"maximum", range.max}},
                    {{"minimum", range.min}, {"maximum", -range.gap}}};
    return;
  }
  if (range.min > std::numeric_limits<double>::lowest()) out[range.open ? "exclusiveMinimum" : "minimum"] = range.min;
  if (range.max < std::numeric_limits<double>::max()) out[range.open_max ? "exclusiveMaximum" : "maximum"] = range.max;
}

ordered_json number_text(const Range& range, bool whole) {
  ordered_json out = {{"type", whole ? "integer" : "number"}};
  add_range(out, range);
  return out;
}

ordered_json numbers_text(size_t length, const Range& range, bool whole) {
  return {{"type", "array"}, {"items", number_text(range, whole)}, {"minItems", length}, {"maxItems", length}};
}

ordered_json text_of(const SchemaType& type);

std::string unit_text(const SchemaType& type) {
  if (type.unit == Unit::length) return " (length in the file's units)";
  if (type.unit == Unit::angle) return " (degrees)";
  return "";
}

// A preset is JSON, or a bare word.
ordered_json parsed_preset(const std::string& preset) {
  const ordered_json value = ordered_json::parse(preset, nullptr, false);
  return value.is_discarded() ? ordered_json(preset) : value;
}

ordered_json object_text(const SchemaType& type, const std::string& tag, const std::string& tag_value,
                         bool tag_needed) {
  ordered_json out = {{"type", "object"}, {"additionalProperties", false}};
  ordered_json properties = ordered_json::object();
  ordered_json required = ordered_json::array();
  if (!tag.empty()) {
    properties[tag] = {{"const", tag_value}};
    if (tag_needed) required.push_back(tag);
  }
  for (const auto& property : type.properties) {
    ordered_json p = text_of(*property.type);
    p["description"] = property.doc + unit_text(*property.type);
    if (!property.preset.empty()) {
      // Presets give lengths in metres, "default" must read like the file does.
      if (property.type->unit == Unit::length)
        p["description"] = fmt::format("{}{}; default {} m", property.doc, unit_text(*property.type), property.preset);
      else
        p["default"] = parsed_preset(property.preset);
    }
    properties[property.name] = p;
    if (property.required) required.push_back(property.name);
  }
  out["properties"] = properties;
  if (!required.empty()) out["required"] = required;
  ordered_json all = ordered_json::array();
  for (const auto& group : type.groups) {
    ordered_json choices = ordered_json::array(), any = ordered_json::array();
    for (const auto& key : group.keys) {
      choices.push_back({{"required", {key}}});
      any.push_back({{"required", {key}}});
    }
    if (!group.exactly_one) choices.push_back({{"not", {{"anyOf", any}}}});
    all.push_back({{"oneOf", choices}});
  }
  if (!all.empty()) out["allOf"] = all;
  return out;
}

ordered_json text_of(const SchemaType& type) {
  ordered_json out;
  switch (type.kind) {
    case Kind::truth:
      if (type.only_true) return {{"const", true}};
      return {{"type", "boolean"}};
    case Kind::integer:
      return number_text(type.range, true);
    case Kind::number:
      return number_text(type.range, false);
    case Kind::string:
    case Kind::file:
      return {{"type", "string"}};
    case Kind::word:
      return {{"enum", type.words}};
    case Kind::choice_of_integers:
      return {{"enum", type.integers}};
    case Kind::color:
      return {{"oneOf", {{{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}}, numbers_text(3, type.range, false)}}};
    case Kind::radiance:
      return {{"oneOf", {number_text(type.range, false), numbers_text(3, type.range, false)}}};
    case Kind::vector:
      return numbers_text(type.length, type.range, type.whole);
    case Kind::list:
      return {{"type", "array"}, {"items", text_of(*type.item)}, {"minItems", type.length}};
    case Kind::map:
      return {{"type", "object"}, {"additionalProperties", text_of(*type.item)}};
    case Kind::object:
      return object_text(type, "", "", false);
    case Kind::tagged: {
      ordered_json choices = ordered_json::array();
      for (size_t i = 0; i < type.words.size(); ++i)
        choices.push_back(
            object_text(*type.alternatives[i], type.tag, type.words[i], type.words[i] != type.default_tag));
      return {{"oneOf", choices}};
    }
    case Kind::either: {
      ordered_json choices = ordered_json::array();
      for (const auto& alternative : type.alternatives) choices.push_back(text_of(*alternative));
      return {{"oneOf", choices}};
    }
    case Kind::any:
      return ordered_json::object();
  }
  bug("schema: a kind of type without text");
}

}  // namespace

std::string schema_text(const SchemaType& type, const std::string& title) {
  ordered_json out = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  out.update(text_of(type));
  return out.dump(2) + "\n";
}

}  // namespace wale
