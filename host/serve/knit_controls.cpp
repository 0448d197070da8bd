#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/bundled_tiles.h"
#include "host/json_text.h"
#include "host/serve/control_table.h"
#include "host/serve/control_values.h"
#include "host/serve/tile_facts.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;

class KnitControls {
 public:
  explicit KnitControls(ControlTable& table) : table_(table) {}

  void pattern(size_t f) {
    const FabricScene& fabric = table_.scene().fabrics[f];
    const std::string at = fmt::format("fabrics.{}.", f), own = "(the scene's)";
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& name : bundled_tiles()) words.emplace_back(name, name);
    const FabricScene& opened = table_.edited.opened().fabrics[std::min(f, table_.edited.opened().fabrics.size() - 1)];
    std::string file = opened.pattern.file.string();
    if (!file.empty()) words.emplace_back(own, opened.pattern.file.filename().string());
    Control& c = table_.choice(
        at + "pattern", "Pattern", table_.of_fabric(f, "Pattern"), "tile of stitches (docs/patterns.md)", words,
        fabric.pattern.file.empty() ? fabric.pattern.builtin.empty() ? "stockinette" : fabric.pattern.builtin : own);
    c.set = [path = at + "pattern", own, file](double, const std::string& text) {
      return Texts{path + "=" + (text == own ? json_string(file) : "{\"builtin\": " + json_string(text) + "}")};
    };
    density(f, at);
  }

  void density(size_t f, const std::string& at) {
    const FabricScene& opened = table_.edited.opened().fabrics[std::min(f, table_.edited.opened().fabrics.size() - 1)];
    const FabricScale &scale = table_.scene().fabrics[f].spec.scale, &before = opened.spec.scale;
    const auto bounded = [&](const std::string& path, const std::string& label, const std::string& doc, double value,
                             double first) {
      const double base = first > 0 ? first : value;
      return &table_.number(path, "Pattern", table_.of_fabric(f, label), doc, 0.25 * base, 2.5 * base, 0.01 * base,
                            value);
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
                             wales_of(table_.scene().fabrics[f]), wales_of(opened));
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
    const FabricSpec& spec = table_.scene().fabrics[f].spec;
    const std::string at = fmt::format("fabrics.{}.", f);
    table_.number(at + "yarn.plies", "Yarn", table_.of_fabric(f, "Plies"), "plies twisted into one yarn", 1, 8, 1,
                  spec.plies);
    constexpr double kHundredRadii = 100, kLeastPitch = 2;
    Control& twist =
        table_.number(at + "yarn.twist_pitch", "Yarn", table_.of_fabric(f, "Twist"),
                      "turns of the plies per 100 yarn radii; negative = left-handed", -kHundredRadii / kLeastPitch,
                      kHundredRadii / kLeastPitch, 0.5, spec.twist_pitch == 0 ? 0 : kHundredRadii / spec.twist_pitch);
    twist.unit = "turns";
    twist.set = [path = twist.path](double v, const std::string&) {
      return Texts{path + "=" + (std::abs(v) < 0.1 ? "0" : plain_number(kHundredRadii / v))};
    };
    table_.number(at + "yarn.thickness", "Yarn", table_.of_fabric(f, "Thickness"),
                  "factor on the yarn radius of the tile", 0.4, 2, 0.02, spec.thickness);
    constexpr const char* kDetails[] = {"none", "paper", "maps", "fibres"};
    table_.choice(at + "detail", "Yarn", table_.of_fabric(f, "Fibre detail"), "how much of the fibres is seen",
                  {{"none", "none: smooth plies"},
                   {"paper", "as in KNIT21"},
                   {"maps", "maps of fibres"},
                   {"fibres", "every fibre (about 100 times the memory)"}},
                  kDetails[size_t(spec.detail)]);
    table_.number(at + "flyaways.hairs", "Yarn", table_.of_fabric(f, "Hairs"), "loose fibres with one free end", 0, 10,
                  0.1, spec.flyaways.hairs * 1e-3, "/mm of ply");
  }

 private:
  ControlTable& table_;
};

}  // namespace

void add_knit_controls(ControlTable& table) {
  KnitControls knit(table);
  for (size_t f = 0; f < table.scene().fabrics.size(); ++f) {
    knit.pattern(f);
    knit.yarn(f);
  }
}

}  // namespace wale
