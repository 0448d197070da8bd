#include "geom/flyaways.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "geom/error.h"
#include "sampling/hash.clh"

namespace wale {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr size_t kFewest = 4, kMost = 256;  ///< segments of one flyaway

/// Zhao et al. 2016, Table 2, Cotton 1: mean and standard deviation, over the ply radius 0.023 (the mean of e_X and
/// e_Y).
struct Spread {
  double mean, deviation;
};
constexpr double kPly = 0.023;
constexpr Spread kHairStart{0.020 / kPly, 0.006 / kPly}, kHairOut{0.016 / kPly, 0.009 / kPly};
constexpr Spread kHairAlong{-0.003 / kPly, 0.057 / kPly}, kHairRound{0.377, 0.326};
constexpr Spread kLoopTop{0.024 / kPly, 0.005 / kPly};
constexpr double kHairLength = 2.2;  ///< ply radii: mean length of the hairs that these numbers make
constexpr double kWave = 0.05;       ///< of a long hair, share of its length
constexpr double kLoopFoot = 0.8;    ///< ply radii: where a loop leaves the bundle
constexpr double kLongestLoop = 16;  ///< ply radii

/// Random numbers of one flyaway.
class Draw {
 public:
  explicit Draw(uint32_t key) : key_(key) {}
  double uniform() { return double(w_hash_uniform(w_hash2(key_, count_++))) + 0x1p-25; }
  double normal(const Spread& s) {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return s.mean + s.deviation * radius * std::cos(kTwoPi * uniform());
  }

 private:
  uint32_t key_, count_ = 0;
};

/// The ply's axis between its samples: cubic through positions and tangents, frames turned linearly.
class Axis {
 public:
  explicit Axis(const PlyPiece& piece) : piece_(piece) {}

  size_t sample_at(double s) const {
    const auto& l = piece_.length;
    const auto after = std::upper_bound(l.begin() + 1, l.end() - 1, s);
    return size_t(after - l.begin()) - 1;
  }

  void at(double s, dvec3& position, dvec3& tangent, dvec3& normal) const {
    const size_t i = sample_at(s);
    const double h = piece_.length[i + 1] - piece_.length[i];
    const double u = h > 0 ? std::clamp((s - piece_.length[i]) / h, 0.0, 1.0) : 0, v = 1 - u;
    const dvec3 &p = piece_.position[i], &q = piece_.position[i + 1];
    const dvec3 a = h * piece_.tangent[i], b = h * piece_.tangent[i + 1];
    position = v * v * (1 + 2 * u) * p + u * u * (3 - 2 * u) * q + u * v * v * a - u * u * v * b;
    tangent = glm::normalize(v * piece_.tangent[i] + u * piece_.tangent[i + 1]);
    normal = v * piece_.normal[i] + u * piece_.normal[i + 1];
    normal = glm::normalize(normal - glm::dot(normal, tangent) * tangent);
  }

