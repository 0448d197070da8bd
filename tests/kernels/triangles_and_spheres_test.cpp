// Triangles and spheres against double formulas, at every width.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/program.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {
namespace {

constexpr const char* kSurfaces = R"(
#include "geometry/traverse.clh"
typedef struct TestRay { float o[3], l[3], d[3]; float tmax; uint key, skip, skip_triangle, pad; } TestRay;
__kernel void trace(__global const uint* nodes, __global const float* leaves, __global const WSphere* spheres,
                    uint spheres_count, __global uint* counters, __global const TestRay* rays, __global uint4* out,
                    uint count) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  WScene s;
  s.ply_root = W_NONE;
  s.tri_root = 0;
  s.tri_nodes = nodes;
  s.tri_leaves = leaves;
  s.spheres = spheres;
  s.spheres_count = spheres_count;
  s.counters = counters;
  WRay r;
  r.o = vload3(0, rays[i].o);
  r.l = vload3(0, rays[i].l);
  r.d = vload3(0, rays[i].d);
  r.tmax = rays[i].tmax;
  r.key = 0;
  r.skip = W_NONE;
  r.skip_triangle = rays[i].skip_triangle;
  const WHit hit = w_closest(&s, &r);
  out[i] = (uint4)(as_uint(hit.t), hit.kind, hit.code, (uint)w_occluded(&s, &r));
}
)";

struct Found {
  float t;
  uint32_t kind, code, occluded;
};

struct Soup {
  std::vector<dvec3> corners;  // three a triangle
  std::vector<WSphere> spheres;

  std::vector<Found> trace(const std::vector<Ray>& rays, const std::string& options) const {
    const Device& device = test_device();
    const uint32_t triangles = uint32_t(corners.size() / 3);
    std::vector<float> leaves;
    std::vector<Box> boxes;
    std::vector<uint32_t> codes;
    for (uint32_t first = 0; first < triangles; first += 7) {  // leaves that are not full
      const uint32_t count = std::min(7u, triangles - first);
      codes.push_back(uint32_t(leaves.size() / 4));
      leaves.resize(leaves.size() + W_TRI_LEAF_WORDS, 0.0f);
      float* leaf = &leaves[leaves.size() - W_TRI_LEAF_WORDS];
      leaf[0] = std::bit_cast<float>(first);
      leaf[1] = std::bit_cast<float>(count);
      Box box;
      for (uint32_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
          const dvec3* c = &corners[3 * (first + i)];
          leaf[4 + 16 * k + i] = float(c[0][k]);
          leaf[52 + 16 * k + i] = float(c[1][k]) - float(c[0][k]);
          leaf[100 + 16 * k + i] = float(c[2][k]) - float(c[0][k]);
          for (int corner = 0; corner < 3; ++corner) {
            box.lo[k] = std::min(box.lo[k], float(c[corner][k]));
            box.hi[k] = std::max(box.hi[k], float(c[corner][k]));
          }
        }
      boxes.push_back(box);
    }
    const WideTree tree = build_wide_tree(boxes, codes, {}, {});
    const Buffer<uint32_t> nodes(device, tree.words);
    const Buffer<float> leaf_buffer(device, leaves);
    const Buffer<WSphere> sphere_buffer(device, spheres);
    Buffer<uint32_t> counters(device, W_EVENT_COUNT);
    counters.fill(device, 0);
    const Buffer<Ray> in(device, rays);
    const Buffer<Found> out(device, rays.size());
    cl::Kernel kernel(build_program_text(device, kSurfaces, "-DW_HAS_TRIANGLES -DW_HAS_SPHERES " + options), "trace");
    kernel.setArg(0, nodes.cl());
    kernel.setArg(1, leaf_buffer.cl());
    kernel.setArg(2, sphere_buffer.cl());
    kernel.setArg(3, uint32_t(spheres.size()));
    kernel.setArg(4, counters.cl());
    kernel.setArg(5, in.cl());
    kernel.setArg(6, out.cl());
    kernel.setArg(7, uint32_t(rays.size()));
    device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.global(rays.size()), device.local());
    return out.read(device);
  }

  double nearest(const Ray& ray) const {
    double best = 1e30;
    const dvec3 o(ray.o[0], ray.o[1], ray.o[2]), d(ray.d[0], ray.d[1], ray.d[2]);
    for (size_t i = 0; i < corners.size(); i += 3) {
      const dvec3 e1 = corners[i + 1] - corners[i], e2 = corners[i + 2] - corners[i], s = o - corners[i];
      const dvec3 p = glm::cross(d, e2), q = glm::cross(s, e1);
      const double det = glm::dot(e1, p), u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
      const double t = glm::dot(e2, q) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && t > 0) best = std::min(best, t);
    }
    for (const WSphere& sphere : spheres) {
      const dvec3 w = o - dvec3(sphere.center.x, sphere.center.y, sphere.center.z);
      const double b = glm::dot(w, d), disc = b * b - glm::dot(w, w) + double(sphere.center.w) * sphere.center.w;
      if (disc < 0) continue;
      for (double t : {-b - std::sqrt(disc), -b + std::sqrt(disc)})
        if (t > 0) best = std::min(best, t);
    }
    return best;
  }
};

