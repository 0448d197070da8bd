#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "geom/vec.h"

namespace wale::test {

/// Probability of a chi-squared value this large or larger; Wilson & Hilferty's normal approximation.
inline double chi_squared_tail(double chi2, double degrees) {
  const double z = (std::cbrt(chi2 / degrees) - (1 - 2 / (9 * degrees))) / std::sqrt(2 / (9 * degrees));
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

/// p-value of counts against expected counts; cells expected below 5 are pooled into one.
inline double chi_squared_p(const std::vector<double>& counts, const std::vector<double>& expected) {
  double chi2 = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 5) {
      pooled_count += counts[i];
      pooled_expected += expected[i];
    } else {
      chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
      ++cells;
    }
  }
  if (pooled_expected > 1) {
    chi2 += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
    ++cells;
  } else if (pooled_count > 12) {
    return 0;  // a crowd where nobody is expected
  }
  return cells > 1 ? chi_squared_tail(chi2, cells - 1) : 1;
}

/// Uniform numbers, the same on every standard library.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double uniform() { return engine_() * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  float uniform_float() { return float(engine_() >> 8) * 0x1p-24f; }
  dvec3 direction() {
    const double z = uniform(-1, 1), phi = uniform(0, 2 * M_PI), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace wale::test
