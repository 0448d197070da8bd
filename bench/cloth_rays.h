#pragma once
// The workload of the traversal benchmarks: 3-ply stockinette on a bent sheet and the rays that a renderer would send.
#include <string>
#include <vector>

#include "tests/kernels/synthetic.h"

namespace wale::bench {

/// Stockinette of about `segments` ply segments, 28 a stitch.
test::Strands cloth(double segments);

struct ClothRays {
  std::vector<test::Ray> primary;  ///< side x side, in Morton order, towards the whole cloth
  std::vector<test::Ray> bounce;   ///< from every primary hit, uniform over the outer hemisphere
  std::vector<test::Ray> shadow;   ///< from every primary hit to a random point of a square light above the cloth
};
ClothRays cloth_rays(test::Tracer& tracer, uint32_t side, const std::string& options);

}  // namespace wale::bench
