#include "tests/image/actual_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wale::test {
namespace {

double luminance(const float* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

}  // namespace

std::vector<double> actual_tile_errors(const Image& picture, const Image& a, const Image& b, double floor) {
  std::vector<double> errors;
  for (int top = 0; top < picture.height; top += 8)
    for (int left = 0; left < picture.width; left += 8) {
      double sum = 0;
      int pixels = 0;
      for (int y = top; y < std::min(top + 8, picture.height); ++y)
        for (int x = left; x < std::min(left + 8, picture.width); ++x, ++pixels) {
          const double v = luminance(picture.at(x, y)), v1 = luminance(a.at(x, y)), v2 = luminance(b.at(x, y));
          const double against = std::max((v1 + v2) / 2, floor);
          if (against > 0) sum += (v - v1) * (v - v2) / (against * against);
        }
      errors.push_back(sum / pixels);
    }
  return errors;
}

ActualError summary(const std::vector<double>& squared) {
  const double mean = std::accumulate(squared.begin(), squared.end(), 0.0) / double(squared.size());
  return {std::sqrt(std::max(0.0, mean)), std::sqrt(std::max(0.0, *std::max_element(squared.begin(), squared.end())))};
}

}  // namespace wale::test
