#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/image.h"

namespace wale::bench {

/// A small picture as means over tiles with their standard errors, rgb by rgb: what unlike devices have in common.
struct TileMeans {
  int tiles_x = 0, tiles_y = 0;
  std::vector<float> mean, error;  ///< 3 per tile, row by row
};

constexpr int kTilePixels = 8;  ///< a side

/// From the pixel means and their variances (host/film.h), whose pixels are independent of each other.
TileMeans tile_means(const Image& image);

struct PictureCheck {
  double largest_z = 0;   ///< difference over its standard error
  double mean_z2 = 0;     ///< 1 where the pictures differ by noise alone
  double rmse_share = 0;  ///< RMSE of the tiles over the mean of the reference
  bool same = false;
};

/// Z-test tile by tile: the same picture where no tile is beyond kLargestZ and all together not beyond kMeanZ2.
PictureCheck compare_tiles(const TileMeans& reference, const TileMeans& tiles);

/// One tile in 10^6 pictures lies beyond by chance.
constexpr double kLargestZ = 6;
/// Of 108 values, 36 tiles of 3 colours that are one light's and so go together: five standard deviations.
constexpr double kMeanZ2 = 2.2;

/// The frozen workload's picture, from 1024 samples a pixel (bench/wale_bench/reference_picture.cpp).
const TileMeans& reference_picture();

/// The source text of reference_picture.cpp for these means.
std::string reference_source(const TileMeans& tiles, const std::string& device);

}  // namespace wale::bench
