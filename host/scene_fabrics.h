#pragma once
#include "host/json_document.h"
#include "host/scene.h"
#include "host/scene_sources.h"

namespace wale {

/// Element `index` of a checked "fabrics". Its material is found in, or added to, those of the scene. Throws the user
/// errors that the schema cannot: materials of another sort, flyaways out of bounds.
FabricScene fabric_of(Scene& scene, const JsonNode& node, size_t index, const SceneMoment& moment);

}  // namespace wale
