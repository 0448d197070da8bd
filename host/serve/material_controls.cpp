#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "host/json_text.h"
#include "host/serve/control_table.h"
#include "host/serve/control_values.h"
#include "host/serve/tile_facts.h"

namespace wale {
namespace {

using Texts = std::vector<std::string>;
constexpr size_t kMostColors = 8;  // of one yarn or tile

class MaterialControls {
 public:
  explicit MaterialControls(ControlTable& table) : table_(table) {}

  // Materials whose names would not be one key of a path are left alone.
  const MaterialSpec* editable_material(size_t f, const JsonNode*& node) const {
    const MaterialSpec& m = table_.scene().materials.at(size_t(table_.scene().fabrics[f].material));
    const JsonNode* all = table_.edited.document().find("materials");
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
    const FabricScene& fabric = table_.scene().fabrics[f];
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
        table_.color(fmt::format("{}stripes.{}.color", at, i), fmt::format("Stripe {}, {}", i + 1, m->name),
                     m->yarn.stripes[i].color);
      });
    if (!m->yarn.plies.empty() && node->has("plies"))
      return several("plies", m->yarn.plies.size(), [&](size_t i) {
        table_.color(fmt::format("{}plies.{}", at, i), fmt::format("Ply {}, {}", i + 1, m->name), m->yarn.plies[i]);
      });
    const std::vector<Rgb> palette = tile_facts(fabric).palette;
    for (size_t i = 0; i < std::min(palette.size(), kMostColors); ++i) {
      const std::string path = fmt::format("fabrics.{}.palette", f);
      Control& c = table_.color(path, table_.of_fabric(f, fmt::format("Yarn {}", i + 1)), palette[i]);
      c.id += fmt::format(".{}", i);
      c.set = [path, palette, i](double, const std::string& text) {
        Texts list;
        for (size_t k = 0; k < palette.size(); ++k) list.push_back(json_string(k == i ? text : hex_color(palette[k])));
        return Texts{fmt::format("{}=[{}]", path, fmt::join(list, ", "))};
      };
    }
    if (!palette.empty()) return;
    several("color", 1, [&](size_t) {
      table_.color(at + "color", table_.scene().fabrics.size() > 1 ? "Colour of " + m->name : "Colour",
                   shown_color(m->yarn), without(at, *node, {"fibre_color", "reflect", "transmit"}));
    });
  }

  void material(size_t f) {
    const JsonNode* node = nullptr;
    const MaterialSpec* m = editable_material(f, node);
    if (!m || !colored_.insert("materials." + m->name).second) return;
    const std::string at = "materials." + m->name + ".", more = table_.scene().fabrics.size() > 1 ? ", " + m->name : "";
    table_.choice(at + "preset", "Fibre", "Fibre" + more, "measured appearance to start from",
                  {{"wool", "wool"},
                   {"cotton", "cotton"},
                   {"silk", "silk"},
                   {"polyester", "polyester"},
                   {"acrylic", "acrylic"},
                   {"mohair", "mohair"}},
                  m->yarn.preset);
    table_.number(at + "gloss", "Fibre", "Gloss" + more, "0 = dull, 1 = shiny, 0.5 = the fibre's own", 0, 1, 0.01,
                  m->yarn.gloss.value_or(0.5), "", without(at, *node, {"roughness"}));
    Texts first = without(at, *node, {"optical_radius"});
    if (const JsonNode* fitted = node->find("scattering"); fitted && fitted->has("optical_radius"))
      first.push_back(at + "scattering.optical_radius=null");
    table_.number(at + "translucency", "Fibre", "Translucency" + more, "0 = dense, 1 = airy, 0.5 = the fibre's own", 0,
                  1, 0.01, m->yarn.translucency.value_or(0.5), "", first);
  }

 private:
  ControlTable& table_;
  std::set<std::string> colored_;  ///< keys that have a control
};

}  // namespace

void add_material_controls(ControlTable& table) {
  MaterialControls materials(table);
  for (size_t f = 0; f < table.scene().fabrics.size(); ++f) materials.colors(f);
  for (size_t f = 0; f < table.scene().fabrics.size(); ++f) materials.material(f);
}

}  // namespace wale
