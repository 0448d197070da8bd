#include "host/tile_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wale {
namespace {

constexpr double kFloorShare = 1.0 / 20, kBrightShare = 1.0 / 20;

double luminance(const w_float4& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

struct Pixel {
  double samples = 0, mean = 0, variance = 0;  ///< variance of the mean
  int scrambles = 0;                           ///< that have samples
};

// As develop() (host/film.cpp), of the luminance: its noise is not the sum of the channels', which go together.
Pixel pixel_of(std::span<const w_float4> scrambles) {
  Pixel p;
  for (const w_float4& s : scrambles) {
    p.mean += luminance(s);
    p.samples += s.w;
    p.scrambles += s.w > 0;
  }
  if (p.samples == 0) return p;
  p.mean /= p.samples;
  if (p.scrambles < 2) return p;
  for (const w_float4& s : scrambles) {
    if (s.w == 0) continue;
    const double off = s.w / p.samples * (luminance(s) / s.w - p.mean);
    p.variance += off * off;
  }
  p.variance *= double(p.scrambles) / (p.scrambles - 1);
  return p;
}

}  // namespace

double tile_error(std::span<const w_float4> sums, double floor) {
  double sum = 0;
  size_t pixels = 0;
  for (size_t i = 0; i + kScrambles <= sums.size(); i += kScrambles) {
    const Pixel p = pixel_of(sums.subspan(i, kScrambles));
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
    const Pixel p = pixel_of(sums.subspan(i, kScrambles));
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
