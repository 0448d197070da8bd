#include "bench/goniometer/measure.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int64_t kBlock = 2048;  ///< paths added up by one thread; the unit of determinism
constexpr double kRoulette = 0.05;

/// Sums of one block of paths.
struct Sums {
  double t0 = 0, events = 0, collided = 0;
  dvec3 surface{0}, surface2{0}, body{0}, body2{0};
  double total = 0, total2 = 0;
  double body_mean = 0, forward = 0, exit_half = 0, theta = 0, theta2 = 0, hits = 0;
  std::array<double, kAngleBins> phi{}, theta_bins{}, surface_phi{};
  std::array<double, kHitBins> hits_forward{}, hits_back{};

  void add(const Sums& o) {
    t0 += o.t0, events += o.events, collided += o.collided;
    surface += o.surface, surface2 += o.surface2, body += o.body, body2 += o.body2;
    total += o.total, total2 += o.total2;
    body_mean += o.body_mean, forward += o.forward, exit_half += o.exit_half;
    theta += o.theta, theta2 += o.theta2, hits += o.hits;
    for (size_t i = 0; i < kAngleBins; ++i)
      phi[i] += o.phi[i], theta_bins[i] += o.theta_bins[i], surface_phi[i] += o.surface_phi[i];
    for (size_t i = 0; i < kHitBins; ++i) hits_forward[i] += o.hits_forward[i], hits_back[i] += o.hits_back[i];
  }
};

int angle_bin(double angle, double low, double range) {
  return std::clamp(int((angle - low) / range * kAngleBins), 0, kAngleBins - 1);
}

dvec3 turned(dvec3 v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

void walk(const Bundle& bundle, const FibreScattering& fibre, const Incidence& in, int64_t path, Sums& sums) {
  PathRandom random(in.seed, uint64_t(path));
  // Stratified over h by the path's number within its section.
  const int64_t strata = std::max<int64_t>(1, in.paths / in.sections), k = path / in.sections;
  const double u = (double(k % strata) + random.uniform()) / double(strata);
  const double h = in.h_low + (in.h_high - in.h_low) * u, gamma = std::asin(std::clamp(h, -1.0, 1.0));
  const double spin = 2 * kPi * random.uniform();  // the bundle is met from any side

  Bundle::Ray ray;
  const double z = std::isfinite(bundle.slab()) ? bundle.slab() * (random.uniform() - 0.5) : 0;
  ray.origin = turned({std::cos(gamma), h, z}, spin);
  ray.direction = turned({-std::cos(in.theta), 0, -std::sin(in.theta)}, spin);
  ray.turn = -spin;

  dvec3 weight(1);
  int events = 0, through = 0, last = -1;
  bool only_reflected = true;
  while ((last = bundle.advance(ray, last)) >= 0) {
    const FibreEvent event = scatter(fibre, bundle.axis(last), -ray.direction, random);
    ray.direction = event.direction;
    weight *= event.weight;
    ++events;
    through += !event.reflected;
    only_reflected = only_reflected && event.reflected && events == 1;
    const double largest = std::max({weight.x, weight.y, weight.z});
    if (largest < kRoulette) {
      if (random.uniform() * kRoulette >= largest) {
        sums.events += events;
        sums.collided += 1;
        return;
      }
      weight *= kRoulette / largest;
    }
  }

  const double mean = (weight.x + weight.y + weight.z) / 3;
  sums.total += mean;
  sums.total2 += mean * mean;
  if (events == 0) {
    sums.t0 += 1;
    return;
  }
  sums.events += events;
  sums.collided += 1;
  const dvec3 out = turned(ray.direction, ray.turn), place = turned(ray.origin, ray.turn);
  const double phi = std::atan2(out.y, out.x), theta = std::asin(std::clamp(out.z, -1.0, 1.0));
  const size_t phi_bin = size_t(angle_bin(phi, -kPi, 2 * kPi));
  if (only_reflected) {
    sums.surface += weight;
    sums.surface2 += weight * weight;
    sums.surface_phi[phi_bin] += mean;
    return;
  }
  sums.body += weight;
  sums.body2 += weight * weight;
  sums.body_mean += mean;
  sums.phi[phi_bin] += mean;
  sums.theta_bins[size_t(angle_bin(theta, -kPi / 2, kPi))] += mean;
  const bool forward = out.x < 0;
  sums.forward += forward ? mean : 0;
  sums.exit_half += place.x > 0 ? mean : 0;
  sums.theta += mean * (theta + in.theta);
  sums.theta2 += mean * (theta + in.theta) * (theta + in.theta);
  sums.hits += mean * through;
  (forward ? sums.hits_forward : sums.hits_back)[size_t(std::min(through, kHitBins - 1))] += mean;
}

Estimate estimate(double sum, double sum2, double n) {
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, sum2 / n - mean * mean) / n)};
}

