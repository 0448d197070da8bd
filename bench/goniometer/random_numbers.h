#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

namespace wale {

/// Uniform numbers of one path: SplitMix64 (Steele, Lea, Flood 2014) started from (seed, path), so that a path is the
/// same whichever thread walks it.
class PathRandom {
 public:
  PathRandom(uint64_t seed, uint64_t path)
      : state_(mix(seed * 0x9e3779b97f4a7c15u + 1) ^ mix(path + 0x632be59bd9b4e019u)) {}

  /// [0, 1)
  double uniform() { return double(next() >> 11) * 0x1p-53; }

  /// Standard normal, Box and Muller 1958.
  double normal() {
    const double r = std::sqrt(-2 * std::log(1 - uniform()));
    return r * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15u); }

  uint64_t state_;
};

}  // namespace wale
