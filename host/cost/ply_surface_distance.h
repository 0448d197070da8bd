#pragma once
#include <optional>
#include <span>
#include <vector>

#include "geom/near_points.h"
#include "geom/vec.h"

namespace wale {
class Device;
struct World;
}  // namespace wale

namespace wale::cost {

/// The surface of a scene's plies: cylinders that end in the bisector planes of their joints, and spheres round the
/// joints where a place lies in none of them (open ends). In double.
class PlySurface {
 public:
  /// One polyline. `ghost_ends`: its first and last edge are neighbours only (a closed yarn).
  struct Curve {
    std::vector<dvec3> points;  ///< metres
    double radius = 0;          ///< metres
    bool ghost_ends = false;
  };
  explicit PlySurface(std::vector<Curve> curves);

  /// Distance of a place from the nearest surface, in radii of that ply.
  double radii_from(const dvec3& place) const;

  /// Within kEndRadii of an open end. Where a yarn is cut follows its segments, so that ends lie elsewhere when curves
  /// have others.
  bool near_open_end(const dvec3& place) const;
  static constexpr double kEndRadii = 10;

 private:
  struct Segment {
    dvec3 start, end;
    dvec3 start_plane, end_plane;  ///< normals of the planes that end it, along it
    double radius;
  };
  double radii_from(const dvec3& place, const Segment& s, bool joints) const;
  double among(const dvec3& place, std::span<const int> numbers) const;

  std::vector<Segment> segments_;
  std::vector<dvec3> ends_;
  double end_reach_ = 0;  ///< metres
  std::optional<NearPoints> middles_, near_ends_;
};

/// The plies of a world as the device warps them; nothing where a fabric is held as a lattice, or there is none.
std::optional<PlySurface> ply_surface_of(const Device& device, const World& world);

}  // namespace wale::cost