Measurement finish(const Sums& s, int64_t paths) {
  Measurement m;
  const double n = double(paths);
  m.paths = paths;
  m.uncollided = estimate(s.t0, s.t0, n);
  m.total = estimate(s.total, s.total2, n);
  for (int k = 0; k < 3; ++k) {
    m.surface[size_t(k)] = estimate(s.surface[k], s.surface2[k], n);
    m.body[size_t(k)] = estimate(s.body[k], s.body2[k], n);
  }
  m.events = s.collided > 0 ? s.events / s.collided : 0;
  const double w = s.body_mean > 0 ? 1 / s.body_mean : 0;
  m.forward = s.forward * w;
  m.exit_half = s.exit_half * w;
  m.theta_mean = s.theta * w;
  m.theta_sd = std::sqrt(std::max(0.0, s.theta2 * w - m.theta_mean * m.theta_mean));
  m.hits = s.hits * w;
  const double surface = s.surface.x + s.surface.y + s.surface.z;
  for (size_t i = 0; i < kAngleBins; ++i) {
    m.phi[i] = s.phi[i] * w;
    m.theta[i] = s.theta_bins[i] * w;
    m.surface_phi[i] = surface > 0 ? s.surface_phi[i] * 3 / surface : 0;
  }
  for (size_t i = 0; i < kHitBins; ++i) {
    m.hits_forward[i] = s.hits_forward[i] * w;
    m.hits_back[i] = s.hits_back[i] * w;
  }
  return m;
}

}  // namespace

std::vector<Measurement> measure(const FibreRecipe& recipe, const FibreScattering& fibre,
                                 const std::vector<Incidence>& incidences, int threads) {
  int sections = 1;
  for (const Incidence& in : incidences) sections = std::max(sections, in.sections);
  std::vector<Bundle> bundles;
  for (int i = 0; i < sections; ++i) {
    FibreRecipe one = recipe;
    one.seed = recipe.seed + uint32_t(i);
    bundles.emplace_back(one);
  }

  struct Block {
    size_t incidence;
    int64_t first, last;
    Sums sums;
  };
  std::vector<Block> blocks;
  for (size_t k = 0; k < incidences.size(); ++k)
    for (int64_t p = 0; p < incidences[k].paths; p += kBlock)
      blocks.push_back({k, p, std::min(p + kBlock, incidences[k].paths), {}});

  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i; (i = next.fetch_add(1)) < blocks.size();) {
      const Incidence& in = incidences[blocks[i].incidence];
      for (int64_t p = blocks[i].first; p < blocks[i].last; ++p)
        walk(bundles[size_t(p % in.sections)], fibre, in, p, blocks[i].sums);
    }
  };
  const int count = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
  std::vector<std::jthread> pool;
  for (int i = 1; i < count; ++i) pool.emplace_back(work);
  work();
  pool.clear();

  std::vector<Sums> sums(incidences.size());
  for (const Block& b : blocks) sums[b.incidence].add(b.sums);
  std::vector<Measurement> out;
  for (size_t k = 0; k < incidences.size(); ++k) out.push_back(finish(sums[k], incidences[k].paths));
  return out;
}

Measurement measure(const FibreRecipe& recipe, const FibreScattering& fibre, const Incidence& incidence, int threads) {
  return measure(recipe, fibre, std::vector<Incidence>{incidence}, threads).front();
}

double body_albedo(const Measurement& white, double c) {
  double sum = 0, power = 1;
  for (size_t i = 0; i < kHitBins; ++i, power *= c) sum += (white.hits_forward[i] + white.hits_back[i]) * power;
  return sum;
}

SidedLight sided_light(const Measurement& white, double c) {
  double back = 0, forward = 0, power = 1;
  for (size_t i = 0; i < kHitBins; ++i, power *= c)
    back += white.hits_back[i] * power, forward += white.hits_forward[i] * power;
  double surface_back = 0;  // its bins' borders include the quarter turns
  for (int i = kAngleBins / 4; i < kAngleBins * 3 / 4; ++i) surface_back += white.surface_phi[size_t(i)];
  const double body = white.body[0].mean, surface = white.surface[0].mean;
  return {body * back + surface * surface_back, body * forward + surface * (1 - surface_back)};
}

}  // namespace wale
