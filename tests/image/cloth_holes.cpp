#include "tests/image/cloth_holes.h"

#include <algorithm>
#include <cmath>

#include "tests/image/picture.h"

namespace wale::test {
namespace {

struct Entry {
  double t = 1e30;
  uint32_t triangle = 0;
  double u = 0, v = 0;
};

Entry enter(const BaseMesh& mesh, dvec3 o, dvec3 d) {
  Entry best;
  for (uint32_t i = 0; i < mesh.triangle.size(); ++i) {
    const auto& corner = mesh.triangle[i];
    const dvec3 a = mesh.position[corner[0]], e1 = mesh.position[corner[1]] - a, e2 = mesh.position[corner[2]] - a;
    const dvec3 p = glm::cross(d, e2), s = o - a, q = glm::cross(s, e1);
    const double det = glm::dot(e1, p), u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, t = glm::dot(e2, q) / det;
    if (det != 0 && u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < best.t) best = {t, i, u, v};
  }
  return best;
}

double distance_to_segment(dvec3 p, dvec3 a, dvec3 b) {
  const dvec3 e = b - a;
  return glm::length(p - a - std::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0, 1.0) * e);
}

double distance_to_mesh(const BaseMesh& mesh, dvec3 p) {
  double best = 1e30;
  for (const auto& corner : mesh.triangle) {
    const dvec3 a = mesh.position[corner[0]], b = mesh.position[corner[1]], c = mesh.position[corner[2]];
    const dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    const bool over = glm::dot(glm::cross(b - a, p - a), n) >= 0 && glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                      glm::dot(glm::cross(a - c, p - c), n) >= 0;
    best = std::min(best, over ? std::abs(glm::dot(p - a, n))
                               : std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c),
                                           distance_to_segment(p, c, a)}));
  }
  return best;
}

}  // namespace

void count_holes(const World& world_in, const BaseMesh& mesh, dvec3 target, dvec3 direction, double height, int pixels,
                 HoleCount& count) {
  World world = world_in;
  const Fabric& fabric = world.fabrics.at(0);
  const dvec3 d = glm::normalize(direction), eye = target - 4 * height * d;
  const dvec3 right = glm::normalize(glm::cross(d, std::abs(d.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(0, 1, 0)));
  const dvec3 up = glm::cross(right, d);
  const auto vec = [](dvec3 v) { return w_float4{float(v.x), float(v.y), float(v.z), 0}; };
  WCamera& camera = world.camera;
  camera.origin = vec(eye - world.origin);
  camera.right = vec(right);
  camera.up = vec(up);
  camera.forward = vec(d);
  camera.kind = 1;
  camera.filter = 0;
  camera.width = camera.height = pixels;
  camera.half_width = camera.half_height = float(height / 2);
  IntegratorScene integrator;
  integrator.max_depth = 1;  // first hits are all that is looked at
  RenderOptions options;
  options.spp = 1;  // features of one sample are a point, of several their mean
  options.aovs = true;
  const SceneDevice on_device(device(), world);
  const Image image = render(device(), world, on_device, integrator, options).image;
  const auto channel = [&](const char* name) {
    return std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin();
  };
  const auto depth = channel("depth.Z"), position = channel("position.X");

  double half_thickness = 0;
  for (const Anchor& a : fabric.anchors) half_thickness = std::max(half_thickness, std::abs(double(a.height)));
  half_thickness += fabric.ply_radius;
  const dvec2 stitch = fabric.report.stitch_metres;
  const double overhang =
      std::sqrt(0.5) * std::min(stitch.x, stitch.y);  // half a stitch past a border, at corners past two
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      const float* p = image.at(x, y);
      const bool hit = p[depth] > 0;
      dvec3 o = eye + height * (((x + 0.5) / pixels - 0.5) * right + (0.5 - (y + 0.5) / pixels) * up);
      double t = 1e30;
      if (hit) {  // the sample's own line, which lies anywhere in the pixel
        const dvec3 at(p[position], p[position + 1], p[position + 2]);
        t = glm::dot(at - eye, d);
        o = at - t * d;
      }
      const Entry entry = enter(mesh, o, d);
      if (entry.t > 1e29) {
        count.stray += hit && distance_to_mesh(mesh, o + t * d) > overhang + half_thickness;
        continue;
      }
      const auto& corner = mesh.triangle[entry.triangle];
      const dvec3 a = mesh.position[corner[0]];
      const dvec3 n = glm::normalize(glm::cross(mesh.position[corner[1]] - a, mesh.position[corner[2]] - a));
      const double cosine = std::abs(glm::dot(n, d));
      if (cosine < 0.5) continue;
      const Chart& chart = fabric.charts[fabric.chart_of_triangle[entry.triangle]];
      const auto& uv = mesh.uv[entry.triangle];
      const dvec2 at = (1 - entry.u - entry.v) * uv[0] + entry.u * uv[1] + entry.v * uv[2];
      const dvec2 from = glm::min(at - chart.uv_min, chart.uv_max - at) /
                         fabric.uv_per_metre[fabric.chart_of_triangle[entry.triangle]] / stitch;
      // Half a pixel of a border, a missed sample's own line may have been beside the cloth.
      if (!hit && std::min(from.x * stitch.x, from.y * stitch.y) < height / pixels) continue;
      const double stitches = std::min(from.x, from.y);
      if (stitches > 1 && stitches < 2) continue;
      const int where = stitches <= 1;
      ++count.rays[where];
      count.passed[where] += !hit || (t - entry.t) * cosine > 1.5 * half_thickness;
    }
}

}  // namespace wale::test
