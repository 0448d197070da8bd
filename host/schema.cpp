#include "host/schema.h"

#include <fmt/format.h>

#include <cmath>

namespace wale {
namespace {

using Kind = SchemaType::Kind;

std::shared_ptr<SchemaType> make(Kind kind) {
  auto type = std::make_shared<SchemaType>();
  type->kind = kind;
  return type;
}

}  // namespace

bool Range::contains(double x) const {
  if (!(open ? x > min : x >= min) || !(open_max ? x < max : x <= max)) return false;  // refuses NaN
  return gap == 0 || x == 0 || std::abs(x) >= gap;
}

std::string Range::text() const {
  if (gap > 0) return fmt::format("0, {:g} to {:g} or {:g} to {:g}", gap, max, min, -gap);
  const bool bounded_below = min > std::numeric_limits<double>::lowest();
  const bool bounded_above = max < std::numeric_limits<double>::max();
  if (open && open_max) return fmt::format("above {:g}, below {:g}", min, max);
  if (bounded_below && open)
    return bounded_above ? fmt::format("above {:g}, up to {:g}", min, max) : fmt::format("above {:g}", min);
  if (bounded_below) return bounded_above ? fmt::format("{:g} to {:g}", min, max) : fmt::format("{:g} or more", min);
  return bounded_above ? fmt::format("{:g} or less", max) : "any finite number";
}

Type truth() { return make(Kind::truth); }

Type only_true() {
  auto type = make(Kind::truth);
  type->only_true = true;
  return type;
}

Type integer(Range range) {
  auto type = make(Kind::integer);
  type->range = range;
  return type;
}

Type number(Range range, Unit unit) {
  auto type = make(Kind::number);
  type->range = range;
  type->unit = unit;
  return type;
}

Type text() { return make(Kind::string); }

Type word(std::vector<std::string> words) {
  auto type = make(Kind::word);
  type->words = std::move(words);
  return type;
}

Type one_of(std::vector<int> integers) {
  auto type = make(Kind::choice_of_integers);
  type->integers = std::move(integers);
  return type;
}

Type file() { return make(Kind::file); }

Type color() {
  auto type = make(Kind::color);
  type->range = {0, 1};
  return type;
}

Type radiance() {
  auto type = make(Kind::radiance);
  type->range = {0, 1e9};
  return type;
}

Type vector(size_t length, Range range, Unit unit, bool whole) {
  auto type = make(Kind::vector);
  type->length = length;
  type->range = range;
  type->unit = unit;
  type->whole = whole;
  return type;
}

Type list(Type item, size_t fewest) {
  auto type = make(Kind::list);
  type->length = fewest;
  type->item = std::move(item);
  return type;
}

Type map(Type item) {
  auto type = make(Kind::map);
  type->item = std::move(item);
  return type;
}

Type object(std::vector<Property> properties, std::vector<KeyGroup> groups) {
  auto type = make(Kind::object);
  type->properties = std::move(properties);
  type->groups = std::move(groups);
  return type;
}

Type tagged(std::string tag, std::vector<std::pair<std::string, Type>> alternatives, std::string default_tag) {
  auto type = make(Kind::tagged);
  type->tag = std::move(tag);
  type->default_tag = std::move(default_tag);
  for (auto& [name, alternative] : alternatives) {
    type->words.push_back(name);
    type->alternatives.push_back(std::move(alternative));
  }
  return type;
}

Type either(std::vector<std::pair<std::string, Type>> alternatives) {
  auto type = make(Kind::either);
  for (auto& [key, alternative] : alternatives) {
    type->told_by.push_back(key);
    type->alternatives.push_back(std::move(alternative));
  }
  return type;
}

Type any() { return make(Kind::any); }

double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace wale
