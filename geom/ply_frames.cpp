#include "geom/ply_frames.h"

#include <cmath>

#include "geom/double_reflection.h"

namespace wale {
namespace {

dvec3 unit_or(const dvec3& v, const dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

/// Mean of the two unit edges at every vertex of one polyline; the edge itself at its two ends.
std::vector<dvec3> mean_tangents(const dvec3* p, size_t count) {
  std::vector<dvec3> tangent(count);
  dvec3 before = unit_or(p[1] - p[0], dvec3(1, 0, 0));
  tangent[0] = before;
  for (size_t k = 1; k + 1 < count; ++k) {
    const dvec3 after = unit_or(p[k + 1] - p[k], before);
    tangent[k] = unit_or(before + after, after);  // a fold by 180 degrees has no mean
    before = after;
  }
  tangent[count - 1] = before;
  return tangent;
}

dvec3 turned(const dvec3& n, const dvec3& axis, double angle) {
  return std::cos(angle) * n + std::sin(angle) * glm::cross(axis, n);
}

void measure(const dvec3* p, size_t first, size_t count, double* length) {
  length[first] = 0;
  for (size_t k = first + 1; k < count; ++k) length[k] = length[k - 1] + glm::distance(p[k - 1], p[k]);
  for (size_t k = first; k-- > 0;) length[k] = length[k + 1] - glm::distance(p[k], p[k + 1]);
}

}  // namespace

void frame_plies(FlatYarn& yarn, int plies) {
  const size_t count = yarn.centre.size();
  yarn.normal.resize(count * plies);
  yarn.length.resize(count * plies);
  const size_t first = yarn.closed ? 1 : 0, last = yarn.closed ? count - 2 : count - 1;
  for (int ply = 0; ply < plies; ++ply) {
    const dvec3* p = &yarn.position[ply * count];
    dvec3* n = &yarn.normal[ply * count];
    double* length = &yarn.length[ply * count];
    measure(p, first, count, length);
    const std::vector<dvec3> tangent = mean_tangents(p, count);
    const dvec3 out = p[first] - yarn.centre[first];
    const dvec3 across = out - glm::dot(out, tangent[first]) * tangent[first];
    n[first] = glm::length(across) > 1e-6 * glm::distance(p[first], p[first + 1]) ? glm::normalize(across)
                                                                                  : any_normal(tangent[first]);
    for (size_t k = first + 1; k <= last; ++k)
      n[k] = double_reflection(n[k - 1], p[k - 1], tangent[k - 1], p[k], tangent[k]);
    if (!yarn.closed) continue;
    const dvec3 side = glm::cross(tangent[first], n[first]);
    const double closing = std::atan2(glm::dot(n[last], side), glm::dot(n[last], n[first]));
    for (size_t k = first + 1; k < last; ++k) n[k] = turned(n[k], tangent[k], -closing * length[k] / length[last]);
    n[last] = n[first];
    n[0] = n[last - 1];
    n[count - 1] = n[first + 1];
  }
}

dvec3 ply_tangent(const FlatYarn& yarn, size_t ply, size_t k) {
  const size_t count = yarn.centre.size();
  const dvec3* p = &yarn.position[ply * count];
  const dvec3 before = k > 0 ? unit_or(p[k] - p[k - 1], dvec3(0)) : dvec3(0);
  const dvec3 after = k + 1 < count ? unit_or(p[k + 1] - p[k], before) : dvec3(0);
  return unit_or(before + after, glm::length(after) > 0 ? after : dvec3(1, 0, 0));
}

}  // namespace wale
