#include "host/serve/controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "geom/error.h"
#include "host/accuracy.h"
#include "host/bundled_tiles.h"
#include "host/json_text.h"
#include "host/ply_colors.h"
#include "host/serve/control_values.h"
#include "host/suggest.h"
#include "host/world.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;
constexpr size_t kMostColors = 8;  // of one yarn or tile

// What the table needs of a tile: read once.
struct TileFacts {
  dvec2 period{1, 1};
  ivec2 stitches{1, 1};
  std::vector<Rgb> palette;
};

TileFacts tile_facts(const FabricScene& fabric) {
  static std::mutex mutex;
  static std::map<std::string, TileFacts> known;
  const std::lock_guard lock(mutex);
  const std::string key = fabric.pattern.file.string() + "|" + fabric.pattern.builtin;
  auto found = known.find(key);
  if (found == known.end()) {
    const Pattern tile = load_pattern(fabric.pattern);
    FabricScene plain = fabric;
    plain.palette.reset();
    found =
        known.emplace(key, TileFacts{tile.period, glm::max(tile.stitches, ivec2(1)), yarn_colors(plain, tile)}).first;
  }
  TileFacts facts = found->second;
  if (fabric.palette) facts.palette = *fabric.palette;
  return facts;
}

class Table {
 public:
  Table(const EditedScene& edited, const EditorSettings& settings)
      : edited_(edited), scene_(edited.scene()), settings_(settings), unit_(edited.metres_per_unit()) {}

  std::vector<Control> make() {
    for (size_t f = 0; f < scene_.fabrics.size(); ++f) {
      pattern(f);
      yarn(f);
    }
    for (size_t f = 0; f < scene_.fabrics.size(); ++f) colors(f);
    for (size_t f = 0; f < scene_.fabrics.size(); ++f) material(f);
    for (size_t l = 0; l < scene_.lights.size(); ++l) light(l);
    if (std::none_of(scene_.lights.begin(), scene_.lights.end(),
                     [](const LightScene& l) { return l.kind == LightScene::Kind::environment; }))
      new_sky();
    view();
    accuracy();
    return std::move(out_);
  }

 private:
  Control& add(Control control) {
    out_.push_back(std::move(control));
    return out_.back();
  }

  // A number that one key holds.
  Control& number(const std::string& path, const std::string& group, const std::string& label, const std::string& doc,
                  double low, double high, double step, double value, const std::string& unit = "", Texts first = {}) {
    Control& c = add({path, group, label, path, doc, Control::Kind::number, low, high, step, unit});
    c.number = value;
    c.set = [path, first](double v, const std::string&) {
      Texts out = first;
      out.push_back(path + "=" + plain_number(v));
      return out;
    };
    return c;
  }

  Control& color(const std::string& path, const std::string& label, const Rgb& value, Texts first = {}) {
    Control& c = add({path, "Colour", label, path, "sRGB", Control::Kind::color});
    c.text = hex_color(value);
    c.set = [path, first](double, const std::string& text) {
      Texts out = first;
      out.push_back(path + "=" + text);
      return out;
    };
    return c;
  }

  Control& choice(const std::string& path, const std::string& group, const std::string& label, const std::string& doc,
                  std::vector<std::pair<std::string, std::string>> words, const std::string& value) {
    Control& c = add({path, group, label, path, doc, Control::Kind::choice});
    c.words = std::move(words);
    c.text = value;
    c.set = [path](double, const std::string& text) { return Texts{path + "=" + text}; };
    return c;
  }

  // Says which, where there are several.
  std::string named(size_t f, const std::string& label) const {
    return scene_.fabrics.size() > 1 ? label + ", " + scene_.fabrics[f].spec.name : label;
  }
  const JsonNode& fabric_node(size_t f) const { return edited_.document()["fabrics"].items[f]; }

