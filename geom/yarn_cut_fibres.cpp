// What YarnCutter does with single fibres: those of a ply's section, and those that stand off it.
#include <cmath>

#include "geom/double_reflection.h"
#include "geom/ply_frames.h"
#include "geom/yarn_cut.h"
#include "sampling/hash.clh"

namespace wale {
namespace {

dvec3 unit_or(const dvec3& v, const dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

/// Unit normals along a polyline by double reflection.
std::vector<dvec3> frames(const std::vector<dvec3>& p) {
  std::vector<dvec3> tangent, normal;
  for (size_t i = 0; i < p.size(); ++i) {
    const dvec3 before = i > 0 ? unit_or(p[i] - p[i - 1], dvec3(1, 0, 0)) : dvec3(0);
    const dvec3 after = i + 1 < p.size() ? unit_or(p[i + 1] - p[i], before) : dvec3(0);
    tangent.push_back(unit_or(before + after, dvec3(1, 0, 0)));
    normal.push_back(i == 0 ? any_normal(tangent[0])
                            : double_reflection(normal[i - 1], p[i - 1], tangent[i - 1], p[i], tangent[i]));
  }
  return normal;
}

}  // namespace

void YarnCutter::add_fibre_runs(const FlatYarn& yarn, const Stretch& stretch) {
  const size_t total = yarn.centre.size(), plies = static_cast<size_t>(fabric_.plies);
  for (size_t p = 0; p < plies; ++p) {
    double lap = 0;
    const StoredLength stored = length_of(yarn, p, lap);
    const double migration = bundle_->migration_per_metre(stored.stretch * lap);
    for (size_t g = 0; g + 1 < fibre_groups_.size(); ++g) {
      begin_run(stretch, PlyRun::Kind::fibre, fibre_groups_[g + 1] - fibre_groups_[g], bundle_->fibre_radius());
      out_.runs.back().ply = static_cast<uint32_t>(p);
      for (size_t f = fibre_groups_[g]; f < fibre_groups_[g + 1]; ++f)
        for (size_t i = 0; i < stretch.count; ++i) {
          const Place place = place_in(yarn, stretch.begin + i);
          const size_t vertex = p * total + place.k;
          const double s = yarn.length[vertex];
          const dvec2 at = bundle_->offset(fibre_order_[f], stored.unwrapped(s), migration);
          const dvec3 normal = yarn.normal[vertex], side = glm::cross(ply_tangent(yarn, p, place.k), normal);
          add_vertex(place, yarn.position[vertex] + at.x * normal + at.y * side, normal,
                     stored.at(s + place.laps * lap));
        }
    }
  }
}

void YarnCutter::add_flyaways(const FlatYarn& yarn, const Stretch& stretch) {
  const size_t total = yarn.centre.size();
  const dvec3 lap_shift = yarn.closed ? yarn.centre[total - 2] - yarn.centre[1] : dvec3(0);
  // The ghosts of a closed yarn repeat what is there already.
  const size_t begin = stretch.begin + stretch.ghost_ends, end = stretch.begin + stretch.count - stretch.ghost_ends;
  for (size_t p = 0; p < static_cast<size_t>(fabric_.plies); ++p) {
    PlyPiece piece;
    const StoredLength stored = length_of(yarn, p, piece.lap);
    piece.radius = fabric_.ply_radius;
    piece.twist = spec_.fibres.twist;
    piece.migrations = spec_.fibres.migration_rate;
    piece.key = w_hash2(yarn_number(), static_cast<uint32_t>(p));
    std::vector<Place> places;
    for (size_t i = begin; i < end; ++i) {
      const Place place = place_in(yarn, i);
      const size_t vertex = p * total + place.k;
      places.push_back(place);
      piece.position.push_back(yarn.position[vertex] + place.laps * lap_shift);
      piece.normal.push_back(yarn.normal[vertex]);
      piece.tangent.push_back(ply_tangent(yarn, p, place.k));
      piece.length.push_back(yarn.length[vertex] + place.laps * piece.lap);
    }
    for (Flyaway& flyaway : make_flyaways(piece, spec_.flyaways, kFibreTolerance * flyaway_radius_)) {
      const Place& root = places[flyaway.sample];
      auto& points = flyaway.points;
      for (dvec3& x : points) x -= root.laps * lap_shift;
      size_t count = 2;  // the root stays; the rest ends where the cloth ends
      for (ChartPoint at; count < points.size(); ++count)
        if (!locator_.locate(map_.uv_per_metre * dvec2(points[count]), map_.half_stitch, map_.metric, at)) break;
      points.resize(count);
      const std::vector<dvec3> normal = frames(points);
      begin_run({0, count, false}, PlyRun::Kind::fibre, 1, flyaway_radius_);
      PlyRun& run = out_.runs.back();
      run.ply = static_cast<uint32_t>(p);
      run.first_place += static_cast<uint32_t>(flyaway.sample + stretch.ghost_ends);
      run.one_place = true;
      double s = piece.length[flyaway.sample];
      for (size_t i = 0; i < count; ++i) {
        if (i > 0) s += glm::distance(points[i - 1], points[i]);
        add_vertex(root, points[i], normal[i], stored.at(s));
      }
      ++out_.flyaways;
    }
  }
}

}  // namespace wale