 private:
  const PlyPiece& piece_;
};

using Curve = std::function<dvec3(double)>;  // of u in [0, 1]

/// Evenly in u, as many segments as keep the sagitta |x''| / (8 n^2) within the tolerance.
std::vector<dvec3> sampled(const Curve& curve, double tolerance) {
  constexpr int kProbe = 32;
  double bend = 0;
  for (int i = 1; i < kProbe; ++i) {
    const dvec3 a = curve(double(i - 1) / kProbe), b = curve(double(i) / kProbe), c = curve(double(i + 1) / kProbe);
    bend = std::max(bend, glm::length(a - 2.0 * b + c) * kProbe * kProbe);
  }
  const auto count =
      static_cast<size_t>(std::clamp(std::ceil(std::sqrt(bend / (8 * tolerance))), double(kFewest), double(kMost)));
  std::vector<dvec3> points;
  for (size_t i = 0; i <= count; ++i) points.push_back(curve(double(i) / double(count)));
  return points;
}

Curve hair(const PlyPiece& piece, const Axis& axis, double s, double scale, Draw& draw) {
  dvec3 p, t, n;
  axis.at(s, p, t, n);
  const dvec3 b = glm::cross(t, n);
  const double r = piece.radius, start = r * std::clamp(draw.normal(kHairStart), 0.2, 1.0);
  const double out = r * scale * std::max(0.1, draw.normal(kHairOut)), along = r * scale * draw.normal(kHairAlong);
  const double from = kTwoPi * draw.uniform(), round = draw.normal(kHairRound);
  const double size = std::hypot(out, along), wave = scale > 1 ? kWave * size * (1 - 1 / scale) : 0;
  const double turns = 1 + draw.uniform(), phase = kTwoPi * draw.uniform();
  return [=](double u) {
    const double radius = start + out * u, angle = from + round * u;
    // The wave begins straight, so that the root stays in the ply.
    const double w = wave * u * u, bend = kTwoPi * turns * u + phase;
    return p + (along * u + w * std::sin(bend)) * t + radius * (std::cos(angle) * n + std::sin(angle) * b) +
           w * std::cos(bend) * (std::cos(angle) * b - std::sin(angle) * n);
  };
}

/// Metres of ply under a loop: one swing of a migrating fibre.
double loop_span(const PlyPiece& piece) {
  const double swings = std::abs(piece.twist) * piece.migrations / (kTwoPi * piece.radius);  // per metre
  return std::min(swings > 0 ? 1 / swings : 1e9, kLongestLoop * piece.radius);
}

/// Shifted along the ply where it would pass the piece's end: it ends where the cloth does.
Curve loop(const PlyPiece& piece, const Axis& axis, double s, Draw& draw) {
  const double r = piece.radius, begin = piece.length.front(), end = piece.length.back();
  const double span = std::min(loop_span(piece), end - begin);
  const double first = std::clamp(s - 0.5 * span, begin, end - span);
  const double foot = kLoopFoot * r, top = r * std::max(1.0, draw.normal(kLoopTop));
  const double from = kTwoPi * draw.uniform(), turn = piece.twist / r * span;
  return [=, &axis](double u) {
    dvec3 p, t, n;
    axis.at(first + span * u, p, t, n);
    const double radius = foot + (top - foot) * 0.5 * (1 - std::cos(kTwoPi * u)), angle = from + turn * u;
    return p + radius * (std::cos(angle) * n + std::sin(angle) * glm::cross(t, n));
  };
}

/// Calls put(s, key) for the roots that lie in the piece.
void place(const PlyPiece& piece, double density, uint32_t kind, const std::function<void(double, uint32_t)>& put) {
  if (!(density > 0)) return;
  const double in_lap = piece.lap > 0 ? std::round(density * piece.lap) : 0;
  if (piece.lap > 0 && in_lap < 1) return;
  const double step = piece.lap > 0 ? piece.lap / in_lap : 1 / density;
  const double begin = piece.length.front(), end = piece.length.back();
  for (auto j = int64_t(std::floor(begin / step)); double(j) * step < end; ++j) {
    const int64_t own = piece.lap > 0 ? ((j % int64_t(in_lap)) + int64_t(in_lap)) % int64_t(in_lap) : j;
    const uint32_t key = w_hash2(w_hash2(piece.key, kind), uint32_t(own));
    const double s = (double(j) + double(w_hash_uniform(key))) * step;
    if (s >= begin && s < end) put(s, key);
  }
}

}  // namespace

std::vector<Flyaway> make_flyaways(const PlyPiece& piece, const FlyawaySpec& spec, double tolerance) {
  std::vector<Flyaway> out;
  const Axis axis(piece);
  const double scale = spec.length > 0 ? spec.length / (kHairLength * piece.radius) : 1;
  place(piece, spec.hairs, 0, [&](double s, uint32_t key) {
    Draw draw(key);
    out.push_back({axis.sample_at(s), sampled(hair(piece, axis, s, scale, draw), tolerance)});
  });
  place(piece, spec.loops, 1, [&](double s, uint32_t key) {
    Draw draw(key);
    out.push_back({axis.sample_at(s), sampled(loop(piece, axis, s, draw), tolerance)});
  });
  return out;
}

void check_flyaways(const FlyawaySpec& spec, const char* fabric) {
  const auto check = [&](double value, double most, const char* what) {
    if (!(value >= 0 && value <= most))
      user_error("fabric '{}': flyaways: {} is {}; give 0 to {}", fabric, what, value, most);
  };
  check(spec.hairs, 1e6, "hairs per metre");
  check(spec.loops, 1e6, "loops per metre");
  check(spec.length, kLongestFlyaway, "length in metres");
  check(spec.radius, kThickestFlyaway, "radius in metres");
}

double flyaway_segments_per_metre(const FlyawaySpec& spec, const PlyPiece& piece, double tolerance) {
  const double r = piece.radius;
  const auto segments = [&](double bend) {
    return std::clamp(std::sqrt(bend / (8 * tolerance)), double(kFewest), double(kMost));
  };
  // |x''| as in hair(): an arc of the mean turn, and the wave of a long hair.
  const double length = spec.length > 0 ? spec.length : kHairLength * r;
  const double wave = length > kHairLength * r ? kWave * 12 * length * kTwoPi : 0;
  // ... and in loop(): its winding, and the bends of knitted plies, about a third of 1/r where they are sharpest.
  const double span = loop_span(piece), turn = piece.twist * span / r;
  return spec.hairs * segments(0.3 * length + wave) + spec.loops * segments(r * turn * turn + 0.3 * span * span / r);
}

}  // namespace wale
