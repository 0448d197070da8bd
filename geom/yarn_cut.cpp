#include "geom/yarn_cut.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh_edges.h"
#include "geom/stored_length.h"
#include "geom/warp.h"

namespace wale {
namespace {

/// A neighbour that lies this many times farther off in space than its own triangle's map says belongs to another part
/// of the chart that merely touches this one in UV. Creases and uneven UVs stay well below.
constexpr double kJump = 3;

}  // namespace

YarnCutter::YarnCutter(const YarnCutting& cutting, const ChartLocator& locator, const StrainField* field,
                       size_t first_yarn)
    : fabric_(cutting.fabric),
      chart_(cutting.chart),
      map_(cutting.map),
      spec_(cutting.spec),
      bundle_(cutting.bundle),
      flyaway_radius_(cutting.flyaway_radius),
      locator_(locator),
      strains_(cutting.strains),
      field_(field),
      first_yarn_(first_yarn) {
  if (bundle_) bundle_->groups(kFibreGroup, fibre_order_, fibre_groups_);
}

YarnCutter::Sample YarnCutter::locate_sample(dvec3 centre) const {
  Sample sample;
  sample.uv = map_.uv_per_metre * dvec2(centre);
  sample.kept = locator_.locate(sample.uv, map_.half_stitch, map_.metric, sample.at);
  if (sample.kept) sample.point = warp_point(fabric_.mesh, sample.at, 0);
  return sample;
}

ChartPoint YarnCutter::extrapolate(const Sample& from, dvec2 uv) const {
  const auto& t = fabric_.mesh.uv[from.at.triangle];
  const dvec2 e1 = t[1] - t[0], e2 = t[2] - t[0], d = uv - from.uv;
  const double det = uv_area2(t);
  ChartPoint point = from.at;
  point.b1 += (d.x * e2.y - d.y * e2.x) / det;
  point.b2 += (e1.x * d.y - e1.y * d.x) / det;
  return point;
}

bool YarnCutter::jumps(const Sample& a, const Sample& b) const {
  if (a.at.triangle == b.at.triangle) return false;
  const double forth = glm::length(warp_point(fabric_.mesh, extrapolate(a, b.uv), 0) - a.point);
  const double back = glm::length(warp_point(fabric_.mesh, extrapolate(b, a.uv), 0) - b.point);
  const double flat = glm::length((b.uv - a.uv) * map_.metric);
  return glm::length(b.point - a.point) > kJump * std::max({forth, back, flat});
}

void YarnCutter::add(FlatYarn& yarn) {
  color_ = static_cast<uint32_t>(yarn.color);
  const size_t total = yarn.centre.size();
  // A closed yarn's own samples are 1 .. K-3; 0, K-2 and K-1 repeat them.
  const size_t first = yarn.closed ? 1 : 0, count = yarn.closed ? total - 3 : total;
  samples_.resize(total);
  for (size_t k = first; k < first + count; ++k) samples_[k] = locate_sample(yarn.centre[k]);

  const auto own = [&](size_t i) -> Sample& { return samples_[first + i % count]; };
  lap_ = yarn.closed ? map_.uv_per_metre * dvec2(yarn.centre[total - 2] - yarn.centre[1]) : dvec2(0);
  bool whole = yarn.closed;
  size_t start = 0;  // where a closed yarn may be opened
  for (size_t i = 0; i < count; ++i) {
    Sample& here = own(i);
    const size_t before = i > 0 ? i - 1 : count - 1;
    if (i > 0 || yarn.closed) {
      Sample previous = own(before);
      if (i == 0) previous.uv -= lap_;
      here.cut_before = here.kept && previous.kept && jumps(previous, here);
      out_.jumps_cut += here.cut_before;
    }
    if (!here.kept || here.cut_before) {
      whole = false;
      start = i;
    }
    out_.samples_outside += !here.kept;
    out_.samples_extrapolated += here.kept && here.at.outside > 0;
  }
  // Where the cloth ends is decided on the unstrained yarn: which samples stay does not change while a cloth moves.
  if (field_) follow_strain(yarn);
  if (whole) {
    add_runs(yarn, {0, total, true});
    ++out_.yarns;
    return;
  }
  if (!yarn.closed) start = 0;
  for (size_t i = 0; i < count;) {
    if (!own(start + i).kept) {
      ++i;
      continue;
    }
    size_t end = i + 1;
    while (end < count && own(start + end).kept && !own(start + end).cut_before) ++end;
    if (end - i >= 2)
      add_runs(yarn, {first + start + i, end - i, false});
    else
      ++out_.samples_outside;  // a single sample makes no segment
    i = end;
  }
  ++out_.yarns;
}

void YarnCutter::add_runs(const FlatYarn& yarn, const Stretch& stretch) {
  first_place_ = static_cast<uint32_t>(out_.place.size());
  if (!yarn.place.empty()) add_places(yarn, stretch);
  if (spec_.detail == Detail::fibres)
    add_fibre_runs(yarn, stretch);
  else
    add_ply_run(yarn, stretch);
  if (spec_.flyaways.any()) add_flyaways(yarn, stretch);
}

YarnCutter::Place YarnCutter::place_in(const FlatYarn& yarn, size_t sample) {
  if (!yarn.closed) return {sample, 0};
  const auto period = static_cast<ptrdiff_t>(yarn.centre.size()) - 3, from_one = static_cast<ptrdiff_t>(sample) - 1;
  const double laps = std::floor(static_cast<double>(from_one) / static_cast<double>(period));
  return {static_cast<size_t>(from_one - static_cast<ptrdiff_t>(laps) * period) + 1, laps};
}

StoredLength YarnCutter::length_of(const FlatYarn& yarn, size_t ply, double& lap) const {
  const double* length = yarn.length.data() + ply * yarn.centre.size();
  lap = yarn.closed ? length[yarn.centre.size() - 2] - length[1] : 0;
  return stored_length(yarn_number(), static_cast<uint32_t>(ply), fabric_.ply_radius, spec_.fibres.twist, lap);
}

void YarnCutter::begin_run(const Stretch& stretch, PlyRun::Kind kind, size_t curves, double radius) {
  PlyRun run;
  run.first_vertex = static_cast<uint32_t>(out_.anchors.size());
  run.count = static_cast<uint32_t>(stretch.count);
  run.plies = static_cast<uint32_t>(curves);
  run.kind = kind;
  run.radius = static_cast<float>(radius);
  run.yarn = yarn_number();
  run.color = color_;
  run.chart = chart_;
  run.ghost_ends = stretch.ghost_ends;
  run.first_place = first_place_;
  out_.runs.push_back(run);
}

void YarnCutter::add_places(const FlatYarn& yarn, const Stretch& stretch) {
  const auto [begin, count, ghost_ends] = stretch;
  const size_t total = yarn.centre.size(), period = yarn.closed ? total - 3 : total;
  const double lap = yarn.closed ? yarn.place[total - 2].along - yarn.place[1].along : 0;
  const auto along = [&, begin = begin](size_t i) {  // a closed yarn's samples go round
    const size_t k = begin + i;
    return k < total ? yarn.place[k].along : yarn.place[(k - 1) % period + 1].along + lap * double((k - 1) / period);
  };
  const double start = along(ghost_ends ? 1 : 0), length = along(ghost_ends ? count - 2 : count - 1) - start;
  const bool back = !ghost_ends && yarn_number() % 2 == 1;
  for (size_t i = 0; i < count; ++i) {
    const size_t k = begin + i;
    YarnPlace place = yarn.place[k < total ? k : (k - 1) % period + 1];
    const dvec2 size = map_.stitch;
    for (int axis = 0; axis < 2; ++axis) {
      const int around = map_.rect.wrap[axis] * map_.stitches_per_tile[axis];
      if (around <= 0) continue;
      const int lo = map_.rect.lo[axis] * map_.stitches_per_tile[axis];
      const int canonical = lo + ((place.stitch[axis] - lo) % around + around) % around;
      place.middle[axis] += size[axis] * (canonical - place.stitch[axis]);
      place.stitch[axis] = canonical;
    }
    const dvec2 uv = map_.uv_per_metre * place.middle;
    const double done = along(i) - start;
    out_.place.push_back({float(strand_ + (back ? length - done : done)), place.stitch, float(uv.x), float(uv.y)});
  }
  strand_ += length;
}

void YarnCutter::add_vertex(const Place& place, const dvec3& position, const dvec3& normal, float length) {
  const dvec2 uv = map_.uv_per_metre * dvec2(position);
  Anchor anchor = anchor_of(position, normal, samples_[place.k], uv);
  anchor.length = length;
  out_.anchors.push_back(anchor);
  out_.uv.push_back(uv + place.laps * lap_);
}

// Ghosts take the very anchor of the sample they repeat, so that the ends meet to the last bit.
void YarnCutter::add_ply_run(const FlatYarn& yarn, const Stretch& stretch) {
  const size_t total = yarn.centre.size(), plies = static_cast<size_t>(fabric_.plies);
  begin_run(stretch, PlyRun::Kind::ply, plies, fabric_.ply_radius);
  for (size_t p = 0; p < plies; ++p) {
    double lap = 0;
    const StoredLength stored = length_of(yarn, p, lap);
    for (size_t i = 0; i < stretch.count; ++i) {
      const Place place = place_in(yarn, stretch.begin + i);
      const size_t vertex = p * total + place.k;
      add_vertex(place, yarn.position[vertex], yarn.normal[vertex], stored.at(yarn.length[vertex] + place.laps * lap));
    }
  }
}

Anchor YarnCutter::anchor_of(const dvec3& position, const dvec3& normal, const Sample& centre, dvec2 uv) const {
  const double reach = map_.half_stitch + 2 * fabric_.yarn_radius;
  ChartPoint at;
  if (!locator_.locate(uv, reach, map_.metric, at)) {
    at = extrapolate(centre, uv);
  } else if (at.triangle != centre.at.triangle) {
    const ChartPoint beside = extrapolate(centre, uv);
    const dvec3 guess = warp_point(fabric_.mesh, beside, 0), found = warp_point(fabric_.mesh, at, 0);
    const double offset = std::max(glm::length(guess - centre.point), glm::length((uv - centre.uv) * map_.metric));
    if (glm::length(found - guess) > kJump * offset) at = beside;
  }
  Anchor anchor;
  anchor.triangle = at.triangle;
  anchor.b1 = static_cast<float>(at.b1);
  anchor.b2 = static_cast<float>(at.b2);
  anchor.height = static_cast<float>(position.z + spec_.height_offset);
  anchor.nx = static_cast<float>(normal.x);
  anchor.ny = static_cast<float>(normal.y);
  anchor.nz = static_cast<float>(normal.z);
  return anchor;
}

}  // namespace wale
