#include "host/film.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace wale {

PixelStatistics pixel_statistics(std::span<const w_float4> scrambles, const std::array<double, 3>& weights) {
  PixelStatistics p;
  const auto value = [&](const w_float4& s) { return weights[0] * s.x + weights[1] * s.y + weights[2] * s.z; };
  for (const w_float4& s : scrambles) {
    p.mean += value(s);
    p.samples += s.w;
    p.scrambles += s.w > 0;
  }
  if (p.samples == 0) return p;
  p.mean /= p.samples;
  if (p.scrambles < 2) return p;
  // Scrambles are independent of each other: with m_g the mean of scramble g, of n_g samples, and w_g = n_g/n, the sum
  // of w_g^2 (m_g - m)^2 is 1 - sum of w_g^2 times the variance of m on average, where that of m_g is as 1/n_g.
  double spread = 0, together = 0;
  for (const w_float4& s : scrambles) {
    if (s.w == 0) continue;
    const double w = s.w / p.samples, off = w * (value(s) / s.w - p.mean);
    spread += off * off;
    together += w * w;
  }
  p.variance = spread / (1 - together);
  return p;
}

Image develop(const FilmSums& sums, const double origin[3]) {
  Image image;
  image.width = sums.width;
  image.height = sums.height;
  image.channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"};
  const bool aov = !sums.aov.empty();
  if (aov)
    for (const char* name :
         {"albedo.R", "albedo.G", "albedo.B", "depth.Z", "normal.X", "normal.Y", "normal.Z", "uv.U", "tangent.X",
          "tangent.Y", "tangent.Z", "uv.V", "position.X", "position.Y", "position.Z", "ply.id", "coverage"})
      image.channels.push_back(name);
  const size_t pixels = size_t(sums.width) * sums.height, stride = image.channels.size();
  image.pixels.assign(pixels * stride, 0.0f);
  for (size_t i = 0; i < pixels; ++i) {
    float* out = image.pixels.data() + i * stride;
    double count = 0;
    for (size_t c = 0; c < 3; ++c) {
      std::array<double, 3> channel{};
      channel[c] = 1;
      const auto p = pixel_statistics(std::span(sums.radiance).subspan(i * kScrambles, kScrambles), channel);
      count = p.samples;
      out[c] = float(p.mean);
      out[3 + c] = float(std::min(p.variance, double(FLT_MAX)));  // squares of 1e20 and more
    }
    if (count == 0) continue;
    out[6] = float(count);
    if (!aov) continue;
    const w_float4* a = &sums.aov[i * 4];
    // Colours and directions are averages over all samples, nothing counting as zero, as denoisers expect. A place has
    // no such average: distance, uv and position are those of the samples that met something.
    const double hits = a[3].w, k = 1 / count, place = hits > 0 ? 1 / hits : 0;
    const std::array<double, 15> v = {a[0].x * k, a[0].y * k,     a[0].z * k,     a[0].w * place, a[1].x * k,
                                      a[1].y * k, a[1].z * k,     a[1].w * place, a[2].x * k,     a[2].y * k,
                                      a[2].z * k, a[2].w * place, a[3].x * place, a[3].y * place, a[3].z * place};
    for (size_t c = 0; c < v.size(); ++c) out[7 + c] = float(v[c] + (c >= 12 && hits > 0 ? origin[c - 12] : 0));
    out[22] = sums.ply[i] == W_NONE ? -1.0f : float(sums.ply[i]);
    out[23] = float(hits * k);  // share of the samples that met something
  }
  return image;
}

Image develop_gradients(const FilmSums& sums) {
  FilmSums radiance{sums.width, sums.height, sums.radiance, {}, {}};
  const double origin[3] = {0, 0, 0};
  const Image plain = develop(radiance, origin);
  Image image{plain.width, plain.height, plain.channels, {}};
  for (const char* name : kGradientNames)
    for (const char* channel : {".R", ".G", ".B"}) image.channels.push_back(std::string(name) + channel);
  const size_t before = plain.channels.size(), stride = image.channels.size();
  image.pixels.resize(size_t(image.width) * size_t(image.height) * stride);
  for (size_t i = 0; i < size_t(image.width) * size_t(image.height); ++i) {
    const float* in = plain.pixels.data() + i * before;
    float* out = image.pixels.data() + i * stride;
    std::copy_n(in, before, out);
    const float count = in[6];
    for (size_t k = 0; k < W_GRADIENT_COUNT; ++k) {
      const w_float4& sum = sums.aov[i * W_GRADIENT_COUNT + k];
      const float values[3] = {sum.x, sum.y, sum.z};
      for (size_t c = 0; c < 3; ++c) out[before + 3 * k + c] = count > 0 ? values[c] / count : 0.0f;
    }
  }
  return image;
}

}  // namespace wale
