#include "host/serve/control_table.h"

#include "host/serve/control_values.h"

namespace wale {

using Texts = std::vector<std::string>;

Control& ControlTable::add(Control control) {
  controls_.push_back(std::move(control));
  return controls_.back();
}

Control& ControlTable::number(const std::string& path, const std::string& group, const std::string& label,
                              const std::string& doc, double low, double high, double step, double value,
                              const std::string& unit, Texts first) {
  Control& c = add({path, group, label, path, doc, Control::Kind::number, low, high, step, unit});
  c.number = value;
  c.set = [path, first](double v, const std::string&) {
    Texts out = first;
    out.push_back(path + "=" + plain_number(v));
    return out;
  };
  return c;
}

Control& ControlTable::color(const std::string& path, const std::string& label, const Rgb& value, Texts first) {
  Control& c = add({path, "Colour", label, path, "sRGB", Control::Kind::color});
  c.text = hex_color(value);
  c.set = [path, first](double, const std::string& text) {
    Texts out = first;
    out.push_back(path + "=" + text);
    return out;
  };
  return c;
}

Control& ControlTable::choice(const std::string& path, const std::string& group, const std::string& label,
                              const std::string& doc, std::vector<std::pair<std::string, std::string>> words,
                              const std::string& value) {
  Control& c = add({path, group, label, path, doc, Control::Kind::choice});
  c.words = std::move(words);
  c.text = value;
  c.set = [path](double, const std::string& text) { return Texts{path + "=" + text}; };
  return c;
}

std::string ControlTable::of_fabric(size_t fabric, const std::string& label) const {
  return scene().fabrics.size() > 1 ? label + ", " + scene().fabrics[fabric].spec.name : label;
}

}  // namespace wale