  void pattern(size_t f) {
    const FabricScene& fabric = scene_.fabrics[f];
    const std::string at = fmt::format("fabrics.{}.", f), own = "(the scene's)";
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : bundled_tiles()) words.emplace_back(name, name);
    const FabricScene& opened = edited_.opened().fabrics[std::min(f, edited_.opened().fabrics.size() - 1)];
    std::string file = opened.pattern.file.string();
    if (!file.empty()) words.emplace_back(own, opened.pattern.file.filename().string());
    Control& c = choice(
        at + "pattern", "Pattern", named(f, "Pattern"), "tile of stitches (docs/patterns.md)", words,
        fabric.pattern.file.empty() ? fabric.pattern.builtin.empty() ? "stockinette" : fabric.pattern.builtin : own);
    c.set = [path = at + "pattern", own, file](double, const std::string& text) {
      return Texts{path + "=" + (text == own ? json_string(file) : "{\"builtin\": " + json_string(text) + "}")};
    };
    density(f, at);
  }

  void density(size_t f, const std::string& at) {
    const FabricScene& opened = edited_.opened().fabrics[std::min(f, edited_.opened().fabrics.size() - 1)];
    const FabricScale &scale = scene_.fabrics[f].spec.scale, &before = opened.spec.scale;
    const auto bounded = [&](const std::string& path, const std::string& label, const std::string& doc, double value,
                             double first) {
      const double base = first > 0 ? first : value;
      return &number(path, "Pattern", named(f, label), doc, 0.25 * base, 2.5 * base, 0.01 * base, value);
    };
    if (scale.kind == FabricScale::Kind::repeats) {
      const bool same = before.kind == scale.kind;
      bounded(at + "repeats.0", "Repeats across", "tiles along u", scale.repeats.x, same ? before.repeats.x : 0);
      bounded(at + "repeats.1", "Repeats along", "tiles along v", scale.repeats.y, same ? before.repeats.y : 0);
      return;
    }
    constexpr double kTenCentimetres = 0.1;
    const auto of_tile = [](const FabricScene& fabric) {
      const TileFacts tile = tile_facts(fabric);
      return kTenCentimetres * tile.stitches.x / tile.period.x;
    };
    const auto wales_of = [&](const FabricScene& fabric) {
      return fabric.spec.scale.kind == FabricScale::Kind::gauge       ? kTenCentimetres * fabric.spec.scale.gauge.x
             : fabric.spec.scale.kind == FabricScale::Kind::uv_metres ? of_tile(fabric)
                                                                      : 0;
    };
    Control* wales = bounded(at + "gauge.wales", "Density", "wales (columns of stitches) per 10 cm of cloth",
                             wales_of(scene_.fabrics[f]), wales_of(opened));
    wales->unit = "/10 cm";
    if (scale.kind == FabricScale::Kind::uv_metres)
      wales->set = [at](double v, const std::string&) {
        return Texts{at + "uv_metres=null", at + "gauge={\"wales\": " + plain_number(v) + "}"};
      };
    if (scale.kind == FabricScale::Kind::gauge && scale.gauge.y > 0)
      bounded(at + "gauge.courses", "Rows", "courses (rows of stitches) per 10 cm of cloth",
              kTenCentimetres * scale.gauge.y, kTenCentimetres * before.gauge.y)
          ->unit = "/10 cm";
  }

  void yarn(size_t f) {
    const FabricSpec& spec = scene_.fabrics[f].spec;
    const std::string at = fmt::format("fabrics.{}.", f);
    number(at + "yarn.plies", "Yarn", named(f, "Plies"), "plies twisted into one yarn", 1, 8, 1, spec.plies);
    constexpr double kHundredRadii = 100, kLeastPitch = 2;
    Control& twist =
        number(at + "yarn.twist_pitch", "Yarn", named(f, "Twist"),
               "turns of the plies per 100 yarn radii; negative = left-handed", -kHundredRadii / kLeastPitch,
               kHundredRadii / kLeastPitch, 0.5, spec.twist_pitch == 0 ? 0 : kHundredRadii / spec.twist_pitch);
    twist.unit = "turns";
    twist.set = [path = twist.path](double v, const std::string&) {
      return Texts{path + "=" + (std::abs(v) < 0.1 ? "0" : plain_number(kHundredRadii / v))};
    };
    number(at + "yarn.thickness", "Yarn", named(f, "Thickness"), "factor on the yarn radius of the tile", 0.4, 2, 0.02,
           spec.thickness);
    constexpr const char* kDetails[] = {"none", "paper", "maps", "fibres"};
    choice(at + "detail", "Yarn", named(f, "Fibre detail"), "how much of the fibres is seen",
           {{"none", "none: smooth plies"},
            {"paper", "as in KNIT21"},
            {"maps", "maps of fibres"},
            {"fibres", "every fibre (about 100 times the memory)"}},
           kDetails[size_t(spec.detail)]);
    number(at + "flyaways.hairs", "Yarn", named(f, "Hairs"), "loose fibres with one free end", 0, 10, 0.1,
           spec.flyaways.hairs * 1e-3, "/mm of ply");
  }

  // Materials whose names would not be one key of a path are left alone.
  const MaterialSpec* editable_material(size_t f, const JsonNode*& node) const {
    const MaterialSpec& m = scene_.materials.at(size_t(scene_.fabrics[f].material));
    const JsonNode* all = edited_.document().find("materials");
    node = all ? all->find(m.name) : nullptr;
    return node && m.name.find_first_of(".=*") == std::string::npos && !m.name.empty() ? &m : nullptr;
  }

  Texts without(const std::string& at, const JsonNode& node, std::initializer_list<const char*> keys) const {
    Texts out;
    for (const char* key : keys)
      if (node.has(key)) out.push_back(at + key + "=null");
    return out;
  }

  void colors(size_t f) {
    const FabricScene& fabric = scene_.fabrics[f];
    const JsonNode* node = nullptr;
    const MaterialSpec* m = editable_material(f, node);
    if (!m || !fabric.color_image.file.empty()) return;  // the image colours it
    const std::string at = "materials." + m->name + ".";
    const auto several = [&](const std::string& key, size_t count, const auto& one) {
      if (!colored_.insert(at + key).second) return;
      for (size_t i = 0; i < std::min(count, kMostColors); ++i) one(i);
    };
    if (!m->yarn.stripes.empty() && node->has("stripes"))
      return several("stripes", m->yarn.stripes.size(), [&](size_t i) {
        color(fmt::format("{}stripes.{}.color", at, i), fmt::format("Stripe {}, {}", i + 1, m->name),
              m->yarn.stripes[i].color);
      });
    if (!m->yarn.plies.empty() && node->has("plies"))
      return several("plies", m->yarn.plies.size(), [&](size_t i) {
        color(fmt::format("{}plies.{}", at, i), fmt::format("Ply {}, {}", i + 1, m->name), m->yarn.plies[i]);
      });
    const std::vector<Rgb> palette = tile_facts(fabric).palette;
    for (size_t i = 0; i < std::min(palette.size(), kMostColors); ++i) {
      const std::string path = fmt::format("fabrics.{}.palette", f);
      Control& c = color(path, named(f, fmt::format("Yarn {}", i + 1)), palette[i]);
      c.id += fmt::format(".{}", i);
      c.set = [path, palette, i](double, const std::string& text) {
        Texts list;
        for (size_t k = 0; k < palette.size(); ++k) list.push_back(json_string(k == i ? text : hex_color(palette[k])));
        return Texts{fmt::format("{}=[{}]", path, fmt::join(list, ", "))};
      };
    }
    if (!palette.empty()) return;
    several("color", 1, [&](size_t) {
      color(at + "color", scene_.fabrics.size() > 1 ? "Colour of " + m->name : "Colour", shown_color(m->yarn),
            without(at, *node, {"fibre_color", "reflect", "transmit"}));
    });
  }

  void material(size_t f) {
    const JsonNode* node = nullptr;
    const MaterialSpec* m = editable_material(f, node);
    if (!m || !colored_.insert("materials." + m->name).second) return;
    const std::string at = "materials." + m->name + ".", more = scene_.fabrics.size() > 1 ? ", " + m->name : "";
    choice(at + "preset", "Fibre", "Fibre" + more, "measured appearance to start from",
           {{"wool", "wool"},
            {"cotton", "cotton"},
            {"silk", "silk"},
            {"polyester", "polyester"},
            {"acrylic", "acrylic"},
            {"mohair", "mohair"}},
           m->yarn.preset);
    number(at + "gloss", "Fibre", "Gloss" + more, "0 = dull, 1 = shiny, 0.5 = the fibre's own", 0, 1, 0.01,
           m->yarn.gloss.value_or(0.5), "", without(at, *node, {"roughness"}));
    Texts first = without(at, *node, {"optical_radius"});
    if (const JsonNode* fitted = node->find("scattering"); fitted && fitted->has("optical_radius"))
      first.push_back(at + "scattering.optical_radius=null");
    number(at + "translucency", "Fibre", "Translucency" + more, "0 = dense, 1 = airy, 0.5 = the fibre's own", 0, 1,
           0.01, m->yarn.translucency.value_or(0.5), "", first);
  }

  void light(size_t l) {
    const LightScene& light = scene_.lights[l];
    const JsonNode& node = edited_.document()["lights"].items[l];
    const std::string at = fmt::format("lights.{}.", l);
    const bool sky = light.kind == LightScene::Kind::environment;
    const std::string name = sky ? "Sky" : node.has("name") ? light.name : fmt::format("Light {}", l + 1);
    const JsonNode* intensity = node.find("intensity");
    number(at + "intensity", "Light", name + " brightness", "factor on its radiance", 0, 4, 0.02,
           intensity && intensity->is_number() ? intensity->number : 1);
    if (sky && !light.file.empty())
      number(at + "rotation", "Light", "Sky rotation", "about up", -180, 180, 1, light.rotation * 57.29577951308232,
             "°");
    if (light.kind != LightScene::Kind::quad && light.kind != LightScene::Kind::sphere) return;
    const dvec3 target = light.kind == LightScene::Kind::quad ? light.look_at : scene_.camera.look_at;
    const dvec3 up = scene_.camera_given ? edited_.opened().camera.up : dvec3(0, 1, 0);
    const double distance = glm::length(light.position - target);
    if (!(distance > 0)) return;
    const LightAngles now = light_angles(light.position - target, up);
    const auto angle = [&](const char* part, const std::string& label, double range, double value, bool around) {
      Control& c = number(at + "position", "Light", label, "where it stands around what it shines at", -range, range, 1,
                          value, "°");
      c.id += part;
      c.set = [=, unit = unit_, quad = light.kind == LightScene::Kind::quad](double v, const std::string&) {
        const dvec3 out = light_direction(around ? LightAngles{v, now.above} : LightAngles{now.around, v}, up);
        Texts set{at + "position=" + point_text(target + distance * out, unit)};
        // A quad's own up must not point along its direction.
        if (quad && glm::length(glm::cross(glm::normalize(light.up), out)) < 0.02)
          set.push_back(at + "up=" + point_text(light_direction({now.around, now.above + 90}, up), 1));
        return set;
      };
    };
    angle(".around", name + " around", 180, now.around, true);
    angle(".above", name + " above", 85, now.above, false);
  }

  void new_sky() {
    Control& c = number("lights", "Light", "Sky brightness", "radiance of a sky all around", 0, 4, 0.02, 0);
    c.id = "lights.sky";
    JsonNode list = edited_.document()["lights"];
    c.set = [list](double v, const std::string&) {
      std::string text = json_text(list);
      text = text.substr(0, text.rfind(']'));
      std::replace(text.begin(), text.end(), '\n', ' ');
      return Texts{"lights=" + text + (list.items.empty() ? "" : ", ") +
                   fmt::format("{{\"type\": \"environment\", \"radiance\": 1, \"intensity\": {}}}]", plain_number(v))};
    };
  }

  void view() {
    Control& lit = choice("view.lit", "View", "Lit from", "the lamps as they are, or all on one side of the cloth",
                          {{"scene", "as in the scene"},
                           {"front", "the front"},
                           {"back", "behind"},
                           {"both", "front and behind, side by side"}},
                          settings_.lit);
    lit.path.clear();
    lit.set = nullptr;
    if (scene_.camera_given && !scene_.camera.orthographic)
      number("camera.fov", "View", "Angle of view", "vertical", 2, 90, 0.5, scene_.camera.fov * 57.29577951308232, "°");
    number("film.exposure", "View", "Exposure", "stops; of the picture on the screen", -6, 6, 0.1, scene_.film.exposure,
           "stops");
    choice("film.view", "View", "Tone curve", "of the picture on the screen",
           {{"neutral", "neutral"}, {"srgb", "none (sRGB)"}}, scene_.film.view);
  }

  void accuracy() {
    std::vector<std::pair<std::string, std::string>> words;
    std::string now;
    for (const AccuracyPreset& preset : accuracy_presets()) {
      words.emplace_back(preset.name, preset.name + ": " + preset.doc);
      const bool all = std::all_of(preset.levels.begin(), preset.levels.end(), [&](const auto& level) {
        return accuracy_option(level.first).at(scene_) == level.second;
      });
      if (all && now.empty()) now = preset.name;
    }
    if (now.empty()) words.emplace_back(now = "(the scene's)", "the scene's own mixture");
    Control& c =
        choice("accuracy", "Accuracy", "Preset", "what every accuracy option is set to (docs/accuracy.md)", words, now);
    c.path = "integrator, fabrics.*";
    c.set = [](double, const std::string& text) {
      return text == "(the scene's)" ? Texts{} : accuracy_preset(text).overrides();
    };
    Control& goal = add({"view.goal", "Accuracy", "Goal", "", "error of the picture's tiles at which it is done",
                         Control::Kind::choice});
    goal.words = {{"0.2", "20 %"}, {"0.1", "10 %"}, {"0.05", "5 %"}, {"0.02", "2 %"}, {"0.01", "1 %"}};
    goal.text = fmt::format("{:g}", settings_.goal);
  }

  const EditedScene& edited_;
  const Scene& scene_;
  const EditorSettings& settings_;
  double unit_;
  std::vector<Control> out_;
  std::set<std::string> colored_;  ///< keys that have a control
};

