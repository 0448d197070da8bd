#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "host/fit/picture.h"

namespace wale::fit {

/// Colours of any function of the pixel's place.
template <typename Color>
Picture painted(int width, int height, const Color& color) {
  Picture picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = float(color(x, y, c));
  return picture;
}

/// Independent values between 0 and 1.
inline Picture random_picture(int width, int height, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> value(0, 1);
  return painted(width, height, [&](int, int, int) { return value(engine); });
}

/// Something like stitches: rows of slanted waves in a warm colour; `shift` pixels aside.
inline Picture stitches(int width, int height, double shift = 0, double shade = 0.4, double contrast = 0.5) {
  constexpr double kColor[] = {1.0, 0.7, 0.4};
  return painted(width, height, [&](int x, int y, int c) {
    const double wave = std::sin(0.7 * (x + shift)) * std::cos(0.5 * y + 0.3 * std::sin(0.35 * (x + shift)));
    return shade * kColor[c] * (1 + contrast * wave);
  });
}

/// A PNM file of 8 or 16 bits a value, exactly these integers.
template <typename Value>
std::string ppm(int width, int height, int bits, const Value& value) {
  std::string text =
      "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + std::to_string((1 << bits) - 1) + "\n";
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const int v = value(x, y, c);
        if (bits == 16) text += char(v >> 8);
        text += char(v & 255);
      }
  return text;
}

}  // namespace wale::fit
