#include "host/tile_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wale {
namespace {

constexpr double kFloorShare = 1.0 / 20, kBrightShare = 1.0 / 20;

PixelStatistics luminance(std::span<const w_float4> scrambles) {
  return pixel_statistics(scrambles, {0.2126, 0.7152, 0.0722});
}

}  // namespace

double tile_error(std::span<const w_float4> sums, double floor) {
  double sum = 0;
  size_t pixels = 0;
  for (size_t i = 0; i + kScrambles <= sums.size(); i += kScrambles) {
    const PixelStatistics p = luminance(sums.subspan(i, kScrambles));
    if (p.samples == 0) continue;
    if (p.scrambles < 2) return std::numeric_limits<double>::infinity();
    ++pixels;
    if (p.variance == 0) continue;
    const double against = std::max(p.mean, floor);
    sum += p.variance / (against * against);
  }
  return pixels ? std::sqrt(sum / double(pixels)) : std::numeric_limits<double>::infinity();
}

double tile_luminance(std::span<const w_float4> sums) {
  double sum = 0;
  size_t pixels = 0;
  for (size_t i = 0; i + kScrambles <= sums.size(); i += kScrambles) {
    const PixelStatistics p = luminance(sums.subspan(i, kScrambles));
    if (p.samples == 0) continue;
    sum += p.mean;
    ++pixels;
  }
  return pixels ? sum / double(pixels) : 0;
}

double error_floor(std::vector<double> luminances) {
  if (luminances.empty()) return 0;
  std::sort(luminances.begin(), luminances.end());
  const size_t kept = luminances.size() - size_t(kBrightShare * double(luminances.size()));
  return kFloorShare * std::accumulate(luminances.begin(), luminances.begin() + std::ptrdiff_t(kept), 0.0) /
         double(kept);
}

Reached reached(std::vector<double> errors, const std::vector<uint32_t>& samples, double goal, double floor) {
  Reached r;
  r.floor = floor;
  r.tiles = uint32_t(errors.size());
  if (errors.empty()) return r;
  std::sort(errors.begin(), errors.end());
  const auto share = [&](double q) { return errors[size_t(std::ceil(q * double(errors.size()))) - 1]; };
  r.worst = errors.back();
  r.p95 = share(0.95);
  r.median = share(0.5);
  if (goal > 0) r.missed = uint32_t(errors.end() - std::upper_bound(errors.begin(), errors.end(), goal));
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  r.least = *least;
  r.most = *most;
  r.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / double(samples.size());
  return r;
}

}  // namespace wale
