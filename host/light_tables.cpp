#include "host/light_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geom/error.h"
#include "geom/vec.h"

namespace wale {
namespace {

// Radiance that sums of samples, weighted by less than 1e6, still hold as floats.
constexpr float kBrightest = 1e30f;

constexpr double kPi = std::numbers::pi;

// The plain mean of the channels: luminance would all but hide a blue light, whose noise is as visible as another's.
double mean(const std::array<float, 3>& c) { return (double(c[0]) + c[1] + c[2]) / 3; }

// Appends the running shares of `weights`; exactly 1 from the last positive one on, and all 1 when there is none.
void append_cdf(const std::vector<double>& weights, std::vector<float>& out) {
  double total = 0;
  size_t last = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    total += weights[i];
    if (weights[i] > 0) last = i;
  }
  double sum = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    out.push_back(total > 0 && i < last ? float(sum / total) : 1.0f);
  }
}

void require_emission(const std::array<float, 3>& c) {
  for (const float v : c)
    if (!(v >= 0 && v <= kBrightest)) user_error("light: radiance {} is no number from 0 to {:.0e}", v, kBrightest);
}

}  // namespace

EnvironmentTables environment_tables(const std::vector<float>& rgb, int width, int height, LightChoice choice) {
  if (width < 1 || height < 1 || rgb.size() != size_t(width) * height * 3)
    bug("environment_tables: {} values for {} x {} texels", rgb.size(), width, height);
  std::vector<double> brightness(size_t(width) * height);
  EnvironmentTables out;
  out.texels.resize(brightness.size());
  for (size_t i = 0; i < brightness.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      if (!(rgb[3 * i + k] >= 0 && rgb[3 * i + k] <= kBrightest))
        user_error("environment: texel ({}, {}) holds {}; radiance is a number from 0 to {:.0e}", i % width, i / width,
                   rgb[3 * i + k], kBrightest);
    // The plain mean of the channels: luminance would all but hide a blue light.
    brightness[i] = (double(rgb[3 * i]) + rgb[3 * i + 1] + rgb[3 * i + 2]) / 3;
    out.texels[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 0};
  }
  std::vector<double> rows(height), row(width), across(brightness.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double* line = &brightness[size_t(y) * width];
      across[size_t(y) * width + x] = 0.25 * (line[(x + width - 1) % width] + 2 * line[x] + line[(x + 1) % width]);
    }
  std::vector<float> columns;
  for (int y = 0; y < height; ++y) {
    const int above = std::max(y - 1, 0), below = std::min(y + 1, height - 1);
    double sum = 0;
    for (int x = 0; x < width; ++x) {
      const double power = 0.25 * (across[size_t(above) * width + x] + 2 * across[size_t(y) * width + x] +
                                   across[size_t(below) * width + x]);
      const double weight = choice == LightChoice::power ? power : power > 0 ? 1 : 0;
      row[x] = out.texels[size_t(y) * width + x].w = float(weight);
      sum += row[x];
    }
    append_cdf(row, columns);
    rows[y] = sum / width * 0.5 * (std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height));
  }
  append_cdf(rows, out.cdf);
  out.cdf.insert(out.cdf.end(), columns.begin(), columns.end());
  double average = 0;
  for (const double r : rows) average += r;
  out.average = float(average);
  return out;
}

int LightTableBuilder::add(WLight light, double power) {
  tables_.lights.push_back(light);
  tables_.power.push_back(power);
  return int(tables_.power.size()) - 1;
}

int LightTableBuilder::add_sphere(const std::array<float, 3>& radiance, const std::array<float, 3>& center,
                                  float radius) {
  require_emission(radiance);
  if (!(radius > 0) || !std::isfinite(radius)) user_error("light: sphere of radius {}; it is greater than 0", radius);
  WLight light{};
  light.kind = W_LIGHT_SPHERE;
  light.radiance = {radiance[0], radiance[1], radiance[2], 0};
  light.center = {center[0], center[1], center[2], radius};
  light.area = float(4 * kPi * radius * radius);
  return add(light, mean(radiance) * kPi * light.area);
}

int LightTableBuilder::add_mesh(const std::array<float, 3>& radiance, const std::vector<LightTriangle>& triangles,
                                const std::vector<int32_t>& scene_triangles, bool one_sided) {
  require_emission(radiance);
  if (triangles.size() != scene_triangles.size())
    bug("add_mesh: {} triangles, {} scene triangles", triangles.size(), scene_triangles.size());
  std::vector<double> areas;
  double area = 0;
  for (const LightTriangle& t : triangles) {
    const dvec3 a(t[0], t[1], t[2]), b(t[3], t[4], t[5]), c(t[6], t[7], t[8]);
    areas.push_back(0.5 * glm::length(glm::cross(b - a, c - a)));
    area += areas.back();
  }
  if (!(area > 0)) user_error("light: its mesh of {} triangles has no area", triangles.size());
  WLight light{};
  light.kind = W_LIGHT_MESH;
  light.radiance = {radiance[0], radiance[1], radiance[2], 0};
  light.center.w = one_sided ? 1.0f : 0.0f;
  light.first_triangle = w_uint(tables_.triangle_index.size());
  light.triangles = w_uint(triangles.size());
  light.area = float(area);
  append_cdf(areas, tables_.cdf);
  for (const LightTriangle& t : triangles) tables_.triangles.insert(tables_.triangles.end(), t.begin(), t.end());
  tables_.triangle_index.insert(tables_.triangle_index.end(), scene_triangles.begin(), scene_triangles.end());
  return add(light, mean(radiance) * kPi * area * (one_sided ? 1 : 2));
}

int LightTableBuilder::add_environment(const std::array<float, 3>& mean_radiance, float power_radius) {
  require_emission(mean_radiance);
  if (!(power_radius > 0)) bug("add_environment: scene radius {}", power_radius);
  WLight light{};
  light.kind = W_LIGHT_ENVIRONMENT;
  light.radiance = {mean_radiance[0], mean_radiance[1], mean_radiance[2], 0};
  return add(light, mean(mean_radiance) * 4 * kPi * kPi * power_radius * power_radius);
}

void LightTables::choose() {
  double total = 0;
  int lit = 0;
  for (const double p : power) {
    total += p;
    lit += p > 0;
  }
  // A tenth is shared evenly: a weak lamp beside the sky still lights what is near it.
  for (size_t i = 0; i < power.size(); ++i) {
    const double share = choice == LightChoice::power ? 0.9 * power[i] / total + 0.1 / lit : 1.0 / lit;
    lights[i].radiance.w = power[i] > 0 ? float(share) : 0;
  }
}

bool LightTables::any() const {
  return std::any_of(power.begin(), power.end(), [](double p) { return p > 0; });
}

LightTables LightTableBuilder::finish(LightChoice choice) {
  tables_.choice = choice;
  tables_.choose();
  return std::move(tables_);
}

}  // namespace wale
