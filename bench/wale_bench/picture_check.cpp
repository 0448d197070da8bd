#include "bench/wale_bench/picture_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::bench {
namespace {

// Where a tile shows the sky alone it has no noise: rounding of sums in another order remains.
constexpr double kRounding = 1e-5;

}  // namespace

TileMeans tile_means(const Image& image) {
  TileMeans out;
  out.tiles_x = image.width / kTilePixels;
  out.tiles_y = image.height / kTilePixels;
  constexpr double kPixels = kTilePixels * kTilePixels;
  for (int ty = 0; ty < out.tiles_y; ++ty)
    for (int tx = 0; tx < out.tiles_x; ++tx)
      for (int c = 0; c < 3; ++c) {
        double mean = 0, variance = 0;
        for (int y = 0; y < kTilePixels; ++y)
          for (int x = 0; x < kTilePixels; ++x) {
            const float* p = image.at(tx * kTilePixels + x, ty * kTilePixels + y);
            mean += double(p[c]) / kPixels;
            variance += double(p[3 + c]) / (kPixels * kPixels);
          }
        out.mean.push_back(float(mean));
        out.error.push_back(float(std::sqrt(variance)));
      }
  return out;
}

PictureCheck compare_tiles(const TileMeans& reference, const TileMeans& tiles) {
  if (reference.mean.size() != tiles.mean.size() || tiles.mean.empty())
    bug("picture check: {} values against {}", tiles.mean.size(), reference.mean.size());
  PictureCheck out;
  double square = 0, level = 0;
  const double n = double(tiles.mean.size());
  for (size_t i = 0; i < tiles.mean.size(); ++i) {
    const double off = double(tiles.mean[i]) - reference.mean[i];
    const double rounding = kRounding * std::abs(double(reference.mean[i]));
    const double z =
        std::abs(off) / std::max(1e-30, std::hypot(double(tiles.error[i]), double(reference.error[i]), rounding));
    out.largest_z = std::isfinite(z) ? std::max(out.largest_z, z) : INFINITY;
    out.mean_z2 += z * z / n;
    square += off * off / n;
    level += double(reference.mean[i]) / n;
  }
  out.rmse_share = std::sqrt(square) / level;
  out.same = out.largest_z <= kLargestZ && out.mean_z2 <= kMeanZ2;
  return out;
}

std::string reference_source(const TileMeans& tiles, const std::string& device) {
  std::string text = fmt::format(
      "// Written by `wale_bench --write-reference FILE` on {}.\n"
      "#include \"bench/wale_bench/picture_check.h\"\n\nnamespace wale::bench {{\n\n"
      "const TileMeans& reference_picture() {{\n  // clang-format off\n  static const TileMeans tiles{{{}, {},\n",
      device, tiles.tiles_x, tiles.tiles_y);
  for (const auto* values : {&tiles.mean, &tiles.error}) {
    text += "    {";
    for (size_t i = 0; i < values->size(); ++i)
      text += fmt::format("{}{:.6e}f", i == 0 ? "" : i % 7 == 0 ? ",\n     " : ", ", (*values)[i]);
    text += values == &tiles.mean ? "},\n" : "}};\n";
  }
  return text + "  // clang-format on\n  return tiles;\n}\n\n}  // namespace wale::bench\n";
}

}  // namespace wale::bench
