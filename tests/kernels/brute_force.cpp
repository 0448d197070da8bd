#include "tests/kernels/brute_force.h"

#include <algorithm>
#include <cmath>

#include "sampling/hash.clh"

namespace wale::test {
namespace {

dvec3 unit(dvec3 a) {
  const double l = glm::length(a);
  return l > 0 ? a / l : dvec3(0);
}

struct Polyline {
  std::vector<dvec3> p;
  bool ghosts;
  double r;

  dvec3 at(long i) const {
    const long last = long(p.size()) - 1;
    if (i >= 0 && i <= last) return p[i];
    if (!ghosts || last < 3) return p[i < 0 ? 0 : last];
    return i < 0 ? p[last - 3] + (p[0] - p[last - 2]) : p[3] + (p[last] - p[2]);
  }
  dvec3 tangent(long i) const {  // of the segment that starts at i; zero for a point
    const dvec3 e = at(i + 1) - at(i);
    return glm::length(e) > 1e-5 * r ? unit(e) : dvec3(0);
  }
  double reach(long v) const {  // r tan(b/2)
    const double c = std::clamp(glm::dot(tangent(v - 1), tangent(v)), -1.0, 1.0);
    if (tangent(v - 1) == dvec3(0) || tangent(v) == dvec3(0)) return 0;
    return r * std::sqrt((1 - c) / std::max(1 + c, 1e-12));
  }
  bool bad(long i) const { return tangent(i) == dvec3(0) || reach(i) + reach(i + 1) > glm::length(at(i + 1) - at(i)); }
  bool cut(long v) const {
    if (!ghosts && (v == 0 || v == long(p.size()) - 1)) return true;
    return glm::dot(tangent(v - 1), tangent(v)) < -0.5 || bad(v - 1) || bad(v);
  }
};

bool inside_cylinder(dvec3 y, dvec3 e, double rr) {
  const double ll = glm::dot(e, e);
  if (ll == 0) return false;
  const double s = glm::dot(y, e);
  return s > 0 && s < ll && glm::dot(y, y) - s * s / ll < rr * (1 - 1e-4);
}

}  // namespace

BruteForce::BruteForce(const std::vector<PlyPatch>& patches, const std::vector<float>& vertices) {
  for (const PlyPatch& patch : patches)
    for (uint32_t p = 0; p < patch.plies; ++p) {
      Polyline line;
      line.ghosts = patch.ghost_ends;
      line.r = patch.radius;
      const uint32_t first = patch.first_vertex + p * patch.count;
      for (uint32_t i = 0; i < patch.count; ++i) {
        const float* v = vertices.data() + size_t(first + i) * W_VERTEX_WORDS;
        line.p.emplace_back(v[0], v[1], v[2]);
      }
      for (uint32_t k = 0; k < patch.intervals; ++k) {
        const long i = long(patch.first + k);
        Segment s{line.at(i - 1), line.at(i), line.at(i + 1), line.at(i + 2), line.cut(i),        line.cut(i + 1),
                  false,          false,      patch.radius,   patch.tau,      first + uint32_t(i)};
        s.sphere_start = s.cut_start;
        s.sphere_end = s.cut_end && !patch.ghost_ends && i + 2 == long(patch.count);
        segments_.push_back(s);
        const dvec3 c = 0.5 * (s.start + s.end);
        x_.push_back(c.x);
        y_.push_back(c.y);
        z_.push_back(c.z);
        reach_.push_back(std::pow(0.5 * glm::length(s.end - s.start) + 2.1 * s.radius, 2));
      }
    }
  for (size_t begin = 0; begin < segments_.size(); begin += kBlock) {
    const size_t end = std::min(begin + kBlock, segments_.size());
    dvec3 c(0);
    for (size_t i = begin; i < end; ++i) c += dvec3(x_[i], y_[i], z_[i]) / double(end - begin);
    double reach = 0;
    for (size_t i = begin; i < end; ++i)
      reach = std::max(reach, glm::length(dvec3(x_[i], y_[i], z_[i]) - c) + std::sqrt(reach_[i]));
    block_x_.push_back(c.x);
    block_y_.push_back(c.y);
    block_z_.push_back(c.z);
    block_reach_.push_back(reach * reach * (1 + 1e-9));
  }
}

OracleHit BruteForce::closest(const Ray& ray, long skip) const {
  OracleHit best;
  const dvec3 o = dvec3(ray.o[0], ray.o[1], ray.o[2]) + dvec3(ray.l[0], ray.l[1], ray.l[2]);
  const dvec3 d(ray.d[0], ray.d[1], ray.d[2]);
  const double dd = glm::dot(d, d);
  // The ray's line passes the sphere of squared radius `reach` round (cx, cy, cz).
  const auto meets = [&](double cx, double cy, double cz, double reach) {
    const double x = cx - o.x, y = cy - o.y, z = cz - o.z;
    const double along = x * d.x + y * d.y + z * d.z;
    return (x * x + y * y + z * z) - along * along / dd <= reach;
  };
  std::vector<uint8_t> near_block(block_x_.size());
  for (size_t b = 0; b < near_block.size(); ++b)
    near_block[b] = meets(block_x_[b], block_y_[b], block_z_[b], block_reach_[b]);
  for (size_t i = 0; i < segments_.size(); ++i) {
    if (!near_block[i / kBlock]) {
      i = (i / kBlock + 1) * kBlock - 1;
      continue;
    }
    if (!meets(x_[i], y_[i], z_[i], reach_[i]) || long(segments_[i].id) == skip) continue;
    const Segment& s = segments_[i];
    const double r = s.radius, eps = 1e-5 * r;
    double t = 1e30, h = 0, edge = 1e30;
    int piece = -1;
    const auto take = [&](double t_new, double h_new, int piece_new) {
      if (t_new > 0 && t_new < t) {
        t = t_new;
        h = h_new;
        piece = piece_new;
      }
    };
    const dvec3 e = s.end - s.start, a = unit(e);
    const dvec3 k = glm::cross(a, d);
    const double kk = glm::dot(k, k);
    if (kk > 1e-6 * dd && a != dvec3(0)) {
      const dvec3 w = o - 0.5 * (s.start + s.end);
      const double foot = -glm::dot(w, d) / dd;
      const dvec3 q = w + foot * d;
      const double l = glm::dot(q, k) / std::sqrt(kk), disc = (r - l) * (r + l);
      if (disc >= 0) {
        const double g = (glm::dot(q, d) - glm::dot(a, q) * glm::dot(a, d)) / kk;
        const double s0 = -g - std::sqrt(disc / kk), t0 = foot + s0;
        const dvec3 x = q + s0 * d, y1 = x + 0.5 * e, y2 = x - 0.5 * e;
        const dvec3 t_before = unit(s.start - s.before), t_after = unit(s.after - s.end);
        bool ok = s.cut_start ? glm::dot(y1, a) >= -eps && !inside_cylinder(y1, s.before - s.start, r * r)
                              : glm::dot(y1, t_before + a) >= -2 * eps;
        ok = ok && (s.cut_end ? glm::dot(y2, a) <= eps && !inside_cylinder(y2, s.after - s.end, r * r)
                              : glm::dot(y2, a + t_after) <= 2 * eps);
        if (ok) take(t0, l / r, 0);
        if (piece == 0)
          edge = std::min(s.cut_start ? glm::dot(y1, a) : glm::dot(y1, unit(t_before + a)),
                          s.cut_end ? -glm::dot(y2, a) : -glm::dot(y2, unit(a + t_after))) /
                 r;
      }
    }
    const auto sphere = [&](dvec3 centre, dvec3 ea, dvec3 eb, int which) {
      const dvec3 w = o - centre;
      const double foot = -glm::dot(w, d) / dd;
      const dvec3 q = w + foot * d;
      const double disc = r * r - glm::dot(q, q);
      if (disc < 0) return;
      const double s0 = -std::sqrt(disc / dd);
      const dvec3 x = q + s0 * d;
      for (const dvec3& arm : {ea, eb}) {
        const double length = glm::length(arm), z = length > 0 ? glm::dot(x, arm) / length : 0;
        if (z > eps && z < length) return;
      }
      take(foot + s0, glm::length(q) / r, which);
    };
    if (s.sphere_start) sphere(s.start, e, s.before - s.start, 1);
    if (s.sphere_end) sphere(s.end, -e, s.after - s.end, 2);
    if (piece < 0 || t > ray.tmax || t > best.t) continue;
    if (std::abs(long(s.id) - skip) == 1 && skip >= 0 && t < 1e-4 * r) continue;
    if (s.tau > -1) {
      const float u = w_hash_uniform(w_hash2(ray.key, s.id));
      if (u < std::exp(-2.0 * s.tau * std::sqrt(std::max(0.0, 1 - h * h)))) continue;
    }
    best.t = t;
    best.hit = true;
    best.segment = s.id;
    best.piece = piece;
    best.h = h;
    best.edge = piece == 0 ? std::abs(edge) : 1e30;
  }
  return best;
}

}  // namespace wale::test
