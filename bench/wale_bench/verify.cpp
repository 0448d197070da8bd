#include "bench/wale_bench/verify.h"

#include <sys/types.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/film_device.h"
#include "host/scene_device.h"
#include "sampling/dimensions.clh"
#include "tests/kernels/brute_force.h"

namespace wale::bench {
namespace {

constexpr double kSameDistance = 1e-2;  // ply radii, or
constexpr double kSameRelative = 1e-6;  // of the distance

// The ray's line comes near the vertices of a patch and of the segments beside it. Mitres reach no farther than a
// segment's own length.
bool near_patch(const PlyPatch& patch, const std::vector<float>& positions, const std::vector<CheckedRay>& rays) {
  dvec3 lo(1e300), hi(-1e300);
  const uint32_t first = patch.first > 0 ? patch.first - 1 : 0;
  const uint32_t last = std::min(patch.first + patch.intervals + 1, patch.count - 1);
  for (uint32_t p = 0; p < patch.plies; ++p)
    for (uint32_t k = first; k <= last; ++k) {
      const float* v = &positions[(size_t(patch.first_vertex) + size_t(p) * patch.count + k) * 3];
      lo = glm::min(lo, dvec3(v[0], v[1], v[2]));
      hi = glm::max(hi, dvec3(v[0], v[1], v[2]));
    }
  const dvec3 centre = 0.5 * (lo + hi);
  const double reach = 0.5 * glm::length(hi - lo) + 4.0 * patch.radius;
  return std::any_of(rays.begin(), rays.end(), [&](const CheckedRay& r) {
    const dvec3 d(r.ray.d[0], r.ray.d[1], r.ray.d[2]);
    const dvec3 w(centre.x - r.ray.o[0] - r.ray.l[0], centre.y - r.ray.o[1] - r.ray.l[1],
                  centre.z - r.ray.o[2] - r.ray.l[2]);
    const dvec3 off = w - glm::dot(w, d) / glm::dot(d, d) * d;
    return glm::dot(off, off) <= reach * reach;
  });
}

// The oracle's segment, or its neighbour where the ray enters through their joint.
bool same_place(const test::BruteForce& brute, uint32_t segment, uint32_t other) {
  const long a = brute.index_of(segment), b = brute.index_of(other);
  return segment == other || (a >= 0 && b >= 0 && (brute.before(size_t(a)) == b || brute.after(size_t(a)) == b));
}

}  // namespace

Oracle::Oracle(const Device& device, const World& world, const FabricDevice& fabric, bool opaque)
    : fabric_(fabric),
      props_(world.triangle_count() > 0 || !world.spheres.empty()),
      positions_(FabricWarp(device, fabric_inputs(world), world.origin).points().read(device)) {
  for (uint32_t f = 0; f < world.fabrics.size(); ++f)
    for (const Patch& p : world.fabrics[f].patches) {
      const PlyRun& run = world.fabrics[f].runs[p.run];
      const bool dense = opaque || run.kind == PlyRun::Kind::fibre;
      const float tau = dense ? -1.0f : world.ply_materials[world.fabric_material[f]].tau_e;
      patches_.push_back({fabric.first_vertex[f] + run.first_vertex, run.count, p.first, p.intervals, run.plies, p.cell,
                          f, 0, 0, run.radius, tau, run.ghost_ends});
    }
}

uint32_t Oracle::segment(uint32_t code) const {
  const auto& offsets = fabric_.tree.leaf_offset;  // ascending
  const auto leaf = std::upper_bound(offsets.begin(), offsets.end(), code >> 4) - offsets.begin() - 1;
  const PlyPatch& patch = patches_[size_t(std::max<std::ptrdiff_t>(leaf, 0))];
  const uint32_t lane = code & 15u;
  return patch.first_vertex + lane % patch.plies * patch.count + patch.first + lane / patch.plies;
}

std::vector<CheckedRay> Oracle::sample(const RayBatch& batch, const std::vector<w_float4>& found, size_t count) const {
  std::vector<CheckedRay> rays;
  const size_t step = std::max<size_t>(1, batch.slots.size() / std::max<size_t>(1, count));
  for (size_t i = step / 2; i < batch.slots.size(); i += step) {
    CheckedRay c;
    const w_float4 &o = batch.o[i], &l = batch.l[i], &d = batch.d[i];
    c.ray = {{o.x, o.y, o.z}, {l.x, l.y, l.z}, {d.x, d.y, d.z}, 1e30f, 0, W_NONE, W_NONE, 0};
    c.shadow = batch.kind == RayKind::shadow;
    if (c.shadow) c.ray.tmax = d.w;
    const uint32_t slot = batch.slots[i], samples = batch.frame.samples_in_wave;
    const uint32_t pixel = slot / samples;
    const uint32_t place = batch.tiles[pixel / kTilePixels] * kTilePixels + pixel % kTilePixels;
    const uint32_t sample = batch.frame.samples_before + slot % samples;
    c.ray.key = c.shadow ? w_shadow_key(place, sample, batch.depth, batch.frame.seed, batch.frame.opaque_shadows)
                         : w_ray_key(place, sample, batch.depth, W_RAY_PATH, batch.frame.seed);
    if (const auto skip = std::bit_cast<uint32_t>(l.w); skip != W_NONE) c.skip = long(segment(skip));
    if (c.shadow) {
      c.blocked = !(found[i].x > 0);
    } else {
      c.t = found[i].x;
      c.kind = std::bit_cast<uint32_t>(found[i].y);
      if (c.kind == W_HIT_PLY) c.segment = segment(std::bit_cast<uint32_t>(found[i].z));
    }
    rays.push_back(c);
  }
  return rays;
}

Agreement Oracle::check(const std::vector<CheckedRay>& rays) const {
  std::vector<PlyPatch> close;
  for (const PlyPatch& patch : patches_)
    if (near_patch(patch, positions_, rays)) close.push_back(patch);
  const test::BruteForce brute(close, positions_);
  Agreement out;
  for (const CheckedRay& c : rays) {
    const test::OracleHit truth = brute.closest(c.ray, c.skip);
    bool same;
    if (c.shadow) {
      if (props_ && c.blocked && !truth.hit) continue;  // by a prop, which the oracle does not know
      same = c.blocked == truth.hit;
    } else if (c.kind == W_HIT_PLY) {
      const double off = std::abs(truth.t - double(c.t));
      same = truth.hit && same_place(brute, truth.segment, c.segment) &&
             off <= std::max(kSameDistance * brute.segment(size_t(brute.index_of(truth.segment))).radius,
                             kSameRelative * truth.t);
    } else {
      same = !truth.hit || (c.kind != W_HIT_NONE && truth.t >= double(c.t) * (1 - kSameRelative));
    }
    ++out.checked;
    out.agree += same;
  }
  return out;
}

}  // namespace wale::bench
