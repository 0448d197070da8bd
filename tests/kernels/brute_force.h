#pragma once
// The oracle: every segment, in long double, one after the other.
#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host/ply_tree.h"
#include "shared/wale_types.h"
#include "tests/kernels/ply_oracle.h"

namespace wale::test {

struct OracleHit {
  double t = 1e30;              ///< metres
  long double exact_t = 1e30L;  ///< the same, not rounded to double
  bool hit = false;
  uint32_t segment = 0;  ///< vertex id of its start
  int piece = 0;
  double h = 0;
  double edge = 1e30;    ///< distance of an entry through the side from the nearer plane that ends it, in radii
  dvec3 at = {0, 0, 0};  ///< of the entry, from the segment's start, metres
};

class BruteForce {
 public:
  /// `positions`: x, y, z of every vertex.
  BruteForce(const std::vector<PlyPatch>& patches, const std::vector<float>& positions,
             Joints joints = Joints::mitre);
  /// `skip` is the id of the segment that the ray starts on, or -1.
  OracleHit closest(const Ray& ray, long skip = -1) const;
  size_t segments() const { return segments_.size(); }
  const OracleSegment& segment(size_t index) const { return segments_[index]; }
  /// Place in the list of the segment that starts at vertex `id`, or -1.
  long index_of(uint32_t id) const;
  /// Places of the segments that come before and after on the same ply, round the join of a closed yarn too; -1: none.
  long before(size_t index) const { return before_[index]; }
  long after(size_t index) const { return after_[index]; }
  /// Some segment whose bounding sphere holds x satisfies the predicate.
  template <typename Predicate>
  bool any_near(dvec3 x, const Predicate& predicate) const {
    const auto holds = [&](double cx, double cy, double cz, double reach) {
      const dvec3 w = x - dvec3(cx, cy, cz);
      return glm::dot(w, w) <= reach;
    };
    for (size_t b = 0; b < block_x_.size(); ++b) {
      if (!holds(block_x_[b], block_y_[b], block_z_[b], block_reach_[b])) continue;
      for (size_t i = b * kBlock; i < std::min((b + 1) * kBlock, segments_.size()); ++i)
        if (holds(x_[i], y_[i], z_[i], reach_[i]) && predicate(segments_[i])) return true;
    }
    return false;
  }
  /// Two segments share a joint; after one of them a ray meets the other from 1e-4 radii on.
  static bool joined(const OracleSegment& a, const OracleSegment& b);
  /// A ray of this key goes through the segment without meeting a fibre.
  static bool passes(const OracleSegment& segment, uint32_t key, double h);

 private:
  void connect(const std::vector<PlyPatch>& patches);

  std::vector<OracleSegment> segments_;
  std::unordered_map<uint32_t, size_t> index_;
  std::vector<long> before_, after_;
  std::vector<double> x_, y_, z_, reach_;  // centres and squared bounding radii, apart for a fast first test
  // Spheres round kBlock consecutive segments, which lie beside each other on one yarn: they spare the test of segments
  // that the ray passes by far, and share nothing with the device's tree.
  static constexpr size_t kBlock = 32;
  std::vector<double> block_x_, block_y_, block_z_, block_reach_;
};

}  // namespace wale::test
