#include "geom/stored_length.h"

#include <algorithm>
#include <cmath>

#include "appearance/fibre_phase.clh"
#include "sampling/hash.clh"
#include "shared/wale_types.h"

namespace wale {

float StoredLength::at(double s) const {
  const double l = unwrapped(s);
  const float wrapped = static_cast<float>(l - period * std::floor(l / period));
  return wrapped < static_cast<float>(period) ? wrapped : 0.0f;  // rounding may reach the period itself
}

StoredLength stored_length(uint32_t yarn, uint32_t ply, double ply_radius, double twist, double lap) {
  StoredLength length;
  length.period = double(W_LENGTH_PERIOD) * double(float(ply_radius));  // the kernels' radius is a float
  length.start = double(w_hash_uniform(w_hash2(yarn, ply))) * length.period;
  const double turns = double(w_turns_per_period(float(twist)));  // in one period
  if (lap > 0 && turns != 0) {
    const double in_lap = lap * std::abs(turns) / length.period;
    length.stretch = std::max(1.0, std::round(in_lap)) / in_lap;
  }
  return length;
}

double length_between(float from, float to, double ply_radius) {
  return double(to) - double(from) + (to < from ? double(W_LENGTH_PERIOD) * double(float(ply_radius)) : 0.0);
}

}  // namespace wale
