#include <cmath>
#include <numbers>

#include "tests/hard/curve_look.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

using std::numbers::pi;

/// Random numbers for the rays of one trap.
struct Dice {
  std::mt19937 engine;
  std::normal_distribution<double> gauss;
  explicit Dice(uint32_t seed) : engine(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  dvec3 direction() { return glm::normalize(dvec3(gauss(engine), gauss(engine), gauss(engine))); }
};

/// Any unit vector square to a.
dvec3 square_to(dvec3 a, Dice& dice) { return glm::normalize(glm::cross(a, dice.direction())); }

Finding along_the_axis() {
  // 12 radii of straight ply, then a bend: rays inside reach the bend or the cap, rays outside pass by.
  HardCurve curve = straight(6, 2);
  curve.plies[0].push_back({13.5, 1.5, 0});
  curve.plies[0].push_back({14.5, 4, 0});
  Dice dice(1);
  RayCase c{strands_of(curve), {}};
  for (int n = 0; n < 30000; ++n) {
    const double off = n % 3 == 0 ? 0 : std::pow(10, dice.uniform(-7, -3));
    const double turn = dice.uniform(0, 2 * pi), out = n % 2 ? dice.uniform(0, 0.97) : dice.uniform(1.03, 3);
    const dvec3 at(dice.uniform(0, 1) < 0.5 ? dice.uniform(0.5, 11.5) : -3.0, out * std::cos(turn),
                   out * std::sin(turn));
    c.rays.push_back(
        make_ray(at, dvec3(n % 5 ? 1 : -1, off * std::cos(3 * turn), off * std::sin(3 * turn)), uint32_t(n)));
  }
  return look_at_rays({c});
}

/// Rays that creep into 200 radii of straight ply at angles below the one from which sides count: how deep those go
/// that the device does not stop, per length of the way along the ply.
Finding creeping_in() {
  constexpr double kLength = 200;
  const Strands strands = strands_of(straight(50, kLength / 50));
  Dice dice(14);
  std::vector<Ray> rays;
  std::vector<double> depth;
  for (int n = 0; n < 20000; ++n) {
    const double angle = std::pow(10, dice.uniform(-6, -2.5)), turn = dice.uniform(0, 2 * pi);
    const dvec3 out(0, std::cos(turn), std::sin(turn));
    // Enters the surface at x = at, aimed at the axis.
    const double at = dice.uniform(0, kLength);
    const dvec3 d(std::cos(angle), -std::sin(angle) * out.y, -std::sin(angle) * out.z);
    rays.push_back(make_ray(dvec3(at, 0, 0) + out - 1e-2 / std::sin(angle) * d, d, uint32_t(n)));
    depth.push_back(std::tan(angle) * (kLength - at));
  }
  Tracer tracer(test_device(), strands);
  const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
  Finding f;
  f.error_float = 0;
  f.trials = rays.size();
  size_t stopped = 0;
  for (size_t n = 0; n < rays.size(); ++n) {
    stopped += hits[n].kind == W_HIT_PLY;
    if (hits[n].kind != W_HIT_PLY) f.error_float = std::max(f.error_float, depth[n] / kLength);
  }
  if (stopped < rays.size() / 10) f.broken = "steeper rays are not stopped either";
  return f;
}

Finding through_the_axis() {
  RayCase c{strands_of(helix_curve()), {}};
  Dice dice(2);
  for (int n = 0; n < 20000; ++n) {
    const size_t v = 2 + size_t(dice.uniform(0, 56));
    const dvec3 a = vertex_of(c.strands, v), b = vertex_of(c.strands, v + 1);
    const dvec3 target = n % 4 ? a + dice.uniform(0, 1) * (b - a) : a, d = dice.direction();
    c.rays.push_back(make_ray(target - 6.0 * d, d, uint32_t(n)));
  }
  return look_at_rays({c});
}

/// In the plane that bisects joint v: rays through its ellipse.
Finding along_a_mitre_plane() {
  std::vector<RayCase> cases;
  for (const double scale : {1.0, 2e-4}) {
    RayCase c{strands_of(helix_curve(), scale), {}};
    Dice dice(3);
    for (int n = 0; n < 20000; ++n) {
      const size_t v = 2 + size_t(dice.uniform(0, 56));
      const dvec3 p = vertex_of(c.strands, v);
      const dvec3 m = glm::normalize(glm::normalize(p - vertex_of(c.strands, v - 1)) +
                                     glm::normalize(vertex_of(c.strands, v + 1) - p));
      const dvec3 in = square_to(m, dice), side = glm::cross(m, in);
      c.rays.push_back(make_ray(p + scale * (dice.uniform(-0.97, 0.97) * side - 5.0 * in), in, uint32_t(n)));
    }
    cases.push_back(c);
  }
  // The oracle's own answer at the edge is as uncertain as the device's: what counts is that none of them misses.
  Finding f = look_at_rays(cases);
  for (const RayCase& c : cases) {
    Tracer tracer(test_device(), c.strands);
    for (const Hit& hit : tracer.trace(c.rays, "-DW_LANES=16"))
      if (hit.kind != W_HIT_PLY) f.broken = "a ray in a mitre plane slips through the joint";
  }
  return f;
}

Finding grazing() {
  RayCase c{strands_of(straight(4, 3)), {}};
  Dice dice(4);
  // By how much the lines miss the surface; beyond 1e-5 the answer is certain.
  const double gaps[] = {-1e-7, 1e-7, -1e-6, 1e-6, -1e-5, 1e-5, 0};
  size_t wrong = 0;
  for (int n = 0; n < 21000; ++n) {
    const double turn = dice.uniform(0, 2 * pi), gap = gaps[n % 7];
    const dvec3 side(0, std::cos(turn), std::sin(turn)),
        ahead(dice.uniform(-0.7, 0.7), -std::sin(turn), std::cos(turn));
    c.rays.push_back(make_ray(dvec3(dice.uniform(4, 8), 0, 0) + (1 + gap) * side - 2.5 * ahead, ahead, uint32_t(n)));
  }
  Finding f = look_at_rays({c});
  Tracer tracer(test_device(), c.strands);
  const std::vector<Hit> hits = tracer.trace(c.rays, "-DW_LANES=16");
  for (size_t n = 0; n < hits.size(); ++n)
    if (std::abs(gaps[n % 7]) > 5e-6) wrong += (hits[n].kind == W_HIT_PLY) != (gaps[n % 7] < 0);
  if (wrong) f.broken = "a ray 1e-5 radii clear of the silhouette is on its wrong side";
  return f;
}

/// What leaves the hits on a bent ply: outward, flat along the surface, and along the ply.
Finding start_on_the_surface() {
  std::vector<RayCase> cases;
  for (const Strands& strands :
       {strands_of(helix_curve()), strands_of(eight_plies(), 1e-4), strands_of(straight(6, 2))}) {
    Tracer tracer(test_device(), strands);
    const std::vector<Ray> rays = aimed_rays(strands, 10000, 8, 6);
    const std::vector<Hit> hits = tracer.trace(rays, "-DW_LANES=16");
    const std::vector<Surface> at = tracer.surfaces(rays, hits);
    Dice dice(7);
    RayCase c{strands, {}};
    for (size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].kind != W_HIT_PLY) continue;
      const dvec3 normal(at[i].n[0], at[i].n[1], at[i].n[2]), axis(at[i].t[0], at[i].t[1], at[i].t[2]);
      const double lift = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 0.1 : 1;
      dvec3 d = glm::normalize(i % 2 ? square_to(normal, dice) : axis) + lift * normal;
      Ray ray = make_ray(dvec3(at[i].anchor[0], at[i].anchor[1], at[i].anchor[2]), d, uint32_t(i));
      for (int k = 0; k < 3; ++k) ray.l[k] = at[i].x[k];
      ray.skip = hits[i].code;
      c.rays.push_back(ray);
    }
    cases.push_back(c);
  }
  return look_at_rays(cases);
}

