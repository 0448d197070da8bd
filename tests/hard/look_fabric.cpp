#include "tests/hard/look_fabric.h"

#include <algorithm>
#include <cmath>

#include "tests/image/picture.h"
#include "tests/kernels/fabric_tracer.h"

namespace wale::test {
namespace {

void compare(Agreement& sum, const Fabric& fabric, const FabricTracer& tracer, const BruteForce& oracle,
             const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
  for (size_t i = 0; i < rays.size(); ++i, ++sum.rays) {
    const OracleHit e = oracle.closest(rays[i], rays[i].skip == W_NONE ? -1 : long(tracer.segment(rays[i].skip)));
    const bool hit = hits[i].kind == W_HIT_PLY;
    sum.hits += hit;
    const double dt = hit && e.hit ? std::abs(hits[i].t - e.t) / fabric.ply_radius : 0;
    if (hit == e.hit && hit == (hits[i].occluded != 0) && dt <= 1e-3) {
      sum.worst = std::max(sum.worst, dt);
      continue;
    }
    const double h = std::max(hit ? std::abs(double(hits[i].u)) : 0, e.hit ? std::abs(e.h) : 0);
    ++(h > 0.999 || (e.hit && e.edge < 1e-3) ? sum.grazing : sum.wrong);
  }
}

}  // namespace

Agreement compare_with_brute_force(const Fabric& fabric, size_t rays) {
  const FabricTracer tracer(device(), fabric);
  const BruteForce oracle(patches_of(fabric, -1), tracer.positions());
  Agreement sum;
  const std::vector<Ray> primary = primary_rays(tracer.bounds(), rays, 3);
  const std::vector<Hit> first = tracer.trace(primary);
  compare(sum, fabric, tracer, oracle, primary, first);
  const std::vector<Ray> bounce = bounce_rays(primary, first, tracer.surfaces(primary, first), 5);
  if (!bounce.empty()) compare(sum, fabric, tracer, oracle, bounce, tracer.trace(bounce));
  return sum;
}

uint64_t rays_that_pass(const Fabric& fabric, dvec3 target, dvec3 direction, double size, int across) {
  const FabricTracer tracer(device(), fabric);
  const dvec3 z = glm::normalize(direction);
  const dvec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), z));
  const dvec3 y = glm::cross(z, x);
  std::vector<Ray> rays;
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const dvec2 at = size * ((dvec2(i, j) + 0.5) / double(across) - 0.5);
      rays.push_back(make_ray(target + at.x * x + at.y * y - 0.05 * z, z, uint32_t(rays.size())));
    }
  const std::vector<Hit> hits = tracer.trace(rays);
  return uint64_t(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.kind == W_HIT_NONE; }));
}

}  // namespace wale::test
