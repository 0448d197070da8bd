#include "scenes/drape/cloth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace wale::drape {
namespace {

constexpr double kGravity = 9.81;
constexpr double kDrag = 1;       // 1 / s: of air
constexpr double kFriction = 60;  // 1 / s: of threads on each other, where neighbours move differently
// Particles of unit mass: knits give more across than along their threads, and hardly resist bending.
constexpr double kStretchCompliance = 1e-8, kShearCompliance = 3e-6, kBendCompliance = 3e-4;

int64_t cell(double x, double size) { return int64_t(std::floor(x / size)); }

uint64_t key(int64_t x, int64_t y, int64_t z) {
  return (uint64_t(x) * 73856093u) ^ (uint64_t(y) * 19349663u) ^ (uint64_t(z) * 83492791u);
}

}  // namespace

Cloth::Cloth(const Setup& setup) : setup_(setup), side_(setup.cells + 1), spacing_(setup.size / setup.cells) {
  const double c = std::cos(setup.turn), s = std::sin(setup.turn);
  const double height = setup.radius + 0.5 * setup.thickness + setup.gap;
  for (int j = 0; j < side_; ++j)
    for (int i = 0; i < side_; ++i) {
      const dvec2 p = dvec2(i, j) * spacing_ - 0.5 * setup.size;
      x_.push_back({c * p.x - s * p.y + setup.off_centre.x, s * p.x + c * p.y + setup.off_centre.y, height});
    }
  v_.resize(x_.size());
  before_ = x_;
  add_threads(1, 0, kStretchCompliance);
  add_threads(0, 1, kStretchCompliance);
  add_threads(1, 1, kShearCompliance);
  add_threads(1, -1, kShearCompliance);
  add_threads(2, 0, kBendCompliance);
  add_threads(0, 2, kBendCompliance);
}

// In two colours: threads of one share no particle, so that a sweep favours no side.
void Cloth::add_threads(int di, int dj, double compliance) {
  const double length = spacing_ * std::sqrt(double(di * di + dj * dj));
  for (int color = 0; color < 2; ++color)
    for (int j = std::max(0, -dj); j < std::min(side_, side_ - dj); ++j)
      for (int i = 0; i + di < side_; ++i) {
        const int turn = di > 0 ? i / di : j / dj;
        if (turn % 2 == color) threads_.push_back({at(i, j), at(i + di, j + dj), length, compliance});
      }
}

dvec2 Cloth::rest_place(uint32_t particle) const {
  return dvec2(particle % uint32_t(side_), particle / uint32_t(side_)) * spacing_;
}

BaseMesh Cloth::rest() const {
  BaseMesh mesh;
  mesh.name = "cloth";
  mesh.position = x_;
  for (int j = 0; j + 1 < side_; ++j)
    for (int i = 0; i + 1 < side_; ++i) {
      const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      // Diagonals to and fro: none of both directions bends more easily.
      const bool turned = (i + j) % 2;
      mesh.triangle.push_back(turned ? std::array{a, b, d} : std::array{a, b, c});
      mesh.triangle.push_back(turned ? std::array{b, c, d} : std::array{a, c, d});
    }
  for (const auto& t : mesh.triangle) mesh.uv.push_back({rest_place(t[0]), rest_place(t[1]), rest_place(t[2])});
  compute_normals(mesh);
  return mesh;
}

void Cloth::advance() {
  for (int k = 0; k < setup_.steps_per_frame; ++k) step(setup_.frame_seconds / setup_.steps_per_frame);
}

void Cloth::step(double dt) {
  // No particle moves farther in a step than layers are seen by each other.
  const double fastest = 0.25 * setup_.thickness / dt;
  before_ = x_;
  for (size_t i = 0; i < x_.size(); ++i) {
    v_[i].z -= kGravity * dt;
    v_[i] *= 1 - kDrag * dt;
    const double speed = glm::length(v_[i]);
    if (speed > fastest) v_[i] *= fastest / speed;
    x_[i] += v_[i] * dt;
  }
  for (const Thread& t : threads_) {
    const dvec3 d = x_[t.b] - x_[t.a];
    const double length = glm::length(d);
    const dvec3 move = d * (0.5 * (length - t.length) / (length * (1 + 0.5 * t.compliance / (dt * dt))));
    x_[t.a] += move;
    x_[t.b] -= move;
  }
  keep_layers_apart();
  keep_off_ball();
  for (size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - before_[i]) / dt;
  for (const Thread& t : threads_) {
    const dvec3 lost = (v_[t.b] - v_[t.a]) * std::min(0.25, kFriction * dt);
    v_[t.a] += lost;
    v_[t.b] -= lost;
  }
}

