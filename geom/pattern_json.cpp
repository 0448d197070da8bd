// Wale's own tile: {"wale_tile": 1, "name", "period": [x, y], "yarn_radius", "stitches": [wales, courses],
// "kind": "interpolating" or "bspline", "curves": [{"points": [[x, y, z], ...], "closed": false, "yarn": 0}]}, in
// metres; "palette": ["#rrggbb", ...] has the colour of each yarn; "knitted_from": {"chart": [rows], "settings": {name:
// number}}; "strains": {"course": [a, ...], "wale": [b, ...], "offsets": [[[x, y, z], ...], ...]}, as in StrainTable.
#include "geom/chart/chart_row.h"
#include "geom/json_value.h"
#include "geom/pattern_readers.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

using Json = nlohmann::json;
using Value = JsonValue;

std::vector<dvec3> read_points(const Value& value) {
  std::vector<dvec3> points;
  for (const Value& row : value.items()) {
    const std::vector<Value> p = row.items(3);
    points.emplace_back(p[0].number(), p[1].number(), p[2].number());
  }
  return points;
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
  value.only({"points", "closed", "yarn"});
  PatternCurve curve;
  curve.points = read_points(value["points"]);
  if (value.has("closed")) curve.closed = value["closed"].truth();
  if (value.has("yarn")) {
    curve.yarn = value["yarn"].whole();
    if (curve.yarn < 0 || curve.yarn >= kMostYarns)
      value["yarn"].complain(fmt::format("yarns are numbered from 0 to {}", kMostYarns - 1));
  }
  return curve;
}

void read_palette(const Value& root, Pattern& pattern) {
  if (root.has("palette"))
    for (const Value& color : root["palette"].items()) {
      const auto bytes = parse_color(color.text());
      if (!bytes) color.complain(fmt::format("\"{}\" is no colour; valid: #rrggbb", one_line(color.text())));
      pattern.palette.push_back(*bytes);
    }
  if (pattern.palette.empty()) return;
  for (size_t c = 0; c < pattern.curves.size(); ++c)
    if (size_t(pattern.curves[c].yarn) >= pattern.palette.size())
      root["palette"].complain(fmt::format("curve {} is of yarn {}, but there are {} colours", c,
                                           pattern.curves[c].yarn, pattern.palette.size()));
}

void read_origin(const Value& root, Pattern& pattern) {
  if (!root.has("knitted_from")) return;
  const Value from = root["knitted_from"];
  from.only({"chart", "settings"});
  for (const Value& row : from["chart"].items()) pattern.chart.push_back(row.text());
  for (const std::string& key : from["settings"].keys())
    pattern.settings.emplace_back(key, from["settings"][key.c_str()].number());
}

// Names may be any bytes, what is written is UTF-8.
std::string safe_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// As json.dump, but a point is one line.
std::string numbers(std::initializer_list<double> values) {
  std::string out = "[";
  for (const double v : values) out += (out.size() > 1 ? ", " : "") + Json(v).dump();
  return out + "]";
}

std::string points_text(const std::vector<dvec3>& points) {
  std::string out;
  for (const dvec3& p : points) out += (out.empty() ? "\n   " : ",\n   ") + numbers({p.x, p.y, p.z});
  return "[" + out + "]";
}

}  // namespace

Pattern parse_pattern_json(std::string_view text, const std::filesystem::path& path, const PatternHints& hints) {
  const std::string file = path.string();
  const Json json = parse_json(text, file);
  const Value root(file, "", json);
  root.only({"wale_tile", "name", "period", "yarn_radius", "stitches", "kind", "curves", "palette", "knitted_from",
             "strains"});
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
  read_palette(root, pattern);
  read_origin(root, pattern);
  if (root.has("strains")) pattern.strains = read_strains(root["strains"]);
  return pattern;
}

void write_pattern_json(const Pattern& pattern, const std::filesystem::path& file) {
  std::string out = "{\n \"wale_tile\": 1,\n \"name\": " + safe_text(pattern.name);
  const auto key = [&](const char* name, const std::string& value) {
    out += fmt::format(",\n \"{}\": {}", name, value);
  };
  key("period", numbers({pattern.period.x, pattern.period.y}));
  key("yarn_radius", Json(pattern.yarn_radius).dump());
  if (pattern.stitches.x > 0 && pattern.stitches.y > 0)
    key("stitches", fmt::format("[{}, {}]", pattern.stitches.x, pattern.stitches.y));
  key("kind", pattern.kind == CurveKind::bspline ? "\"bspline\"" : "\"interpolating\"");
  if (!pattern.palette.empty()) {
    std::string colors;
    for (const auto& c : pattern.palette)
      colors += fmt::format("{}\"#{:02x}{:02x}{:02x}\"", colors.empty() ? "" : ", ", c[0], c[1], c[2]);
    key("palette", "[" + colors + "]");
  }
  if (!pattern.chart.empty()) {
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    for (const auto& [name, value] : pattern.settings) settings[name] = value;
    key("knitted_from", "{\n  \"chart\": " + safe_text(pattern.chart) + ",\n  \"settings\": " + settings.dump() + "}");
  }
  std::string curves;
  for (const PatternCurve& curve : pattern.curves)
    curves += fmt::format("{}\n  {{\"yarn\": {}, \"closed\": {}, \"points\": {}}}", curves.empty() ? "" : ",",
                          curve.yarn, curve.closed, points_text(curve.points));
  key("curves", "[" + curves + "]");
  if (const StrainTable& strains = pattern.strains; !strains.empty()) {
    std::string offsets;
    for (const auto& shape : strains.offsets) offsets += (offsets.empty() ? "\n   " : ",\n   ") + points_text(shape);
    key("strains", fmt::format("{{\n  \"course\": {},\n  \"wale\": {},\n  \"offsets\": [{}]}}",
                               Json(strains.course).dump(), Json(strains.wale).dump(), offsets));
  }
  write_whole_file(file, out + "\n}\n");
}

}  // namespace wale
