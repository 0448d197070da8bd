#pragma once
#include "host/schema.h"

namespace wale {

/// The one table of the scene format: read_scene checks against it and scene_schema() prints it.
const SchemaType& scene_type();

}  // namespace wale