/// From inside a ply of the eight: its own far wall is no hit, the next ply is.
Finding start_inside(const HardCurve& curve, uint32_t seed) {
  RayCase c{strands_of(curve), {}};
  Dice dice(seed);
  for (Ray& ray : aimed_rays(c.strands, 20000, 0, seed)) {
    const dvec3 d = dice.direction();
    for (int k = 0; k < 3; ++k) ray.d[k] = float(d[k]);
    c.rays.push_back(ray);
  }
  return look_at_rays({c});
}

Finding from_afar(double radii) {
  std::vector<RayCase> cases;
  for (const HardCurve& curve : {helix_curve(), eight_plies(), fold()}) {
    const Strands strands = strands_of(curve);
    cases.push_back({strands, aimed_rays(strands, 10000, radii, 9)});
  }
  return look_at_rays(cases);
}

/// Directions with components that are exactly 0, of either sign, or denormal; origins on coordinate planes.
Finding zero_components() {
  HardCurve rows;
  for (int row = 0; row < 8; ++row) {
    rows.plies.emplace_back();
    for (int i = 0; i < 8; ++i) rows.plies.back().push_back(dvec3(i, 3 * row, row % 2));
  }
  RayCase c{strands_of(rows), {}};
  Dice dice(10);
  for (int n = 0; n < 8000; ++n) {
    const int axis = n % 3;
    dvec3 o(std::floor(dice.uniform(0, 8)), std::floor(dice.uniform(0, 22)), 0), d(0);
    d[axis] = n % 2 ? 1 : -1;
    o[axis] = d[axis] * -20;
    Ray ray = make_ray(o, d, uint32_t(n));
    const float tiny[] = {0.0f, -0.0f, 1e-42f, -1e-42f, 1e-30f, -1e-30f};
    for (int k = 0; k < 3; ++k)
      if (k != axis) ray.d[k] = tiny[(n / 6 + k) % 6];
    c.rays.push_back(ray);
  }
  return look_at_rays({c});
}

