#pragma once
#include <string>

#include "geom/textile_measures.h"
#include "host/features.h"
#include "host/scene_device.h"
#include "host/world.h"

namespace wale {

/// What was knitted, for `wale build`: text for a terminal, JSON for programs.
/// `textile` per fabric, or empty.
std::string build_report_text(const World& world, const std::vector<TextileMeasures>& textile = {});
std::string build_report_json(const World& world, const std::vector<TextileMeasures>& textile = {});

/// What will be simulated and why, for `wale plan`. `scene` gives the bytes of every buffer.
std::string plan_text(const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                      const Features& features);
std::string plan_json(const World& world, const SceneDevice& scene, const IntegratorScene& integrator,
                      const Features& features);

}  // namespace wale
