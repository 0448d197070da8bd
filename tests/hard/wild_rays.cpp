#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "host/program.h"
#include "tests/hard/fixtures_curves.h"
#include "tests/hard/wild_numbers.h"

namespace wale::test {
namespace {

constexpr const char* kLanes = "-DW_LANES=16";
constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

Strands cloth() { return stockinette(4, 5, 30); }

/// Component 0 to 9 of a ray: origin, offset, direction, tmax.
float& component(Ray& ray, size_t i) {
  return i < 3 ? ray.o[i] : i < 6 ? ray.l[i - 3] : i < 9 ? ray.d[i - 6] : ray.tmax;
}

/// Sound rays each of which got one component, or its whole direction, that is no use.
std::vector<Ray> spoiled(std::vector<Ray> rays) {
  const float bad[] = {kNan, -kNan, kInf, -kInf};
  for (size_t i = 0; i < rays.size(); ++i) {
    if (i % 11 == 10) {
      const float none[] = {0.0f, -0.0f, 1e-42f, 1e-30f};
      for (float& d : rays[i].d) d = none[i / 11 % 4];
    } else {
      component(rays[i], i % 11) = i % 11 == 9 ? kNan : bad[i / 11 % 4];  // an infinite tmax is no trap
    }
  }
  return rays;
}

bool same(const Hit& a, const Hit& b) {
  return a.kind == b.kind && a.occluded == b.occluded && (a.kind == W_HIT_NONE || (a.t == b.t && a.code == b.code));
}

}  // namespace

float random_finite(std::mt19937& random) {
  for (;;) {
    const float x = std::bit_cast<float>(uint32_t(random()));
    if (std::isfinite(x)) return x;
  }
}

bool bounded(const Ray& ray, const Hit& hit) {
  if (hit.kind == W_HIT_NONE) return hit.occluded == 0;
  return hit.kind == W_HIT_PLY && hit.occluded && hit.t > 0 && hit.t <= ray.tmax && std::isfinite(hit.t) &&
         std::abs(hit.u) <= 1.00001f && hit.v >= 0 && hit.v <= 2;
}

Finding look_at_rays_that_are_not_finite() {
  Tracer tracer(test_device(), cloth());
  const std::vector<Ray> sound = primary_rays(tracer.tree().bounds, 22000, 21), bad = spoiled(sound);
  std::vector<Ray> mixed;
  for (size_t i = 0; i < sound.size(); ++i) mixed.push_back(i % 3 ? sound[i] : bad[i]);
  const std::vector<Hit> alone = tracer.trace(sound, kLanes);
  const uint32_t before = tracer.events()[W_EVENT_RAY];
  const std::vector<Hit> hits = tracer.trace(mixed, kLanes);
  const uint32_t counted = tracer.events()[W_EVENT_RAY] - before;
  Finding f;
  f.trials = mixed.size();
  f.error_float = 0;
  size_t expected = 0;
  for (size_t i = 0; i < mixed.size(); ++i) {
    expected += i % 3 == 0;
    if (i % 3 ? !same(hits[i], alone[i]) : hits[i].kind != W_HIT_NONE || hits[i].occluded) ++f.error_float;
  }
  // Each ray is traced twice: nearest hit and any hit.
  if (counted != 2 * expected) f.broken = fmt::format("{} rays were counted instead of {}", counted, 2 * expected);
  f.rare = counted / 2;
  return f;
}

Finding look_at_their_time() {
  Tracer tracer(test_device(), stockinette(20, 20, 40));
  const std::vector<Ray> sound = primary_rays(tracer.tree().bounds, 110000, 22), bad = spoiled(sound);
  double best_sound = kInf, best_bad = kInf;
  for (int repeat = 0; repeat < 3; ++repeat) {
    best_sound = std::min(best_sound, tracer.time(sound, kLanes, "closest"));
    best_bad = std::min(best_bad, tracer.time(bad, kLanes, "closest"));
  }
  Finding f;
  f.trials = bad.size();
  f.error_float = best_bad / best_sound;
  return f;
}

Finding look_at_rays_of_random_bits() {
  Tracer tracer(test_device(), cloth());
  std::mt19937 random(23);
  std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 30000, 24);
  for (size_t i = 0; i < rays.size(); ++i) {
    const size_t kind = i % 5;
    if (kind == 0 || kind == 3)
      for (float& x : rays[i].o) x = random_finite(random);
    if (kind == 1 || kind == 3)
      for (float& x : rays[i].l) x = random_finite(random);
    if (kind == 2)
      for (float& x : rays[i].d) x = random_finite(random);
    if (kind >= 3) rays[i].tmax = random_finite(random);
  }
  const std::vector<Hit> hits = tracer.trace(rays, kLanes);
  Finding f;
  f.trials = rays.size();
  f.error_float = 0;
  for (size_t i = 0; i < rays.size(); ++i) f.error_float += !bounded(rays[i], hits[i]);
  return f;
}

Finding look_at_denormal_rays() {
  Tracer tracer(test_device(), cloth());
  std::mt19937 random(25);
  std::vector<Ray> rays = primary_rays(tracer.tree().bounds, 20000, 26), flushed = rays;
  for (size_t i = 0; i < rays.size(); ++i)
    for (const size_t at : {i % 6, (i / 6) % 9}) {
      // The largest component of the direction stays: without it there is no direction.
      if (at >= 6 && std::abs(component(rays[i], at)) > 0.5f) continue;
      component(rays[i], at) = std::bit_cast<float>((uint32_t(random()) & 0x807fffffu) | 1u);
      component(flushed[i], at) = 0;
    }
  // Directions have lost a component: of unit length again.
  for (size_t i = 0; i < rays.size(); ++i) {
    const float length = std::hypot(flushed[i].d[0], flushed[i].d[1], flushed[i].d[2]);
    for (int k = 0; k < 3; ++k) {
      flushed[i].d[k] /= length;
      if (flushed[i].d[k] != 0) rays[i].d[k] = flushed[i].d[k];
    }
  }
  const std::vector<Hit> hits = tracer.trace(rays, kLanes), expected = tracer.trace(flushed, kLanes);
  Finding f;
  f.trials = rays.size();
  f.error_float = 0;
  size_t hit = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    f.error_float += !same(hits[i], expected[i]);
    hit += hits[i].kind != W_HIT_NONE;
  }
  if (hit < rays.size() / 50) f.broken = "hardly a ray hits";
  return f;
}

}  // namespace wale::test
