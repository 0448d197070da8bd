// How yarns of the flat knit take the shape that their tile has under the strain of the cloth.
#include <algorithm>

#include "geom/double_reflection.h"
#include "geom/ply_frames.h"
#include "geom/yarn_cut.h"

namespace wale {
namespace {

/// The least rotation that takes one unit vector to another: v + 2 (a.v) b - (a+b).v / (1 + a.b) (a+b).
class LeastRotation {
 public:
  LeastRotation(const dvec3& from, const dvec3& to)
      : from_(from), to_(to), sum_(from + to), none_(from == to || glm::dot(sum_, sum_) < 1e-6) {}
  bool none() const { return none_; }
  dvec3 operator()(const dvec3& v) const {
    return v + 2 * glm::dot(from_, v) * to_ - glm::dot(sum_, v) / (0.5 * glm::dot(sum_, sum_)) * sum_;
  }

 private:
  dvec3 from_, to_, sum_;
  bool none_;  ///< nothing to turn, or a reversal, which has no least rotation
};

dvec3 square_to(const dvec3& normal, const dvec3& tangent) {
  const dvec3 square = normal - glm::dot(normal, tangent) * tangent;
  const double length = glm::length(square);
  return length > 1e-3 ? square / length : any_normal(tangent);
}

}  // namespace

void StrainReport::add(const StrainReport& other) {
  if (other.samples == 0) return;
  least = samples ? glm::min(least, other.least) : other.least;
  most = samples ? glm::max(most, other.most) : other.most;
  samples += other.samples;
  clamped += other.clamped;
}

/// Offsets of the axis at a yarn's own samples. Samples that are cut off, whose cloth is not there, take the strain of
/// the nearest ones before (or else behind) that are not, so that tangents at the cuts have two neighbours.
void YarnCutter::find_shifts(const FlatYarn& yarn) {
  const size_t total = yarn.centre.size();
  const size_t first = yarn.closed ? 1 : 0, end = yarn.closed ? total - 2 : total;
  shift_.assign(total, dvec3(0));
  const auto shift = [&](size_t k, const StrainWeights& weights) {
    for (size_t i = 0; i < weights.node.size(); ++i)
      if (weights.weight[i] != 0) shift_[k] += weights.weight[i] * yarn.strained[k][weights.node[i]];
  };
  const auto kept = [&](size_t k) { return samples_[k].kept; };
  size_t from = first;
  while (from < end && !kept(from)) ++from;
  if (from == end) return;
  StrainWeights weights;
  for (size_t k = from; k < end; ++k) {
    if (kept(k)) {
      const dvec2 strain = field_->at(samples_[k].at);
      weights = strain_weights(*strains_, strain);
      out_.strain.add({1, weights.clamped, strain, strain});
      if (k == from)
        for (size_t before = first; before < from; ++before) shift(before, weights);
    }
    shift(k, weights);
  }
}

/// Moves the axis, carries the section of the yarn and the frames of its plies along by the least rotation of the axis,
/// and squares the frames to the new plies. All of it is local: rest length, twist phase and azimuth stay what they are
/// without strain, whatever the strain of other places.
void YarnCutter::follow_strain(FlatYarn& yarn) {
  find_shifts(yarn);
  if (std::all_of(shift_.begin(), shift_.end(), [](const dvec3& s) { return s == dvec3(0); })) return;
  const size_t total = yarn.centre.size(), plies = static_cast<size_t>(fabric_.plies);
  const size_t first = yarn.closed ? 1 : 0, end = yarn.closed ? total - 2 : total;
  if (yarn.closed) {
    shift_[0] = shift_[total - 3];
    shift_[total - 2] = shift_[1];
    shift_[total - 1] = shift_[2];
  }
  tangent_.resize(total);
  strained_tangent_.resize(total);
  mean_tangents(yarn.centre.data(), total, tangent_.data());
  unstrained_ = yarn.centre;
  for (size_t k = 0; k < total; ++k) yarn.centre[k] += shift_[k];
  mean_tangents(yarn.centre.data(), total, strained_tangent_.data());
  if (yarn.closed)  // ghosts turn as the samples that they repeat
    for (std::vector<dvec3>* t : {&tangent_, &strained_tangent_}) {
      (*t)[0] = (*t)[total - 3];
      (*t)[total - 2] = (*t)[1];
      (*t)[total - 1] = (*t)[2];
    }
  for (size_t k = 0; k < total; ++k) {
    const LeastRotation turn(tangent_[k], strained_tangent_[k]);
    for (size_t at = k; at < plies * total; at += total) {
      if (turn.none()) {
        yarn.position[at] += shift_[k];
      } else {
        yarn.position[at] = yarn.centre[k] + turn(yarn.position[at] - unstrained_[k]);
        yarn.normal[at] = turn(yarn.normal[at]);
      }
    }
  }
  for (size_t begin = 0; begin < plies * total; begin += total) {
    dvec3 *normal = &yarn.normal[begin], *tangent = &yarn.tangent[begin];
    mean_tangents(&yarn.position[begin], total, strained_tangent_.data());
    for (size_t k = first; k < end; ++k)
      if (strained_tangent_[k] != tangent[k]) normal[k] = square_to(normal[k], strained_tangent_[k]);
    std::copy(strained_tangent_.begin(), strained_tangent_.end(), tangent);
    if (!yarn.closed) continue;
    normal[0] = normal[total - 3];
    normal[total - 2] = normal[1];
    normal[total - 1] = normal[2];
  }
}

}  // namespace wale
