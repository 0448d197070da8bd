#pragma once
// Rays aimed at where the segments of plies meet.
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/kernels/brute_force.h"

namespace wale::test {

/// Small and the same everywhere: one stream per ray.
struct Stream {
  uint64_t state;
  uint64_t next() {
    uint64_t z = state += 0x9e3779b97f4a7c15ull;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ z >> 27) * 0x94d049bb133111ebull;
    return z ^ z >> 31;
  }
  double uniform() { return double(next() >> 11) * 0x1p-53; }
  dvec3 direction() {
    const double z = 2 * uniform() - 1, a = 2 * M_PI * uniform(), s = std::sqrt(1 - z * z);
    return {s * std::cos(a), s * std::sin(a), z};
  }
};

/// A joint: places in the oracle's list of the two segments that meet there.
struct JointPair {
  uint32_t before, after;
};

/// Every joint between two traced segments, of patches and of closed yarns too.
std::vector<JointPair> joints_of(const BruteForce& oracle);

/// A ray through a point of the joint's plane, inside the ply, or a hair beside it (1e-7 to 1 radii); half of them
/// along the plane. From 3 to 1e5 radii away.
Ray ray_at(const BruteForce& oracle, JointPair joint, Stream& random);

}  // namespace wale::test
