#pragma once
#include <cmath>
#include <unordered_map>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// Numbered points in cubes of one side, so that those within `reach` of a place are found without looking at all.
class NearPoints {
 public:
  /// `reach` in metres, above 0.
  explicit NearPoints(double reach) : side_(1.01 * reach) {}

  void add(const dvec3& p, int number) { cubes_[cube(p)].push_back(number); }

  /// Calls visit(number) for every point within reach of p, and for some that are farther; for none twice, except where
  /// a cube is smaller than the rounding of p.
  template <typename Visit>
  void visit_near(const dvec3& p, Visit&& visit) const {
    const Cube middle = cube(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const auto found = cubes_.find({middle.x + x, middle.y + y, middle.z + z});
          if (found == cubes_.end()) continue;
          for (const int number : found->second) visit(number);
        }
  }

 private:
  struct Cube {
    double x, y, z;  ///< whole numbers, of any size
    bool operator==(const Cube&) const = default;
  };
  struct Hash {
    size_t operator()(const Cube& c) const {
      const std::hash<double> hash;
      return hash(c.x) * 73856093u ^ hash(c.y) * 19349663u ^ hash(c.z) * 83492791u;
    }
  };

  Cube cube(const dvec3& p) const {
    return {std::floor(p.x / side_), std::floor(p.y / side_), std::floor(p.z / side_)};
  }

  double side_;
  std::unordered_map<Cube, std::vector<int>, Hash> cubes_;
};

}  // namespace wale