void require(const Control& control, const JsonNode& value) {
  if (control.kind == Control::Kind::number) {
    if (!value.is_number()) user_error("{}: a number is needed here, not {}", control.label, value.describe());
    if (!(value.number >= control.low && value.number <= control.high))
      user_error("{}: {:g} is out of range; valid: {:.4g} to {:.4g}", control.label, value.number, control.low,
                 control.high);
    if (control.step == 1 && control.id.ends_with("plies") && value.number != std::floor(value.number))
      user_error("{}: a whole number is needed here, not {:g}", control.label, value.number);
    return;
  }
  if (value.kind != JsonNode::Kind::string)
    user_error("{}: a text is needed here, not {}", control.label, value.describe());
  if (control.kind == Control::Kind::color) {
    const std::string& hex = value.text;
    if (hex.size() != 7 || hex[0] != '#' || hex.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      user_error("{}: \"{}\" is no colour; valid: \"#rrggbb\"", control.label, one_line(hex.substr(0, 40)));
    return;
  }
  std::vector<std::string> names;
  for (const auto& [name, shown] : control.words) names.push_back(name);
  if (std::find(names.begin(), names.end(), value.text) == names.end())
    user_error("{}: \"{}\" is not known; {}", control.label, one_line(value.text.substr(0, 40)),
               nearest_choice(value.text.substr(0, 40), names));
}

}  // namespace

