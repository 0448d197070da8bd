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

}  // namespace

BruteForce::BruteForce(const std::vector<PlyPatch>& patches, const std::vector<float>& positions, Joints joints) {
  for (const PlyPatch& patch : patches)
    for (uint32_t p = 0; p < patch.plies; ++p) {
      Polyline line;
      line.ghosts = patch.ghost_ends;
      line.r = patch.radius;
      const uint32_t first = patch.first_vertex + p * patch.count;
      for (uint32_t i = 0; i < patch.count; ++i) {
        const float* v = positions.data() + size_t(first + i) * 3;
        line.p.emplace_back(v[0], v[1], v[2]);
      }
      for (uint32_t k = 0; k < patch.intervals; ++k) {
        const long i = long(patch.first + k);
        OracleSegment s{line.at(i - 1), line.at(i), line.at(i + 1), line.at(i + 2), line.cut(i),        line.cut(i + 1),
                        false,          false,      patch.radius,   patch.tau,      first + uint32_t(i)};
        s.capsules = joints == Joints::capsule;
        if (joints != Joints::mitre) s.cut_start = s.cut_end = true;
        s.sphere_start = s.cut_start && joints != Joints::open;
        s.sphere_end = s.cut_end && joints != Joints::open && !patch.ghost_ends && i + 2 == long(patch.count);
        index_[s.id] = segments_.size();
        segments_.push_back(s);
        const dvec3 c = 0.5 * (s.start + s.end);
        x_.push_back(c.x);
        y_.push_back(c.y);
        z_.push_back(c.z);
        reach_.push_back(std::pow(0.5 * glm::length(s.end - s.start) + 2.1 * s.radius, 2));
      }
    }
  connect(patches);
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

void BruteForce::connect(const std::vector<PlyPatch>& patches) {
  before_.assign(segments_.size(), -1);
  after_.assign(segments_.size(), -1);
  const auto join = [&](long a, long b) {
    if (a < 0 || b < 0 || !joined(segments_[size_t(a)], segments_[size_t(b)])) return;
    after_[size_t(a)] = b;
    before_[size_t(b)] = a;
  };
  for (const PlyPatch& patch : patches)
    for (uint32_t p = 0; p < patch.plies; ++p) {
      const uint32_t first = patch.first_vertex + p * patch.count;
      for (uint32_t k = 0; k < patch.intervals; ++k) {
        const uint32_t i = patch.first + k;
        if (i + 1 < patch.count) join(index_of(first + i), index_of(first + i + 1));
      }
      if (patch.ghost_ends && patch.count > 3) join(index_of(first + patch.count - 3), index_of(first + 1));
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
    const double along = (x * d.x + y * d.y + z * d.z) / dd;
    const double qx = x - along * d.x, qy = y - along * d.y, qz = z - along * d.z;
    return qx * qx + qy * qy + qz * qz <= reach;
  };
  std::vector<uint8_t> near_block(block_x_.size());
  for (size_t b = 0; b < near_block.size(); ++b)
    near_block[b] = meets(block_x_[b], block_y_[b], block_z_[b], block_reach_[b]);
  const long left = skip < 0 ? -1 : index_of(uint32_t(skip));
  for (size_t i = 0; i < segments_.size(); ++i) {
    if (!near_block[i / kBlock]) {
      i = (i / kBlock + 1) * kBlock - 1;
      continue;
    }
    if (long(i) == left || !meets(x_[i], y_[i], z_[i], reach_[i])) continue;
    const OracleSegment& s = segments_[i];
    const SegmentEntry<long double> entry = segment_entry<long double>(s, ray);
    if (!entry.hit() || entry.t > ray.tmax || entry.t > best.exact_t) continue;
    if (left >= 0 && joined(segments_[size_t(left)], s)) {
      const long double t = entry.t / s.radius, steep = std::sqrt(std::max(0.0L, 1 - entry.h * entry.h));
      if (t < 1e-4L || (t < 0.1L && t * steep < 1e-5L)) continue;
    }
    if (passes(s, ray.key, double(entry.h))) continue;
    best.exact_t = entry.t;
    best.hit = true;
    best.segment = s.id;
    best.piece = entry.piece;
    best.h = double(entry.h);
    best.edge = double(entry.edge);
    best.at = dvec3(entry.at);
  }
  best.t = double(best.exact_t);
  return best;
}

bool BruteForce::passes(const OracleSegment& segment, uint32_t key, double h) {
  return segment.tau > -1 &&
         w_hash_uniform(w_hash2(key, segment.id)) < std::exp(-2.0 * segment.tau * std::sqrt(std::max(0.0, 1 - h * h)));
}

// Ends that meet: as vertices of one ply follow each other, or where a closed yarn joins.
bool BruteForce::joined(const OracleSegment& a, const OracleSegment& b) {
  if (a.id + 1 == b.id || b.id + 1 == a.id) return true;
  const double near = 1e-2 * a.radius;
  return glm::length(a.end - b.start) < near || glm::length(b.end - a.start) < near;
}

long BruteForce::index_of(uint32_t id) const {
  const auto found = index_.find(id);
  return found == index_.end() ? -1 : long(found->second);
}

}  // namespace wale::test
