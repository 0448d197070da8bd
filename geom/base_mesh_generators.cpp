#include "geom/base_mesh_generators.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "geom/error.h"

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;

void check_sizes(const char* what, std::initializer_list<double> lengths, std::initializer_list<int> counts,
                 int least) {
  for (const double x : lengths)
    if (!(x > 0) || !std::isfinite(x)) user_error("{}: length {} is not usable; give metres above 0", what, x);
  for (const int n : counts)
    if (n < least || n > 8192) user_error("{}: resolution {} is not usable; give {} to 8192", what, n, least);
}

/// Adds nu x nv quads, each two triangles; vertex and uv are asked by column and row.
void add_grid(BaseMesh& mesh, int nu, int nv, const std::function<uint32_t(int, int)>& vertex,
              const std::function<dvec2(int, int)>& uv) {
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.uv.push_back({uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)});
      mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      mesh.uv.push_back({uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
    }
}

BaseMesh finished(BaseMesh mesh, const char* name) {
  mesh.name = name;
  compute_normals(mesh);
  return mesh;
}

/// A rectangle of (nu+1) x (nv+1) vertices, mapped by `place` from s, t in [0,1].
BaseMesh make_sheet(int nu, int nv, dvec2 uv_size, const std::function<dvec3(double, double)>& place) {
  BaseMesh mesh;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.position.push_back(place(double(i) / nu, double(j) / nv));
  add_grid(
      mesh, nu, nv, [&](int i, int j) { return static_cast<uint32_t>(j * (nu + 1) + i); },
      [&](int i, int j) { return dvec2(double(i) / nu, double(j) / nv) * uv_size; });
  return mesh;
}

/// A plane curve given for s in [0,1], by its arc length; from a fine polyline.
class ArcLength {
 public:
  explicit ArcLength(const std::function<dvec2(double)>& curve) {
    constexpr int kFine = 4096;
    for (int i = 0; i <= kFine; ++i) {
      points_.push_back(curve(double(i) / kFine));
      arc_.push_back(i ? arc_.back() + glm::length(points_.back() - points_[points_.size() - 2]) : 0.0);
    }
  }
  double total() const { return arc_.back(); }
  dvec2 at(double length) const {
    const auto after = std::upper_bound(arc_.begin(), arc_.end(), length) - arc_.begin();
    const size_t k = std::min(arc_.size() - 2, size_t(after) - 1);
    return points_[k] + (length - arc_[k]) / (arc_[k + 1] - arc_[k]) * (points_[k + 1] - points_[k]);
  }

 private:
  std::vector<dvec2> points_;
  std::vector<double> arc_;
};

/// A tube of `total` arc length, joined at its seam (u = angle * radius, v along it), whose last part is a cap with a
/// chart of its own, azimuthal equidistant about the apex. place(angle, arc length) for all but the apex.
BaseMesh make_capped_tube(int nu, int nv, double radius, double total,
                          const std::function<dvec3(double, double)>& place, dvec3 apex_at) {
  const double crown = 0.42 * radius;  // arc length of the cap, apex to rim
  BaseMesh mesh;
  const int cap_rows = std::max(2, nv / 4), wall_rows = std::max(2, nv - cap_rows);
  const auto add_ring = [&](double length) {
    for (int i = 0; i < nu; ++i) mesh.position.push_back(place(2 * kPi * i / nu, length));
  };
  for (int j = 0; j <= wall_rows; ++j) add_ring((total - crown) * j / wall_rows);
  for (int j = 1; j < cap_rows; ++j) add_ring(total - crown + crown * j / cap_rows);
  const uint32_t apex = static_cast<uint32_t>(mesh.position.size());
  mesh.position.push_back(apex_at);

  const auto vertex = [&](int i, int j) { return static_cast<uint32_t>(j * nu + i % nu); };
  add_grid(mesh, nu, wall_rows, vertex,
           [&](int i, int j) { return dvec2(2 * kPi * radius * i / nu, (total - crown) * j / wall_rows); });
  const dvec2 centre(kPi * radius, total + crown);  // above the wall's chart
  const auto cap_uv = [&](int i, int j) {
    const double angle = 2 * kPi * i / nu, r = crown * (1 - double(j) / cap_rows);
    return centre + r * dvec2(std::cos(angle), std::sin(angle));
  };
  add_grid(
      mesh, nu, cap_rows - 1, [&](int i, int j) { return vertex(i, wall_rows + j); }, cap_uv);
  for (int i = 0; i < nu; ++i) {
    const int j = cap_rows - 1;
    mesh.triangle.push_back({vertex(i, wall_rows + j), vertex(i + 1, wall_rows + j), apex});
    mesh.uv.push_back({cap_uv(i, j), cap_uv(i + 1, j), centre});
  }
  return mesh;
}