std::vector<Control> controls_of(const EditedScene& scene, const EditorSettings& settings) {
  return Table(scene, settings).make();
}

std::vector<std::string> overrides_of(const Control& control, const JsonNode& value) {
  require(control, value);
  return control.set(value.number, value.text);
}

void set_setting(EditorSettings& settings, const Control& control, const JsonNode& value) {
  require(control, value);
  if (control.id == "view.lit") settings.lit = value.text;
  if (control.id == "view.goal") settings.goal = std::stod(value.text);
}

std::string controls_json(const std::vector<Control>& controls) {
  Texts out;
  for (const Control& c : controls) {
    std::string one =
        fmt::format("{{\"id\": {}, \"group\": {}, \"label\": {}, \"path\": {}, \"doc\": {}, ", json_string(c.id),
                    json_string(c.group), json_string(c.label), json_string(c.path), json_string(c.doc));
    if (c.kind == Control::Kind::number)
      one += fmt::format("\"type\": \"number\", \"min\": {}, \"max\": {}, \"step\": {}, \"unit\": {}, \"value\": {}}}",
                         plain_number(c.low), plain_number(c.high), plain_number(c.step), json_string(c.unit),
                         plain_number(c.number));
    else if (c.kind == Control::Kind::color)
      one += fmt::format("\"type\": \"color\", \"value\": {}}}", json_string(c.text));
    else {
      Texts words;
      for (const auto& [name, shown] : c.words)
        words.push_back(fmt::format("[{}, {}]", json_string(name), json_string(shown)));
      one += fmt::format("\"type\": \"choice\", \"words\": [{}], \"value\": {}}}", fmt::join(words, ", "),
                         json_string(c.text));
    }
    out.push_back(std::move(one));
  }
  return fmt::format("[{}]", fmt::join(out, ",\n "));
}

}  // namespace wale
