#pragma once
#include <string>

#include "geom/textile_measures.h"
#include "host/world.h"

namespace wale {

/// What was knitted, for `wale build`: text for a terminal, JSON for programs.
/// `textile` per fabric, or empty.
std::string build_report_text(const World& world, const std::vector<TextileMeasures>& textile = {});
std::string build_report_json(const World& world, const std::vector<TextileMeasures>& textile = {});

}  // namespace wale
