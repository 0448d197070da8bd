// Wale's own tile: {"wale_tile": 1, "name", "period": [x, y], "yarn_radius", "stitches": [wales, courses],
// "kind": "interpolating" or "bspline", "curves": [{"points": [[x, y, z], ...], "closed": false}],
// "strains": {"course": [a, ...], "wale": [b, ...], "offsets": [[[x, y, z], ...], ...]}}, in metres; strains.offsets as
// in StrainTable.
#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "geom/pattern_readers.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

using Json = nlohmann::json;

/// A value with the place it came from, such as "curves[3].points[0]", for the error message.
class Value {
 public:
  Value(const std::string& file, std::string place, const Json& json)
      : file_(file), place_(std::move(place)), json_(json) {}

  void only(std::initializer_list<const char*> keys) const {
    if (!json_.is_object()) complain("an object is expected");
    for (const auto& item : json_.items())
      if (std::none_of(keys.begin(), keys.end(), [&](const char* key) { return item.key() == key; }))
        complain(fmt::format("unknown key '{}'; the keys are {}", item.key(), fmt::join(keys, ", ")));
  }
  bool has(const char* key) const { return json_.contains(key); }
  Value operator[](const char* key) const {
    if (!json_.contains(key)) complain(fmt::format("key '{}' is missing", key));
    return {file_, place_.empty() ? key : place_ + "." + key, json_.at(key)};
  }
  std::vector<Value> items() const {
    if (!json_.is_array()) complain("a list is expected");
    std::vector<Value> result;
    for (size_t i = 0; i < json_.size(); ++i) result.push_back({file_, fmt::format("{}[{}]", place_, i), json_[i]});
    return result;
  }
  std::vector<Value> items(size_t count) const {
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
  [[noreturn]] void complain(const std::string& what) const {
    user_error("{}: {}{}{}", file_, place_, place_.empty() ? "" : ": ", what);
  }

 private:
  const std::string& file_;
  std::string place_;
  const Json& json_;
};

Json parse(std::string_view text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const size_t at = std::min<size_t>(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at > 0 ? at - 1 : 0), '\n');
    user_error("{}:{}: {}", file, line, error.what());
  } catch (const Json::exception& error) {  // a number beyond double
    user_error("{}: {}", file, error.what());
  }
}

std::vector<dvec3> read_points(const Value& value) {
  std::vector<dvec3> points;
  for (const Value& row : value.items()) {
    const std::vector<Value> p = row.items(3);
    points.emplace_back(p[0].number(), p[1].number(), p[2].number());
  }
  return points;
}

nlohmann::ordered_json points_json(const std::vector<dvec3>& points) {
  auto rows = nlohmann::ordered_json::array();
  for (const dvec3& p : points) rows.push_back({p.x, p.y, p.z});
  return rows;
}

StrainTable read_strains(const Value& value) {
  value.only({"course", "wale", "offsets"});
  StrainTable table;
  for (const Value& strain : value["course"].items()) table.course.push_back(strain.number());
  for (const Value& strain : value["wale"].items()) table.wale.push_back(strain.number());
  for (const Value& shape : value["offsets"].items()) table.offsets.push_back(read_points(shape));
  if (table.empty()) value["course"].complain("no strains; give at least 0, or leave the key \"strains\" out");
  return table;
}

PatternCurve read_curve(const Value& value) {
  value.only({"points", "closed"});
  PatternCurve curve;
  curve.points = read_points(value["points"]);
  if (value.has("closed")) curve.closed = value["closed"].truth();
  return curve;
}

}  // namespace

Pattern parse_pattern_json(std::string_view text, const std::filesystem::path& path, const PatternHints& hints) {
  const std::string file = path.string();
  const Json json = parse(text, file);
  const Value root(file, "", json);
  root.only({"wale_tile", "name", "period", "yarn_radius", "stitches", "kind", "curves", "strains"});
  if (root["wale_tile"].whole() != 1) root["wale_tile"].complain("only version 1 is known");
  Pattern pattern;
  if (root.has("name")) pattern.name = root["name"].text();
  const std::vector<Value> period = root["period"].items(2);
  for (const int axis : {0, 1}) {
    pattern.period[axis] = hints.period[axis] > 0 ? hints.period[axis] : period[axis].number();
    if (!(pattern.period[axis] > 0)) period[axis].complain("the period must be positive");
  }
  pattern.yarn_radius = hints.yarn_radius > 0 ? hints.yarn_radius : root["yarn_radius"].number();
  if (!(pattern.yarn_radius > 0)) root["yarn_radius"].complain("the yarn radius must be positive");
  if (root.has("stitches")) {
    const std::vector<Value> stitches = root["stitches"].items(2);
    for (const int axis : {0, 1}) {
      pattern.stitches[axis] = stitches[axis].whole();
      if (pattern.stitches[axis] < 1) stitches[axis].complain("at least 1 is needed; leave the key out to estimate");
    }
  }
  const std::string kind = root.has("kind") ? root["kind"].text() : "interpolating";
  if (kind != "interpolating" && kind != "bspline")
    root["kind"].complain(fmt::format("'{}' is not known; choose interpolating or bspline", kind));
  pattern.kind = kind == "bspline" ? CurveKind::bspline : CurveKind::interpolating;
  for (const Value& curve : root["curves"].items()) pattern.curves.push_back(read_curve(curve));
  if (root.has("strains")) pattern.strains = read_strains(root["strains"]);
  return pattern;
}

void write_pattern_json(const Pattern& pattern, const std::filesystem::path& file) {
  nlohmann::ordered_json json;
  json["wale_tile"] = 1;
  json["name"] = pattern.name;
  json["period"] = {pattern.period.x, pattern.period.y};
  json["yarn_radius"] = pattern.yarn_radius;
  if (pattern.stitches.x > 0 && pattern.stitches.y > 0) json["stitches"] = {pattern.stitches.x, pattern.stitches.y};
  json["kind"] = pattern.kind == CurveKind::bspline ? "bspline" : "interpolating";
  json["curves"] = Json::array();
  for (const PatternCurve& curve : pattern.curves) {
    nlohmann::ordered_json item;
    item["points"] = points_json(curve.points);
    item["closed"] = curve.closed;
    json["curves"].push_back(std::move(item));
  }
  if (const StrainTable& strains = pattern.strains; !strains.empty()) {
    nlohmann::ordered_json& item = json["strains"];
    item["course"] = strains.course;
    item["wale"] = strains.wale;
    item["offsets"] = nlohmann::ordered_json::array();
    for (const auto& shape : strains.offsets) item["offsets"].push_back(points_json(shape));
  }
  write_whole_file(file, json.dump(1) + "\n");
}

}  // namespace wale
