#pragma once
#include <cstdint>

namespace wale {

/// The rest length that a ply's vertices carry (Anchor::length): stretch * s + start, wrapped into [0, period), s in
/// metres from the start of the full ply. Computed in double: a float keeps the phase of its fibres on any length.
struct StoredLength {
  double period = 0;   ///< metres: W_LENGTH_PERIOD ply radii
  double start = 0;    ///< metres; a hash of yarn and ply, so that neighbours do not look alike
  double stretch = 1;  ///< not 1 on closed plies alone: whole turns of the fibres in one lap

  double unwrapped(double s) const { return start + stretch * s; }
  float at(double s) const;
};

/// Of ply `ply` of full yarn `yarn`. `twist`: of its fibres (FibreRecipe::twist); `lap`: metres of one lap of a closed
/// ply, 0 when it is open.
StoredLength stored_length(uint32_t yarn, uint32_t ply, double ply_radius, double twist, double lap);

/// Metres from one vertex of a ply to a later one less than a period ahead, from the lengths that they carry.
double length_between(float from, float to, double ply_radius);

}  // namespace wale
