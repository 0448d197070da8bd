#include "tests/hard/fixtures_meshes.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "geom/base_mesh_generators.h"

namespace wale::test {
namespace {

using std::numbers::pi;

BaseMesh finished(BaseMesh mesh, const char* name) {
  mesh.name = name;
  compute_normals(mesh);
  return mesh;
}

/// Adds a grid of quads over the given columns and rows; UV = (x, y), place = where it lies in space.
void add_sheet(
    BaseMesh& mesh, const std::vector<double>& xs, const std::vector<double>& ys,
    const std::function<dvec3(dvec2)>& place = [](dvec2 p) { return dvec3(p, 0); }) {
  const uint32_t first = uint32_t(mesh.position.size()), nx = uint32_t(xs.size());
  for (const double y : ys)
    for (const double x : xs) mesh.position.push_back(place({x, y}));
  for (uint32_t j = 0; j + 1 < ys.size(); ++j)
    for (uint32_t i = 0; i + 1 < nx; ++i) {
      const uint32_t a = first + j * nx + i;
      const dvec2 p(xs[i], ys[j]), q(xs[i + 1], ys[j + 1]);
      mesh.triangle.push_back({a, a + 1, a + nx + 1});
      mesh.uv.push_back({p, dvec2(q.x, p.y), q});
      mesh.triangle.push_back({a, a + nx + 1, a + nx});
      mesh.uv.push_back({p, q, dvec2(p.x, q.y)});
    }
}

std::vector<double> steps(double from, double to, int n) {
  std::vector<double> at;
  for (int i = 0; i <= n; ++i) at.push_back(from + (to - from) * i / n);
  return at;
}

constexpr double kHalf = kSheet / 2;

BaseMesh sheet(int n = 4) {
  BaseMesh mesh;
  add_sheet(mesh, steps(-kHalf, kHalf, n), steps(-kHalf, kHalf, n));
  return mesh;
}

}  // namespace

BaseMesh needle_sheet() {
  constexpr double kThin = 1e-9;
  BaseMesh mesh;
  add_sheet(mesh, {-kHalf, -0.001, -0.001 + kThin, 0.0012, kHalf},
            {-kHalf, -kHalf + kThin, 0, kThin, 0.0015, kHalf - kThin, kHalf});
  return finished(mesh, "needles");
}

BaseMesh pancake_sheet() {
  const BaseMesh plain = sheet();
  BaseMesh mesh;
  mesh.position = plain.position;
  for (size_t t = 0; t + 1 < plain.triangle.size(); t += 2) {
    // A quad's diagonal a-c: the vertex beside its middle leaves b-c, a-b whole and a pancake a-m-c.
    const auto [a, b, c] = plain.triangle[t];
    const uint32_t d = plain.triangle[t + 1][2], m = uint32_t(mesh.position.size());
    const dvec3 middle = 0.5 * (plain.position[a] + plain.position[c]);
    mesh.position.push_back(middle + 1e-9 * glm::normalize(plain.position[b] - middle));
    for (const auto& corners : {std::array{a, b, m}, std::array{b, c, m}, std::array{a, m, c}, std::array{a, c, d}}) {
      mesh.triangle.push_back(corners);
      mesh.uv.push_back({mesh.position[corners[0]], mesh.position[corners[1]], mesh.position[corners[2]]});
    }
  }
  return finished(mesh, "pancakes");
}

BaseMesh sheet_with_uv_point() {
  BaseMesh mesh = sheet();
  for (const size_t t : {10, 11}) mesh.uv[t] = {dvec2(0), dvec2(0), dvec2(0)};
  return finished(mesh, "uv point");
}

BaseMesh sheet_with_flipped_uv() {
  BaseMesh mesh = sheet();
  const uint32_t dragged = 2 * 5 + 2;  // the middle vertex
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangle[t][k] == dragged) mesh.uv[t][k] += 1.4 * dvec2(kSheet / 4, kSheet / 4);
  return finished(mesh, "flipped uv");
}

BaseMesh sheet_wound_both_ways() {
  BaseMesh mesh = sheet();
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    if (t / 2 % 3 == 1) {
      std::swap(mesh.triangle[t][1], mesh.triangle[t][2]);
      std::swap(mesh.uv[t][1], mesh.uv[t][2]);
    }
  return finished(mesh, "wound both ways");
}

BaseMesh sheet_with_far_uv() {
  BaseMesh mesh = sheet();
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv += dvec2(12345.6789, -9876.54321);
  return finished(mesh, "far uv");
}

BaseMesh tube_with_seam_in_a_stitch() { return make_tube(0.003, 0.012, 24, 6); }

BaseMesh two_charts_in_one_place() {
  BaseMesh mesh;
  for (const double side : {-1.0, 1.0})
    add_sheet(mesh, steps(0, kHalf, 2), steps(-kHalf, kHalf, 4),
              [&](dvec2 p) { return dvec3(p.x + (side < 0 ? -kHalf : 0), p.y, 0); });
  return finished(mesh, "charts in one place");
}

BaseMesh chart_over_itself() {
  BaseMesh mesh = sheet();
  for (auto& t : mesh.uv)
    for (dvec2& uv : t) uv.x = std::abs(uv.x);
  return finished(mesh, "chart over itself");
}

