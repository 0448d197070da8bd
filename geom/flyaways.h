#pragma once
#include <cstdint>
#include <vector>

#include "geom/vec.h"

namespace wale {

/// Fibres that stand off a ply: hairs with one free end, loops with both ends in the ply.
constexpr double kLongestFlyaway = 0.1, kThickestFlyaway = 0.01;  ///< metres

struct FlyawaySpec {
  double hairs = 0, loops = 0;  ///< per metre of ply
  double length = 0;            ///< metres: mean length of a hair; 0 = as measured (Zhao et al. 2016)
  double radius = 0;            ///< metres; 0 = that of the ply's fibres

  bool any() const { return hairs > 0 || loops > 0; }

  bool operator==(const FlyawaySpec&) const = default;
};

/// A piece of a ply: at least two samples of its axis, in order. Lengths in metres from the start of the full ply.
struct PlyPiece {
  std::vector<dvec3> position, normal, tangent;  ///< frame: unit, square to each other
  std::vector<double> length;
  double lap = 0;         ///< length of one lap of a closed ply, 0 when open
  double radius = 0;      ///< of the ply, metres
  double twist = 0;       ///< of its fibres (FibreRecipe::twist)
  double migrations = 0;  ///< per turn of the bundle (FibreRecipe::migration_rate)
  uint32_t key = 0;       ///< hash of full yarn and ply: decides every random number
};

struct Flyaway {
  size_t sample = 0;  ///< of the piece: the last one before its root
  std::vector<dvec3> points;
};

/// Flyaways of a piece, hairs before loops, density * length of each kind to within one at either end: one in every
/// stretch of 1/density, at a hashed place in it, so that a ply has the same ones however it is cut.
///   Hair: r = r0 + dr u, azimuth = a0 + da u, z = dz u for u in [0, 1] about the ply's axis at the root; loop: one
///   swing of a migrating fibre that reaches a larger radius (Zhao, Luan, Bala 2016, section 4.4; numbers of Table 2,
///   Cotton 1, in units of the ply radius). Hairs longer than measured keep their directions and wave a little.
/// Polylines stay within `tolerance` (metres) of these curves.
std::vector<Flyaway> make_flyaways(const PlyPiece& piece, const FlyawaySpec& spec, double tolerance);

/// Throws a user error naming the fabric for densities and lengths out of range.
void check_flyaways(const FlyawaySpec& spec, const char* fabric);

/// Segments of all flyaways on a metre of ply, roughly: for size estimates. `piece` needs no samples.
double flyaway_segments_per_metre(const FlyawaySpec& spec, const PlyPiece& piece, double tolerance);

}  // namespace wale
