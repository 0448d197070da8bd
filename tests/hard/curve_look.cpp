#include "tests/hard/curve_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/image/picture.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

// 64 bits of mantissa: the oracle's own rounding stays below 1e-12 radii even 1e7 radii away.
using real = long double;
struct Vec {
  real x, y, z;
  Vec(real a, real b, real c) : x(a), y(b), z(c) {}
  template <typename Real>
  explicit Vec(const Real* p) : x(p[0]), y(p[1]), z(p[2]) {}
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
real length(Vec a) { return std::sqrt(dot(a, a)); }
/// Distance of x from the line through 0 along d.
real off_line(Vec x, Vec d) { return length(x - (dot(x, d) / dot(d, d)) * d); }

// W_PIECE_* of kernels/geometry/ply_segment.clh.
constexpr int kSide = 0, kStart = 1;

// Furnace pictures of the table: one pixel of all of them may fail by chance, once in a hundred tables.
constexpr size_t kFurnaces = 10;

// Closer than this to a silhouette or to the edge of a piece, the rounding of the inputs may decide.
constexpr double kClearH = 0.99, kClearEdge = 1e-4, kClearStart = 1e-4;  // radii

/// Position of the hit relative to the start of its segment, against the piece's true surface and the ray.
template <typename Real>
real place_error(const Strands& strands, const Ray& ray, const HitOf<Real>& hit, const SurfaceOf<Real>& s) {
  const float* vertex = strands.positions.data() + size_t(s.segment) * 3;
  const real radius = strands.patches[0].radius;
  const Vec start(vertex), end(vertex + 3), x(s.x), e = end - start, d(ray.d);
  const Vec from = Vec(ray.o) + Vec(ray.l) - start;
  const real surface = int(hit.v) == kSide ? off_line(x, e) : length(int(hit.v) == kStart ? x : x - e);
  return std::max(std::abs(surface - radius), off_line(x - from, d)) / radius;
}

std::string described(const Ray& r) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g}) + ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})", r.o[0],
                     r.o[1], r.o[2], r.l[0], r.l[1], r.l[2], r.d[0], r.d[1], r.d[2]);
}

/// Compares one build's answers; `error` grows, `broken` takes the first wrong one.
template <typename Real>
void compare(const RayCase& c, const std::vector<HitOf<Real>>& hits, const std::vector<SurfaceOf<Real>>& surfaces,
             const std::vector<OracleHit>& expected, double& error, std::string& broken) {
  const double radius = c.strands.patches[0].radius;
  for (size_t i = 0; i < c.rays.size(); ++i) {
    const OracleHit& e = expected[i];
    const HitOf<Real>& h = hits[i];
    const bool hit = h.kind == W_HIT_PLY;
    const auto wrong = [&](const char* what) {
      if (broken.empty())
        broken = fmt::format(
            "{}, {}: ray {} from {}: device {} t {:.9g} h {:.6f} piece {}, oracle {} t {:.9g} h {:.6f} "
            "piece {} segment {} edge {:.3g}",
            sizeof(Real) == 8 ? "double" : "float", what, i, described(c.rays[i]), hit ? "hit" : "miss", h.t, h.u, h.v,
            e.hit ? "hit" : "miss", e.t, e.h, e.piece, e.segment, e.edge);
    };
    if (hit != (h.occluded != 0)) wrong("any hit and nearest hit differ");
    // Where a ray starts on a surface, rounding decides on which side of it.
    const bool starts_there = (hit && h.t < kClearStart * radius) || (e.hit && e.t < kClearStart * radius);
    const bool clear = !starts_there && (!e.hit || (std::abs(e.h) < kClearH && e.edge > kClearEdge)) &&
                       (!hit || std::abs(h.u) < kClearH);
    if (hit != e.hit) {
      if (clear) wrong(hit ? "hit where nothing is" : "missed");
      continue;
    }
    if (!hit) continue;
    const SurfaceOf<Real>& s = surfaces[i];
    for (const Real v : {s.x[0], s.x[1], s.x[2], s.n[0], s.n[1], s.n[2], s.t[0], s.t[1], s.t[2], s.smooth_n[0],
                         s.smooth_n[1], s.smooth_n[2], s.phi, s.u, s.length, s.h, h.t, h.u})
      if (!std::isfinite(v)) wrong("a value that is not finite");
    // A grazing ray's rounded line may pass the surface: its distance to the hit then says nothing.
    if (std::abs(h.u) < 1 - 1e-5) error = std::max(error, double(place_error(c.strands, c.rays[i], h, s)));
    const double rounding = std::ldexp(std::abs(e.t), sizeof(Real) == 8 ? -52 : -23) / radius;
    const double dt = double(std::abs(h.t - e.exact_t)) / radius;
    if (clear && dt > 1e-2 + 64 * rounding) wrong("another hit");
    // Steep: where the surface's error does not grow along the ray by more than a factor of 8.
    const float* vertex = c.strands.positions.data() + size_t(s.segment) * 3;
    const Vec edge = Vec(vertex + 3) - Vec(vertex);
    const bool steep = int(h.v) != kSide || off_line(edge, Vec(c.rays[i].d)) > 0.3L * length(edge);
    if (clear && steep && s.segment == e.segment && int(h.v) == e.piece && std::abs(e.h) < 0.9)
      error = std::max(error, dt - 2 * rounding);
  }
}

}  // namespace

