#pragma once
#include <gtest/gtest.h>

#include "geom/chart/knit_tile.h"

namespace wale::test {

/// Bundled tiles that take a second or two to relax; the others are for long tests.
inline constexpr const char* kQuickTiles[] = {"stockinette_relaxed", "garter", "rib_1x1", "rib_2x2", "half_cardigan",
                                              "cartridge_belt_rib"};

/// As scenes/patterns/make.sh relaxed a bundled tile, which holds its settings.
inline KnitSettings bundled_settings(const Pattern& tile) {
  KnitSettings out;
  for (const auto& [name, value] : tile.settings) {
    if (name == "yarn_thickness")
      out.yarn_thickness = value;
    else if (name == "loop_length")
      out.loop_length = value;
    else if (name == "step")
      out.step = value;
    else if (name == "course_tension")
      out.tension.x = value;
    else if (name == "wale_tension")
      out.tension.y = value;
    else if (name == "blocking")
      out.blocking = value;
    else if (name == "starts")
      out.starts = int(value);
    else
      ADD_FAILURE() << tile.name << ": " << name;
  }
  out.strains = !tile.strains.empty();
  return out;
}

}  // namespace wale::test
