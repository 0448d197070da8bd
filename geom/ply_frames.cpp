#include "geom/ply_frames.h"

#include <cmath>

#include "geom/double_reflection.h"

namespace wale {
namespace {

dvec3 unit_or(const dvec3& v, const dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
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

void mean_tangents(const dvec3* p, size_t count, dvec3* tangent) {
  dvec3 before = unit_or(p[1] - p[0], dvec3(1, 0, 0));
  tangent[0] = before;
  for (size_t k = 1; k + 1 < count; ++k) {
    const dvec3 after = unit_or(p[k + 1] - p[k], before);
    tangent[k] = unit_or(before + after, after);  // a fold by 180 degrees has no mean
    before = after;
  }
  tangent[count - 1] = before;
}

void frame_plies(FlatYarn& yarn, int plies) {
  const size_t count = yarn.centre.size(), all = count * plies;
  yarn.normal.resize(all);
  yarn.length.resize(all);
  yarn.tangent.resize(all);
  const size_t first = yarn.closed ? 1 : 0, last = yarn.closed ? count - 2 : count - 1;
  for (size_t begin = 0; begin < all; begin += count) {
    const dvec3 *p = &yarn.position[begin], *t = &yarn.tangent[begin];
    measure(p, first, count, &yarn.length[begin]);
    mean_tangents(p, count, &yarn.tangent[begin]);
    const dvec3 out = p[first] - yarn.centre[first];
    const dvec3 across = out - glm::dot(out, t[first]) * t[first];
    yarn.normal[begin + first] = glm::length(across) > 1e-6 * glm::distance(p[first], p[first + 1])
                                     ? glm::normalize(across)
                                     : any_normal(t[first]);
  }
  // Each frame waits for the one before it: the plies side by side fill the time.
  for (size_t k = first + 1; k <= last; ++k)
    for (size_t at = k; at < all; at += count)
      yarn.normal[at] = double_reflection(yarn.normal[at - 1], yarn.position[at - 1], yarn.tangent[at - 1],
                                          yarn.position[at], yarn.tangent[at]);
  if (!yarn.closed) return;
  for (size_t begin = 0; begin < all; begin += count) {
    dvec3* n = &yarn.normal[begin];
    const dvec3* t = &yarn.tangent[begin];
    const double* length = &yarn.length[begin];
    const dvec3 side = glm::cross(t[first], n[first]);
    const double closing = std::atan2(glm::dot(n[last], side), glm::dot(n[last], n[first]));
    for (size_t k = first + 1; k < last; ++k) n[k] = turned(n[k], t[k], -closing * length[k] / length[last]);
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
