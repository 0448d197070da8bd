#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// Numbered points in cubes of one side, so that those within `reach` of a place are found without looking at all.
class NearPoints {
 public:
  /// `reach` in metres, above 0.
  explicit NearPoints(double reach) : reach_(1.01 * reach), side_(2.5 * reach) {}

  void add(const dvec3& p, int number) { cubes_[cube(p)].push_back(number); }

  /// Calls visit(number) for every point within reach of p, and for some that are farther; for none twice.
  template <typename Visit>
  void visit_near(const dvec3& p, Visit&& visit) const {
    const Cube low = cube(p - reach_), high = cube(p + reach_);
    for_each(low.z, high.z, [&](double z) {
      for_each(low.y, high.y, [&](double y) {
        for_each(low.x, high.x, [&](double x) {
          const auto found = cubes_.find({x, y, z});
          if (found == cubes_.end()) return;
          for (const int number : found->second) visit(number);
        });
      });
    });
  }

 private:
  struct Cube {
    double x, y, z;  ///< whole numbers, of any size
    bool operator==(const Cube&) const = default;
  };
  struct Hash {
    size_t operator()(const Cube& c) const {
      uint64_t hash = 0;
      for (const double value : {c.x, c.y, c.z}) {
        hash = (hash ^ std::bit_cast<uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15u;  // -0 is equal to 0
        hash ^= hash >> 32;  // a small whole number has its bits on top
      }
      return hash;
    }
  };

  Cube cube(const dvec3& p) const {
    return {std::floor(p.x / side_), std::floor(p.y / side_), std::floor(p.z / side_)};
  }

  /// The whole numbers from low to high, one or two of them. Where they are too large to count by ones, reach_ is less
  /// than half the rounding of a place, so that low is high.
  template <typename Do>
  static void for_each(double low, double high, Do&& act) {
    act(low);
    while (low < high) act(low += 1);
  }

  double reach_, side_;
  std::unordered_map<Cube, std::vector<int>, Hash> cubes_;
};

}  // namespace wale