/// Point of the beanie's outline (distance from the axis, height), s in [0,1] from the brim's edge to the apex: a wall
/// with a thick folded brim, then a quarter ellipse.
dvec2 beanie_outline(double radius, double height, double s) {
  const double dome = std::min(radius, 0.7 * height), wall = height - dome;
  const double share = wall / (wall + 0.5 * kPi * dome);
  dvec2 p;
  if (s < share) {
    p = {radius, wall * s / share};
  } else {
    const double angle = 0.5 * kPi * (s - share) / (1 - share);
    p = {radius * std::cos(angle), wall + dome * std::sin(angle)};
  }
  const double brim = 0.5 - 0.5 * std::tanh((p.y - 0.22 * height) / (0.02 * height));
  const double lip = std::exp(-std::pow(p.y / (0.03 * height), 2.0));
  p.x += radius * (0.06 * brim - 0.02 * lip);
  if (s == 1) p.x = 0;
  return p;
}

}  // namespace

BaseMesh make_swatch(double width, double height, int nu, int nv) {
  check_sizes("swatch", {width, height}, {nu, nv}, 1);
  return finished(make_sheet(nu, nv, {width, height},
                             [&](double s, double t) { return dvec3((s - 0.5) * width, (t - 0.5) * height, 0); }),
                  "swatch");
}

BaseMesh make_tube(double radius, double height, int nu, int nv) {
  check_sizes("tube", {radius, height}, {nu, nv}, 1);
  check_sizes("tube", {}, {nu}, 3);
  BaseMesh mesh;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const double angle = 2 * kPi * i / nu;
      mesh.position.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height * j / nv);
    }
  add_grid(
      mesh, nu, nv, [&](int i, int j) { return static_cast<uint32_t>(j * nu + i % nu); },
      [&](int i, int j) { return dvec2(2 * kPi * radius * i / nu, height * j / nv); });
  return finished(std::move(mesh), "tube");
}

// With s, t in [-1,1] the flat coordinates of a sheet: z = T (1-s^4)(1-t^4), and x = W (s - a s^9/9 (1-t^4)) / (1 -
// a/9), whose slope 1 - a s^8 drops just where z falls to the border. So the sheet turns almost upright where it meets
// the other one, is close to metric elsewhere, and keeps the pointed corners of a sewn pillow.
BaseMesh make_pillow(double width, double height, double thickness, int nu, int nv) {
  check_sizes("pillow", {width, height, thickness}, {nu, nv}, 2);
  constexpr double kTuck = 0.85;
  const auto tucked = [](double s, double t) {
    return (s - kTuck * std::pow(s, 9) / 9 * (1 - std::pow(t, 4))) / (1 - kTuck / 9);
  };
  const auto place = [&](double u, double v) {
    const double s = 2 * u - 1, t = 2 * v - 1;
    return dvec3(0.5 * width * tucked(s, t), 0.5 * height * tucked(t, s),
                 0.5 * thickness * (1 - std::pow(s, 4)) * (1 - std::pow(t, 4)));
  };
  BaseMesh mesh = make_sheet(nu, nv, {width, height}, place);

  // Back: the same points mirrored in z; border vertices are shared. u runs the other way, so that UV and outward
  // normal agree in sense, and lies beside the front.
  const uint32_t front = static_cast<uint32_t>(mesh.position.size());
  std::vector<uint32_t> back(front);
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const uint32_t k = static_cast<uint32_t>(j * (nu + 1) + i);
      const bool border = i == 0 || j == 0 || i == nu || j == nv;
      back[k] = border ? k : static_cast<uint32_t>(mesh.position.size());
      if (!border) mesh.position.push_back(mesh.position[k] * dvec3(1, 1, -1));
      if (border) mesh.position[k].z = 0;
    }
  add_grid(
      mesh, nu, nv, [&](int i, int j) { return back[static_cast<size_t>(j * (nu + 1) + nu - i)]; },
      [&](int i, int j) { return dvec2(1.25 * width + width * i / nu, height * j / nv); });
  return finished(std::move(mesh), "pillow");
}

