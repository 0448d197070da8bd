#include "host/fit/resample.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"

namespace wale::fit {
namespace {

// Old pixels that a new one covers along one axis, and their shares of it; these add up to 1.
struct Cover {
  int first = 0;
  std::vector<double> share;
};

std::vector<Cover> covers(int from, int to) {
  std::vector<Cover> all(static_cast<size_t>(to));
  for (int i = 0; i < to; ++i) {
    // In units of 1 / to of an old pixel everything is whole.
    const int64_t begin = int64_t(i) * from, end = begin + from;
    Cover& cover = all[size_t(i)];
    cover.first = int(begin / to);
    for (int64_t at = begin; at < end;) {
      const int64_t next = std::min(end, (at / to + 1) * to);
      cover.share.push_back(double(next - at) / from);
      at = next;
    }
  }
  return all;
}

}  // namespace

Picture at_resolution(const Picture& picture, int width, int height) {
  if (width <= 0 || height <= 0 || picture.width <= 0 || picture.height <= 0)
    bug("at_resolution: {} x {} to {} x {}", picture.width, picture.height, width, height);
  const auto across = covers(picture.width, width), down = covers(picture.height, height);
  Picture out(width, height);
  std::vector<double> row(3 * size_t(picture.width));
  for (int y = 0; y < height; ++y) {
    std::fill(row.begin(), row.end(), 0.0);
    for (size_t j = 0; j < down[size_t(y)].share.size(); ++j) {
      const float* from = picture.at(0, down[size_t(y)].first + int(j));
      for (size_t i = 0; i < row.size(); ++i) row[i] += down[size_t(y)].share[j] * double(from[i]);
    }
    for (int x = 0; x < width; ++x) {
      const Cover& cover = across[size_t(x)];
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (size_t i = 0; i < cover.share.size(); ++i) sum += cover.share[i] * row[3 * (size_t(cover.first) + i) + c];
        out.at(x, y)[c] = float(sum);
      }
    }
  }
  return out;
}

std::vector<Picture> pyramid(const Picture& picture, int levels, int smallest) {
  std::vector<Picture> all{picture};
  while (int(all.size()) < levels) {
    const int width = (all.back().width + 1) / 2, height = (all.back().height + 1) / 2;
    if (std::min(width, height) < smallest) break;
    all.push_back(at_resolution(all.back(), width, height));
  }
  return all;
}

Picture cropped(const Picture& picture, const Rectangle& part) {
  Picture out(part.width, part.height);
  for (int y = 0; y < part.height; ++y)
    std::copy_n(picture.at(part.x, part.y + y), 3 * size_t(part.width), out.at(0, y));
  return out;
}

}  // namespace wale::fit
