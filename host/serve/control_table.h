#pragma once
#include <string>
#include <utility>
#include <vector>

#include "host/serve/controls.h"

namespace wale {

/// Controls in the making. A reference to one is valid until the next is added.
class ControlTable {
 public:
  ControlTable(const EditedScene& scene, const EditorSettings& now) : edited(scene), settings(now) {}

  const EditedScene& edited;
  const EditorSettings& settings;

  const Scene& scene() const { return edited.scene(); }
  Control& add(Control control);
  /// A number that one key holds. `first`: overrides that must come before, here and below.
  Control& number(const std::string& path, const std::string& group, const std::string& label, const std::string& doc,
                  double low, double high, double step, double value, const std::string& unit = "",
                  std::vector<std::string> first = {});
  Control& color(const std::string& path, const std::string& label, const Rgb& value,
                 std::vector<std::string> first = {});
  Control& choice(const std::string& path, const std::string& group, const std::string& label, const std::string& doc,
                  std::vector<std::pair<std::string, std::string>> words, const std::string& value);
  /// The label, with the fabric's name where there are several.
  std::string of_fabric(size_t fabric, const std::string& label) const;
  std::vector<Control> take() { return std::move(controls_); }

 private:
  std::vector<Control> controls_;
};

/// Rows of the table, in the order in which they are shown. Pattern, density, yarn and hairs of every fabric:
void add_knit_controls(ControlTable& table);
/// Colours of every yarn, then fibre, gloss and translucency of every material:
void add_material_controls(ControlTable& table);
/// Brightness and place of every light:
void add_light_controls(ControlTable& table);
/// What is seen and how well: camera, exposure, accuracy.
void add_view_controls(ControlTable& table);

}  // namespace wale