TEST(TrianglesAndSpheres, AgreeWithDoubleFormulas) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Soup soup;
  for (int i = 0; i < 300; ++i) {
    const dvec3 c = 5.0 * dvec3(uniform(random), uniform(random), uniform(random));
    for (int k = 0; k < 3; ++k) soup.corners.push_back(c + dvec3(uniform(random), uniform(random), uniform(random)));
  }
  soup.spheres = {{{0, 0, 0, 1.5f}, 0, -1, 0, 0}, {{3, 3, -2, 0.7f}, 0, -1, 0, 0}};
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i)  // many start inside a sphere
    rays.push_back(make_ray(6.0 * dvec3(uniform(random), uniform(random), uniform(random)),
                            {uniform(random), uniform(random), uniform(random)}, 0));
  const std::vector<Found> found = soup.trace(rays, "-DW_LANES=16");
  size_t differ = 0, spheres = 0, triangles = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const double expected = soup.nearest(rays[i]);
    differ += (expected < 1e29) != (found[i].kind != W_HIT_NONE) ||
              (expected < 1e29 && std::abs(found[i].t - expected) > 2e-4);
    spheres += found[i].kind == W_HIT_SPHERE;
    triangles += found[i].kind == W_HIT_TRIANGLE;
    EXPECT_EQ(found[i].occluded != 0, found[i].kind != W_HIT_NONE);
  }
  EXPECT_LE(differ, 3u);
  EXPECT_GT(spheres, 400u);
  EXPECT_GT(triangles, 1000u);
  for (const char* options : {"-DW_LANES=1", "-DW_LANES=8"}) {
    const std::vector<Found> other = soup.trace(rays, options);
    size_t unequal = 0;
    for (size_t i = 0; i < rays.size(); ++i) unequal += other[i].t != found[i].t || other[i].code != found[i].code;
    EXPECT_EQ(unequal, 0u) << options;
  }
}

// Rays at the shared edges and corners of a fan never slip through; the triangle that a ray starts on is left out.
TEST(TrianglesAndSpheres, SharedEdgesAreClosed) {
  Soup soup;
  for (int i = 0; i < 12; ++i) {
    const auto rim = [](int k) { return dvec3(std::cos(k * 0.5236), std::sin(k * 0.5236), 0.1 * (k % 2)); };
    soup.corners.insert(soup.corners.end(), {dvec3(0, 0, 0), rim(i), rim(i + 1)});
  }
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const dvec3 on = 0.98 * uniform(random) * soup.corners[3 * (random() % 12) + 1];
    const dvec3 from = dvec3(uniform(random) - 0.5, uniform(random) - 0.5, 5);
    rays.push_back(make_ray(from, on - from, 0));
  }
  size_t missed = 0;
  for (const Found& hit : soup.trace(rays, "-DW_LANES=16")) missed += hit.kind != W_HIT_TRIANGLE;
  EXPECT_EQ(missed, 0u);
  Ray down = make_ray({0.5, 0.1, 5}, {0, 0, -1}, 0);
  const uint32_t first = soup.trace({down}, "-DW_LANES=16")[0].code;
  down.skip_triangle = first;
  EXPECT_EQ(soup.trace({down}, "-DW_LANES=16")[0].kind, uint32_t(W_HIT_NONE));
}

}  // namespace
}  // namespace wale::test
