#pragma once
// The oracle: every segment, in double, one after the other, with the definitions of kernels/geometry/ply_segment.clh
// written anew.
#include <cstdint>
#include <vector>

#include "geom/vec.h"
#include "host/ply_tree.h"
#include "shared/wale_types.h"

namespace wale::test {

/// Ray as the kernels take it: origin o + l.
struct Ray {
  float o[3] = {0, 0, 0}, l[3] = {0, 0, 0}, d[3] = {0, 0, 1};
  float tmax = 1e30f;
  uint32_t key = 0, skip = 0xffffffffu, skip_triangle = 0xffffffffu, pad = 0;
};

struct OracleHit {
  double t = 1e30;
  bool hit = false;
  uint32_t segment = 0;  ///< vertex id of its start
  int piece = 0;
  double h = 0;
  double edge = 1e30;  ///< distance of an entry through the side from the nearer plane that ends it, in radii
};

class BruteForce {
 public:
  /// `vertices` as in the device's vertex buffer (W_VERTEX_WORDS floats each).
  BruteForce(const std::vector<PlyPatch>& patches, const std::vector<float>& vertices);
  /// `skip` is the id of the segment that the ray starts on, or -1.
  OracleHit closest(const Ray& ray, long skip = -1) const;
  size_t segments() const { return segments_.size(); }

 private:
  struct Segment {
    dvec3 before, start, end, after;
    bool cut_start, cut_end, sphere_start, sphere_end;
    double radius;
    float tau;
    uint32_t id;
  };
  std::vector<Segment> segments_;
  std::vector<double> x_, y_, z_, reach_;  // centres and squared bounding radii, apart for a fast first test
  // Spheres round kBlock consecutive segments, which lie beside each other on one yarn: they spare the test of segments
  // that the ray passes by far, and share nothing with the device's tree.
  static constexpr size_t kBlock = 32;
  std::vector<double> block_x_, block_y_, block_z_, block_reach_;
};

}  // namespace wale::test
