#pragma once
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geom/error.h"

namespace wale {

/// A value with the place it came from, such as "curves[3].points[0]", for the error message.
class JsonValue {
 public:
  JsonValue(const std::string& file, std::string place, const nlohmann::json& json)
      : file_(file), place_(std::move(place)), json_(json) {}

  void only(std::initializer_list<const char*> keys) const {
    if (!json_.is_object()) complain("an object is expected");
    for (const auto& item : json_.items())
      if (std::none_of(keys.begin(), keys.end(), [&](const char* key) { return item.key() == key; }))
        complain(fmt::format("unknown key '{}'; the keys are {}", item.key(), fmt::join(keys, ", ")));
  }
  std::vector<std::string> keys() const {
    if (!json_.is_object()) complain("an object is expected");
    std::vector<std::string> result;
    for (const auto& item : json_.items()) result.push_back(item.key());
    return result;
  }
  bool is_text() const { return json_.is_string(); }
  bool is_list() const { return json_.is_array(); }
  bool is_null() const { return json_.is_null(); }
  bool has(const char* key) const { return json_.contains(key); }
  JsonValue operator[](const char* key) const {
    if (!json_.contains(key)) complain(fmt::format("key '{}' is missing", key));
    return {file_, place_.empty() ? key : place_ + "." + key, json_.at(key)};
  }
  std::vector<JsonValue> items() const {
    if (!json_.is_array()) complain("a list is expected");
    std::vector<JsonValue> result;
    for (size_t i = 0; i < json_.size(); ++i) result.push_back({file_, fmt::format("{}[{}]", place_, i), json_[i]});
    return result;
  }
  std::vector<JsonValue> items(size_t count) const {
    if (!json_.is_array() || json_.size() != count) complain(fmt::format("a list of {} numbers is expected", count));
    return items();
  }
  double number() const {
    if (!json_.is_number()) complain("a number is expected");
    const double value = json_.get<double>();
    if (!std::isfinite(value)) complain("the number is not finite");
    return value;
  }
  int whole() const {
    if (!json_.is_number_integer()) complain("a whole number is expected");
    const double value = json_.get<double>();
    if (std::abs(value) > 1e9) complain("the number is too large");
    return static_cast<int>(value);
  }
  bool truth() const {
    if (!json_.is_boolean()) complain("true or false is expected");
    return json_.get<bool>();
  }
  std::string text() const {
    if (!json_.is_string()) complain("a text is expected");
    return json_.get<std::string>();
  }
  /// The same, under another place in messages.
  JsonValue called(const std::string& place) const { return {file_, place, json_}; }
  [[noreturn]] void complain(const std::string& what) const {
    user_error("{}: {}{}{}", file_, place_, place_.empty() ? "" : ": ", what);
  }

 private:
  const std::string& file_;
  std::string place_;
  const nlohmann::json& json_;
};

/// The text as JSON; throws a user error naming file and line.
nlohmann::json parse_json(std::string_view text, const std::string& file);

}  // namespace wale