void Cloth::keep_off_ball() {
  const double reach = setup_.radius + 0.5 * setup_.thickness;
  for (size_t i = 0; i < x_.size(); ++i) {
    const double distance = glm::length(x_[i]);
    if (distance >= reach) continue;
    const dvec3 normal = x_[i] / distance;
    const double depth = reach - distance;
    x_[i] += depth * normal;
    dvec3 slip = x_[i] - before_[i];
    slip -= glm::dot(slip, normal) * normal;
    const double length = glm::length(slip);
    if (length > 0) x_[i] -= slip * std::min(1.0, setup_.friction * depth / length);
    x_[i] *= std::max(1.0, reach / glm::length(x_[i]));
  }
}

// Particles that were apart in the flat cloth stay as far apart as cloth is thick.
void Cloth::keep_layers_apart() {
  const double reach = setup_.thickness;
  const size_t buckets = 4 * x_.size();
  std::vector<uint32_t> start(buckets + 1, 0), order(x_.size());
  const auto bucket = [&](int64_t x, int64_t y, int64_t z) { return size_t(key(x, y, z) % buckets); };
  const auto home = [&](const dvec3& p) { return bucket(cell(p.x, reach), cell(p.y, reach), cell(p.z, reach)); };
  for (const dvec3& p : x_) ++start[home(p) + 1];
  for (size_t b = 0; b < buckets; ++b) start[b + 1] += start[b];
  std::vector<uint32_t> next(start.begin(), start.end() - 1);
  std::vector<dvec3> at_first = x_;  // what cells were made from
  for (uint32_t i = 0; i < x_.size(); ++i) order[next[home(at_first[i])]++] = i;
  for (uint32_t i = 0; i < x_.size(); ++i) {
    const dvec3 p = at_first[i];
    const int64_t cx = cell(p.x, reach), cy = cell(p.y, reach), cz = cell(p.z, reach);
    std::array<size_t, 27> seen;  // cells that share a bucket are visited once
    size_t count = 0;
    for (int64_t dz = -1; dz <= 1; ++dz)
      for (int64_t dy = -1; dy <= 1; ++dy)
        for (int64_t dx = -1; dx <= 1; ++dx) {
          const size_t b = bucket(cx + dx, cy + dy, cz + dz);
          if (std::find(seen.begin(), seen.begin() + count, b) != seen.begin() + count) continue;
          seen[count++] = b;
          for (uint32_t k = start[b]; k < start[b + 1]; ++k) {
            const uint32_t j = order[k];
            if (j <= i) continue;
            const dvec3 d = x_[j] - x_[i];
            const double squared = glm::dot(d, d);
            if (squared >= reach * reach || squared == 0) continue;
            const double rest = glm::length(rest_place(i) - rest_place(j));
            if (rest < 1.5 * spacing_) continue;  // neighbours, which threads hold
            const double keep = std::min(reach, rest);
            const double distance = std::sqrt(squared);
            if (distance >= keep) continue;
            const dvec3 normal = d / distance, move = normal * (0.5 * (keep - distance));
            dvec3 slip = (x_[j] - before_[j]) - (x_[i] - before_[i]);
            slip -= glm::dot(slip, normal) * normal;
            const double length = glm::length(slip), most = setup_.friction * (keep - distance);
            const dvec3 hold = length > 0 ? slip * (0.5 * std::min(1.0, most / length)) : dvec3(0);
            x_[i] += hold - move;
            x_[j] += move - hold;
          }
        }
  }
}

}  // namespace wale::drape
