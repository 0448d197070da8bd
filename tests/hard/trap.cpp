#include "tests/hard/trap.h"

#include <fmt/format.h>

#include <iterator>

namespace wale::test {

const std::vector<Trap>& traps() {
  static const std::vector<Trap> all = [] {
    std::vector<Trap> list;
    for (const auto& part :
         {ray_traps(), curve_traps(), mesh_traps(), fabric_traps(), light_traps(), distance_traps(), number_traps()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

std::string trap_table(bool measured) {
  const auto number = [](double x) { return std::isnan(x) ? std::string("-") : fmt::format("{:.2g}", x); };
  std::string out =
      "| case | what breaks without care | promise | limit | float | double | rare events |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Trap& t : traps()) {
    const Finding f = measured ? t.look() : Finding{};
    const std::string rare = f.trials ? fmt::format("{} of {:.2g}", f.rare, double(f.trials)) : "-";
    out += fmt::format("| {} | {} | {}{} | {:g} {} | {} | {} | {} |\n", t.name, t.breaks, t.promise,
                       f.broken.empty() ? "" : " **BROKEN: " + f.broken + "**", t.limit, t.unit, number(f.error_float),
                       number(f.error_double), rare);
  }
  return out;
}

}  // namespace wale::test
