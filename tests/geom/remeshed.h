#pragma once
#include <functional>
#include <random>

#include "geom/base_mesh.h"

namespace wale::test {

/// A rectangle of cloth triangulated anew from a seed: other numbers of rows and columns, inner vertices shifted, each
/// quadrilateral split by either diagonal. UV are metres on the cloth, positions what `shape` makes of them.
inline BaseMesh remeshed_cloth(dvec2 size, uint32_t seed, const std::function<dvec3(dvec2)>& shape) {
  std::mt19937 random(seed);
  const auto share = [&] { return double(random()) / double(random.max()); };
  const int nu = 5 + int(random() % 7), nv = 5 + int(random() % 7);
  BaseMesh mesh;
  std::vector<dvec2> uv;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      dvec2 at(double(i) / nu, double(j) / nv);
      // Within the border; and on it along it.
      if (i > 0 && i < nu) at.x += 0.6 * (share() - 0.5) / nu;
      if (j > 0 && j < nv) at.y += 0.6 * (share() - 0.5) / nv;
      uv.push_back(at * size);
      mesh.position.push_back(shape(uv.back()));
    }
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    mesh.triangle.push_back({a, b, c});
    mesh.uv.push_back({uv[a], uv[b], uv[c]});
  };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const uint32_t a = uint32_t(j * (nu + 1) + i), b = a + 1, c = a + uint32_t(nu) + 1, d = c + 1;
      if (random() % 2) {
        triangle(a, b, d), triangle(a, d, c);
      } else {
        triangle(a, b, c), triangle(b, d, c);
      }
    }
  compute_normals(mesh);
  return mesh;
}

}  // namespace wale::test
