#pragma once
#include <glm/glm.hpp>

namespace wale {
using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::ivec3;
}  // namespace wale
