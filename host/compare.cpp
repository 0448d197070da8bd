#include "host/compare.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/flip.h"

namespace wale {
namespace {

// R, G and B of every pixel.
std::vector<float> colors_of(const Image& image, const std::string& name) {
  int rgb[3];
  for (int c = 0; c < 3; ++c) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), std::string(1, "RGB"[c]));
    rgb[c] = found != image.channels.end() ? int(found - image.channels.begin())
                                           : std::min(c, int(image.channels.size()) - 1);
  }
  std::vector<float> out;
  out.reserve(size_t(image.width) * image.height * 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c : rgb) {
        const float value = image.at(x, y)[c];
        if (!std::isfinite(value)) user_error("{}: pixel ({}, {}): {} is not a finite number", name, x, y, value);
        out.push_back(value);
      }
  return out;
}

std::vector<float> clipped(std::vector<float> values) {
  for (float& v : values) v = std::clamp(v, 0.0f, 1.0f);
  return values;
}

}  // namespace

CompareReport compare_images(const Image& a, const Image& b, const std::string& name_a, const std::string& name_b,
                             double epsilon) {
  if (a.width != b.width || a.height != b.height)
    user_error("{} is {} x {}, {} is {} x {}: images of one size are needed", name_a, a.width, a.height, name_b,
               b.width, b.height);
  if (a.width <= 0 || a.height <= 0 || a.channels.empty() || b.channels.empty())
    user_error("{}, {}: an image without pixels", name_a, name_b);
  const auto left = colors_of(a, name_a), right = colors_of(b, name_b);
  CompareReport report;
  report.width = a.width;
  report.height = a.height;
  double squares = 0, relative = 0;
  for (size_t i = 0; i < left.size(); ++i) {
    const double difference = double(left[i]) - right[i], square = difference * difference;
    squares += square;
    relative += square / (double(right[i]) * right[i] + epsilon);
    report.mean_a[i % 3] += left[i];
    report.mean_b[i % 3] += right[i];
    if (i == 0 || std::abs(difference) > report.largest) {
      report.largest = std::abs(difference);
      report.largest_x = int(i / 3 % a.width);
      report.largest_y = int(i / 3 / a.width);
      report.largest_channel = std::string(1, "RGB"[i % 3]);
    }
  }
  const double values = double(left.size()), pixels = values / 3;
  report.rmse = std::sqrt(squares / values);
  report.relative_mse = relative / values;
  for (int c = 0; c < 3; ++c) report.mean_a[c] /= pixels, report.mean_b[c] /= pixels;
  double flip = 0;
  for (float v : flip_map(clipped(left), clipped(right), a.width, a.height)) flip += v;
  report.flip_mean = flip / pixels;
  return report;
}

std::string CompareReport::text() const {
  const auto rgb = [](const std::array<double, 3>& m) { return fmt::format("{:.6g} {:.6g} {:.6g}", m[0], m[1], m[2]); };
  return fmt::format(
      "size          {} x {}\n"
      "RMSE          {:.6g}\n"
      "relative MSE  {:.6g}\n"
      "FLIP          {:.6g}\n"
      "largest       {:.6g} at pixel ({}, {}), channel {}\n"
      "mean          {} | {}\n",
      width, height, rmse, relative_mse, flip_mean, largest, largest_x, largest_y, largest_channel, rgb(mean_a),
      rgb(mean_b));
}

}  // namespace wale
