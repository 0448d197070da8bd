#include "bench/cloth_rays.h"

#include <cmath>
#include <random>

namespace wale::bench {
namespace {

using namespace wale::test;

// Z-order index to pixel: neighbours in the list are neighbours on the film.
uint32_t every_second_bit(uint32_t x) {
  uint32_t out = 0;
  for (int k = 0; k < 16; ++k) out |= (x >> (2 * k) & 1u) << k;
  return out;
}

}  // namespace

Strands cloth(double segments) {
  constexpr uint32_t kSteps = 56;  // per 2 pi: two stitches
  const double stitches = segments / (3 * 28), loops = std::sqrt(stitches / 2 * 4.4 / 6.283);
  return stockinette(uint32_t(stitches / 2 / loops), uint32_t(loops), kSteps, 0.01, 400);
}

ClothRays cloth_rays(Tracer& tracer, uint32_t side, const std::string& options) {
  const Box& b = tracer.tree().bounds;
  const dvec3 lo(b.lo[0], b.lo[1], b.lo[2]), hi(b.hi[0], b.hi[1], b.hi[2]), middle = 0.5 * (lo + hi);
  const double size = glm::length(hi - lo);
  const dvec3 eye = middle + dvec3(0.1, -0.2, 1.2) * size;
  ClothRays out;
  for (uint32_t i = 0; i < side * side; ++i) {
    const dvec3 target(lo.x + (hi.x - lo.x) * (every_second_bit(i) + 0.5) / side,
                       lo.y + (hi.y - lo.y) * (every_second_bit(i >> 1) + 0.5) / side, middle.z);
    out.primary.push_back(make_ray(eye, target - eye, i));
  }
  const std::vector<Hit> hits = tracer.trace(out.primary, options);
  const std::vector<Surface> surfaces = tracer.surfaces(out.primary, hits);
  out.bounce = bounce_rays(out.primary, hits, surfaces, 1);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  size_t bounce = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].kind != W_HIT_PLY) continue;
    Ray ray = out.bounce[bounce++];
    const dvec3 start(double(ray.o[0]) + ray.l[0], double(ray.o[1]) + ray.l[1], double(ray.o[2]) + ray.l[2]);
    const dvec3 target = middle + size * dvec3(-0.3 + uniform(random), 0.3 + uniform(random), 1);
    const dvec3 d = glm::normalize(target - start);
    const float* n = surfaces[i].n;
    if (glm::dot(d, dvec3(n[0], n[1], n[2])) <= 0) continue;  // the light is behind the surface
    for (int k = 0; k < 3; ++k) ray.d[k] = float(d[k]);
    ray.tmax = float(glm::length(target - start));
    out.shadow.push_back(ray);
  }
  return out;
}

}  // namespace wale::bench