BaseMesh make_beanie(double radius, double height, int nu, int nv) {
  check_sizes("beanie", {radius, height}, {nu}, 8);
  check_sizes("beanie", {}, {nv}, 4);
  const ArcLength outline([&](double s) { return beanie_outline(radius, height, s); });
  return finished(make_capped_tube(
                      nu, nv, radius, outline.total(),
                      [&](double angle, double length) {
                        const dvec2 p = outline.at(length);
                        return dvec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
                      },
                      dvec3(0, 0, height)),
                  "beanie");
}

// A tube swept along leg, bend and foot. (t, n, b) is right-handed with t along the spine and n towards heel and sole.
BaseMesh make_sock(double radius, double height, double length, int nu, int nv) {
  check_sizes("sock", {radius, height, length}, {nu}, 8);
  check_sizes("sock", {}, {nv}, 8);
  const double bend = 1.3 * radius, toe = 1.5 * radius, turn = 0.5 * kPi * bend;
  if (height < bend + radius || length < bend + toe)
    user_error("sock: a leg of {:g} m and a foot of {:g} m are too short for radius {:g} m; at least {:.3g} and {:.3g}",
               height, length, radius, bend + radius, bend + toe);
  const double leg = height - bend, spine = leg + turn + length - bend;
  // Distance along the spine, and share of the radius there.
  const auto profile = [&](double s) {
    const double along = s * spine, t = std::max(0.0, (along - (spine - toe)) / toe);
    return dvec2(along, radius * std::sqrt(std::max(0.0, 1 - t * t)));
  };
  const ArcLength outline(profile);
  const auto place = [&](double angle, double arc) {
    const dvec2 p = outline.at(arc);
    const double theta = std::clamp((p.x - leg) / bend, 0.0, 0.5 * kPi);
    const dvec3 t(std::sin(theta), 0, -std::cos(theta)), n(-std::cos(theta), 0, -std::sin(theta)), b(0, 1, 0);
    const dvec3 at = p.x < leg          ? dvec3(0, 0, height - p.x)
                     : p.x < leg + turn ? dvec3(bend, 0, bend) + bend * n
                                        : dvec3(bend + p.x - leg - turn, 0, 0);
    const double heel = 0.22 * std::pow(std::sin(2 * theta), 2.0) * std::max(0.0, std::cos(angle));
    const double foot = glm::smoothstep(0.0, 1.0, theta / (0.5 * kPi));  // a foot is wider than high
    return at + p.y * ((1 + heel - 0.12 * foot) * std::cos(angle) * n + (1 + 0.1 * foot) * std::sin(angle) * b);
  };
  return finished(make_capped_tube(nu, nv, radius, outline.total(), place, dvec3(length, 0, 0)), "sock");
}

// In polar coordinates of the flat cloth (rho, theta): the profile follows a sphere a little larger than the obstacle
// for a quarter turn and then falls straight. A ring of flat length 2 pi rho must fit on radius r(rho) < rho; a wave A
// cos(n theta) on a ring lengthens it by about (A n / r)^2 / 4, so A = 2 r/n sqrt(rho/r - 1) would take up the excess;
// 0.7 of it is used, faded in over the shoulder. The wave only ever points outwards, hence the gap is kept.
BaseMesh make_draped_square(double size, double sphere_radius, int n) {
  check_sizes("draped square", {size, sphere_radius}, {n}, 2);
  constexpr int kFolds = 8;
  const double radius = 1.03 * sphere_radius, quarter = 0.5 * kPi * radius;
  const auto place = [&](double s, double t) {
    const dvec2 flat = (dvec2(s, t) - 0.5) * size;
    const double rho = glm::length(flat);
    if (rho == 0) return dvec3(0, 0, radius);
    const double angle = std::min(rho / radius, 0.5 * kPi), drop = std::max(rho - quarter, 0.0);
    const double ring = radius * std::sin(angle);
    const double fade = glm::smoothstep(0.5, 1.4, rho / radius);
    const double wave = 0.7 * fade * 2 * ring / kFolds * std::sqrt(std::max(rho / ring - 1, 0.0));
    const double lift = wave * (1 + std::cos(kFolds * std::atan2(flat.y, flat.x)));
    const dvec2 out = flat / rho;
    const dvec3 profile(ring * out, radius * std::cos(angle) - drop);
    const dvec3 normal(std::sin(angle) * out, std::cos(angle));
    return profile + lift * normal;
  };
  return finished(make_sheet(n, n, {size, size}, place), "draped square");
}

}  // namespace wale
