#pragma once
// One ray against one ply segment: the definitions of kernels/geometry/ply_segment.clh written anew, term by term and
// without its shortcuts, in double or in long double (64 bits of mantissa on x86: 2000 times finer than double).
#include <cstdint>

#include "geom/vec.h"

namespace wale::test {

/// Ray as the kernels take it: origin o + l.
struct Ray {
  float o[3] = {0, 0, 0}, l[3] = {0, 0, 0}, d[3] = {0, 0, 1};
  float tmax = 1e30f;
  uint32_t key = 0, skip = 0xffffffffu, skip_triangle = 0xffffffffu, pad = 0;
};

/// A segment with its neighbours' far ends; what is cut square carries a sphere where the segment owns it.
struct OracleSegment {
  dvec3 before, start, end, after;  ///< metres
  bool cut_start, cut_end, sphere_start, sphere_end;
  double radius;  ///< metres
  float tau;      ///< optical radius; -1 or less = opaque
  uint32_t id;    ///< vertex id of its start
  bool capsules = false;  ///< every joint of the ply has a sphere: no part of one shows beyond the next joint
};

/// Front-face entry of a ray into one segment.
template <typename Real>
struct SegmentEntry {
  Real t = 1e30L;     ///< metres along the ray; 1e30: none
  Real h = 0;         ///< offset of the ray's line from the axis (of a sphere's centre) / r, signed on sides
  Real edge = 1e30L;  ///< distance of an entry through the side from the nearer plane that ends it, in radii
  glm::vec<3, Real> at = {0, 0, 0};  ///< of the entry, from the segment's start, metres
  int piece = -1;                    ///< W_PIECE_*, -1: none
  bool hit() const { return piece >= 0; }
};

/// `shrink` takes that many radii off the ply: a ray that meets the shrunken ply meets the whole one with that
/// clearance.
template <typename Real>
SegmentEntry<Real> segment_entry(const OracleSegment& segment, const Ray& ray, double shrink = 0);

extern template SegmentEntry<double> segment_entry<double>(const OracleSegment&, const Ray&, double);
extern template SegmentEntry<long double> segment_entry<long double>(const OracleSegment&, const Ray&, double);

}  // namespace wale::test