Trap ray_trap(std::string name, std::string breaks, std::string promise, std::function<Finding()> look) {
  return {std::move(name), std::move(breaks), std::move(promise), "ply radii", tolerance::kPointFloat, 0,
          std::move(look)};
}

Trap afar(std::string name, double radii) {
  return ray_trap(std::move(name), "origin minus vertex is rounded at the origin's distance, not at the ply's size",
                  "the hit lies on the surface and on the ray of the float origin and direction",
                  [radii] { return from_afar(radii); });
}

}  // namespace

std::vector<Trap> ray_traps() {
  return {
      ray_trap(
          "ray parallel to the axis", "the quadratic's first coefficient is 0, or the rounding of 0, and t is anything",
          "up to 1e-3 rad a segment's side is missed and the next bend or cap is met; nothing is NaN", along_the_axis),
      {"ray that creeps in along the axis", "at a flat angle rounding decides where the ray enters, if at all",
       "one below 1e-3 rad may go in unseen: no deeper than 1e-3 of its way along the straight ply",
       "radii of depth per radius of way", tolerance::kCreepDepth, 0, creeping_in},
      ray_trap("ray through the axis", "the offset h is 0 and its sign and normal come from rounding",
               "hits of the axis and of its vertices from all directions are on the surface", through_the_axis),
      ray_trap("ray along a mitre plane", "both segments' clips reject the same entry and the ray leaks into the ply",
               "no ray through the joint's ellipse slips through", along_a_mitre_plane),
      ray_trap("grazing ray, distance r(1 +- 1e-7)", "the discriminant cancels; a root of a negative number is NaN",
               "rounding decides within 1e-6 radii of the silhouette only, and a hit is on the surface", grazing),
      ray_trap("start on the surface", "the ray meets the place that it leaves",
               "outward rays, flat ones too, never meet it again and miss no neighbour", start_on_the_surface),
      ray_trap("start inside a ply", "the far wall is taken for an entry, or the next ply is hidden by it",
               "the ply round the origin is ignored and the next one met",
               [] { return start_inside(eight_plies(), 12); }),
      ray_trap("start inside an overlapping neighbour", "a ray that leaves one ply is stopped inside another at once",
               "every ply that holds the origin is ignored and every other met",
               [] { return start_inside(overlapping_plies(), 13); }),
      afar("origin 10 radii away", 10),
      afar("origin 1e3 radii away", 1e3),
      afar("origin 1e5 radii away", 1e5),
      afar("origin 1e6 radii away", 1e6),
      ray_trap("direction with zero components", "a slab's plane over zero is infinite, and times zero NaN",
               "zeros of either sign and denormals are the same direction", zero_components),
  };
}

}  // namespace wale::test