BaseMesh ball_with_poles() {
  constexpr double kRadius = 0.004;
  constexpr int kAround = 24, kDown = 12;
  BaseMesh mesh;
  for (int j = 0; j <= kDown; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double phi = 2 * pi * i / kAround, theta = pi * j / kDown;
      mesh.position.push_back(
          kRadius * dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)));
    }
  const auto vertex = [](int i, int j) {
    return uint32_t(j == 0 || j == kDown ? j * kAround : j * kAround + i % kAround);
  };
  const auto uv = [&](double i, int j) { return kRadius * dvec2(2 * pi * i / kAround, pi * j / kDown); };
  for (int j = 0; j < kDown; ++j)
    for (int i = 0; i < kAround; ++i) {
      // At a pole a quad is one triangle, its tip halfway between the meridians.
      if (j > 0) {
        mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
        mesh.uv.push_back({uv(i, j), uv(i + 1, j), j + 1 == kDown ? uv(i + 0.5, j + 1) : uv(i + 1, j + 1)});
      }
      if (j + 1 < kDown) {
        mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        mesh.uv.push_back({j == 0 ? uv(i + 0.5, 0) : uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
      }
    }
  return finished(mesh, "ball");
}

BaseMesh moebius_strip() {
  constexpr double kRadius = 0.008, kWidth = 0.005;
  constexpr int kAround = 60, kAcross = 4;
  BaseMesh mesh;
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j <= kAcross; ++j) {
      const double a = 2 * pi * i / kAround, s = kWidth * (double(j) / kAcross - 0.5);
      const dvec3 out(std::cos(a), std::sin(a), 0);
      mesh.position.push_back((kRadius + s * std::cos(a / 2)) * out + dvec3(0, 0, s * std::sin(a / 2)));
    }
  const auto vertex = [](int i, int j) {
    return uint32_t(i < kAround ? i * (kAcross + 1) + j : kAcross - j);  // round once, its sides are swapped
  };
  const auto uv = [](int i, int j) { return dvec2(2 * pi * kRadius * i / kAround, kWidth * j / kAcross); };
  for (int i = 0; i < kAround; ++i)
    for (int j = 0; j < kAcross; ++j) {
      mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.uv.push_back({uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)});
      mesh.triangle.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      mesh.uv.push_back({uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
    }
  return finished(mesh, "moebius");
}

BaseMesh double_sheet() {
  BaseMesh mesh = sheet();
  const BaseMesh one = mesh;
  for (size_t t = 0; t < one.triangle.size(); ++t) {
    auto corners = one.triangle[t];
    for (uint32_t& v : corners) v += uint32_t(one.position.size());
    mesh.triangle.push_back({corners[0], corners[2], corners[1]});
    // Seen from behind, u runs the other way; beside the first chart.
    const auto mirrored = [](dvec2 uv) { return dvec2(2 * kSheet - uv.x, uv.y); };
    mesh.uv.push_back({mirrored(one.uv[t][0]), mirrored(one.uv[t][2]), mirrored(one.uv[t][1])});
  }
  mesh.position.insert(mesh.position.end(), one.position.begin(), one.position.end());
  return finished(mesh, "double sheet");
}

BaseMesh three_sheets_on_an_edge() {
  BaseMesh mesh;
  for (int k = 0; k < 3; ++k) {
    const double a = 2 * pi * k / 3;
    add_sheet(mesh, steps(0, kHalf, 3), steps(-kHalf, kHalf, 4),
              [&](dvec2 p) { return k == 0 ? dvec3(p, 0) : dvec3(p.x * std::cos(a), p.y, p.x * std::sin(a)); });
  }
  // The first column of every sheet is that of the first one.
  const uint32_t per = uint32_t(mesh.position.size() / 3);
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      uint32_t& v = mesh.triangle[t][k];
      const uint32_t part = v / per;
      mesh.uv[t][k].x += 2 * kSheet * part;
      if (v % per % 4 == 0) v %= per;
    }
  return finished(mesh, "three sheets");
}

BaseMesh sheet_of_loose_triangles() {
  const BaseMesh plain = sheet();
  BaseMesh mesh;
  mesh.uv = plain.uv;
  for (const auto& t : plain.triangle) {
    const uint32_t first = uint32_t(mesh.position.size());
    for (const uint32_t v : t) mesh.position.push_back(plain.position[v]);
    mesh.triangle.push_back({first, first + 1, first + 2});
  }
  return finished(mesh, "loose triangles");
}

BaseMesh sheet_with_stray_vertex() {
  BaseMesh mesh = sheet();
  mesh.position.emplace_back(1e9, -1e9, 1e9);
  return finished(mesh, "stray vertex");
}

BaseMesh one_triangle(double leg) {
  BaseMesh mesh;
  mesh.position = {dvec3(-leg / 2, -leg / 2, 0), dvec3(leg / 2, -leg / 2, 0), dvec3(-leg / 2, leg / 2, 0)};
  mesh.triangle = {{0, 1, 2}};
  mesh.uv = {{mesh.position[0], mesh.position[1], mesh.position[2]}};
  return finished(mesh, "one triangle");
}

BaseMesh sheet_with_spatial_point() {
  BaseMesh mesh = sheet();
  for (const uint32_t v : {8u, 13u, 7u}) mesh.position[v] = mesh.position[12];  // a quad in the middle is a point
  return finished(mesh, "spatial point");
}

BaseMesh line_of_triangles() {
  BaseMesh mesh = sheet();
  for (dvec3& p : mesh.position) p = dvec3(p.x, p.x, p.x);
  return finished(mesh, "line");
}

}  // namespace wale::test
