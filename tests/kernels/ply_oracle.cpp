#include "tests/kernels/ply_oracle.h"

#include <algorithm>
#include <cmath>

namespace wale::test {
namespace {

template <typename Real>
glm::vec<3, Real> unit(glm::vec<3, Real> a) {
  const Real l = glm::length(a);
  return l > 0 ? a / l : glm::vec<3, Real>(0);
}

/// y, relative to the joint, lies in the cylinder that runs from there along e.
template <typename Real>
bool inside_cylinder(glm::vec<3, Real> y, glm::vec<3, Real> e, Real r) {
  const Real length = glm::length(e);
  if (!(length > 0)) return false;
  const Real s = glm::dot(y, e) / length;
  return s > 0 && s < length && glm::dot(y, y) - s * s < r * r * (1 - Real(1e-4L));
}

}  // namespace

template <typename Real>
SegmentEntry<Real> segment_entry(const OracleSegment& s, const Ray& ray, double shrink) {
  using vec = glm::vec<3, Real>;
  const vec o = vec(ray.o[0], ray.o[1], ray.o[2]) + vec(ray.l[0], ray.l[1], ray.l[2]), d(ray.d[0], ray.d[1], ray.d[2]);
  const vec start(s.start), end(s.end), to_before = vec(s.before) - start, to_after = vec(s.after) - end;
  const Real dd = glm::dot(d, d), r = Real(s.radius) * (1 - Real(shrink)), eps = Real(1e-5L) * r;
  SegmentEntry<Real> entry;
  const vec e = end - start, a = unit(e);
  const vec k = glm::cross(a, d);
  const Real kk = glm::dot(k, k);
  if (kk > Real(1e-6L) * dd && a != vec(0)) {
    const vec w = o - (start + end) / Real(2);
    const Real foot = -glm::dot(w, d) / dd;
    const vec q = w + foot * d;
    const Real l = glm::dot(q, k) / std::sqrt(kk), disc = (r - l) * (r + l);
    if (disc >= 0) {
      const Real s0 = -(glm::dot(q, d) - glm::dot(a, q) * glm::dot(a, d)) / kk - std::sqrt(disc / kk);
      const vec x = q + s0 * d, y1 = x + e / Real(2), y2 = x - e / Real(2);
      const vec t_before = unit(-to_before), t_after = unit(to_after);
      bool ok = s.cut_start ? glm::dot(y1, a) >= -eps && !inside_cylinder(y1, to_before, r)
                            : glm::dot(y1, t_before + a) >= -2 * eps;
      ok = ok && (s.cut_end ? glm::dot(y2, a) <= eps && !inside_cylinder(y2, to_after, r)
                            : glm::dot(y2, a + t_after) <= 2 * eps);
      if (ok && foot + s0 > 0) {
        entry.t = foot + s0;
        entry.h = l / r;
        entry.piece = 0;
        entry.at = y1;
        entry.edge = std::abs(std::min(s.cut_start ? glm::dot(y1, a) : glm::dot(y1, unit(t_before + a)),
                                       s.cut_end ? -glm::dot(y2, a) : -glm::dot(y2, unit(a + t_after)))) /
                     r;
      }
    }
  }
  const auto sphere = [&](vec centre, vec ea, vec eb, int which) {
    const vec w = o - centre;
    const Real foot = -glm::dot(w, d) / dd;
    const vec q = w + foot * d;
    const Real disc = r * r - glm::dot(q, q);
    if (disc < 0) return;
    const Real s0 = -std::sqrt(disc / dd), t = foot + s0;
    const vec x = q + s0 * d;
    for (const vec& arm : {ea, eb}) {
      const Real length = glm::length(arm), z = length > 0 ? glm::dot(x, arm) / length : 0;
      if (z > eps && (z < length || s.capsules)) return;
    }
    if (!(t > 0 && t < entry.t)) return;
    entry.t = t;
    entry.h = glm::length(q) / r;
    entry.piece = which;
    entry.at = x + centre - start;
    entry.edge = Real(1e30L);
  };
  if (s.sphere_start) sphere(start, e, to_before, 1);
  if (s.sphere_end) sphere(end, -e, to_after, 2);
  return entry;
}

template SegmentEntry<double> segment_entry<double>(const OracleSegment&, const Ray&, double);
template SegmentEntry<long double> segment_entry<long double>(const OracleSegment&, const Ray&, double);

}  // namespace wale::test