Finding worse(const Finding& a, const Finding& b) {
  Finding out;
  const auto larger = [](double x, double y) { return std::isnan(x) ? y : std::isnan(y) ? x : std::max(x, y); };
  out.error_float = larger(a.error_float, b.error_float);
  out.error_double = larger(a.error_double, b.error_double);
  out.trials = a.trials + b.trials;
  out.rare = a.rare + b.rare;
  out.broken = a.broken.empty() ? b.broken : a.broken;
  return out;
}

Finding look_at_rays(const std::vector<RayCase>& cases) {
  Finding f;
  f.error_float = 0;
  const bool fp64 = test_device().traits().fp64;
  if (fp64) f.error_double = 0;
  for (const RayCase& c : cases) {
    Tracer tracer(test_device(), c.strands);
    const BruteForce oracle(c.strands.patches, c.strands.positions);
    std::vector<OracleHit> expected;
    for (const Ray& ray : c.rays)
      expected.push_back(oracle.closest(ray, ray.skip == W_NONE ? -1 : long(tracer.segment(ray.skip))));
    const std::vector<Hit> hits = tracer.trace(c.rays, "-DW_LANES=16");
    compare<float>(c, hits, tracer.surfaces(c.rays, hits), expected, f.error_float, f.broken);
    if (fp64) {
      const std::vector<HitOf<double>> exact = tracer.trace_in_double(c.rays);
      compare<double>(c, exact, tracer.surfaces_in_double(c.rays, exact), expected, f.error_double, f.broken);
    }
    f.trials += c.rays.size();
    f.rare += tracer.stack_overflows();
  }
  return f;
}

Finding look_at_curve(const Strands& strands, uint32_t seed) {
  constexpr size_t kRays = 20000;
  RayCase c{strands, aimed_rays(strands, kRays, 8, seed)};
  Tracer tracer(test_device(), strands);
  const std::vector<Hit> hits = tracer.trace(c.rays, "-DW_LANES=16");
  RayCase bounce{strands, bounce_rays(c.rays, hits, tracer.surfaces(c.rays, hits), seed + 1)};
  Finding f = look_at_rays({c, bounce});
  if (bounce.rays.size() < kRays / 2 && f.broken.empty()) f.broken = "rays aimed at the ply miss it";
  return f;
}

Finding look_at_furnace(const Scene& scene, int spp) {
  const Picture picture = take(scene, spp);
  Finding f;
  f.trials = uint64_t(picture.image.width) * uint64_t(picture.image.height);
  size_t tests = 0;
  const double p = smallest_p(picture.image, 1.0, tests);
  if (p <= sidak(tolerance::kFamilyP, kFurnaces * tests))
    f.broken = fmt::format("a pixel is not 1 within its noise: p {:.2g}", p);
  f.error_float = 0;
  for (const double mean : mean_rgb(picture.image)) f.error_float = std::max(f.error_float, std::abs(mean - 1));
  f.rare = bad_events(picture.counts);
  if (picture.counts.bounce == 0) f.broken = "the camera saw no ply";
  return f;
}

}  // namespace wale::test
