#pragma once
// Plies made in closed form, their device form, and a tracer for lists of rays.
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "host/ply_tree.h"
#include "tests/kernels/brute_force.h"

namespace wale::test {

/// Vertices and patches.
struct Strands {
  std::vector<float> positions;  ///< x, y, z a vertex
  std::vector<float> frames;     ///< W_FRAME_WORDS a vertex
  std::vector<PlyPatch> patches;
  float tau = -1;
  uint32_t next_cell = 0;

  /// Adds one run of `plies` polylines of `count` vertices; position(ply, i). Frame normals: transported from any first
  /// one by minimal rotations. Lengths are the polylines' own. Each patch is a cell of its own, or `patches_per_cell`.
  void add(uint32_t plies, uint32_t count, float radius, const std::function<dvec3(uint32_t, uint32_t)>& position,
           bool ghosts = false, uint32_t patches_per_cell = 3);
  size_t segments() const;
};

/// A helix about z: bend per joint and length per radius set by the steps.
Strands helix(uint32_t steps_per_turn, uint32_t turns, double helix_radius, double pitch, float radius);
/// Short random polylines in a cube of the given size; some bends are tight and some segments short.
Strands random_strands(uint32_t strands, uint32_t count, double step, double cube, float radius, uint32_t seed);
/// Stockinette of 3-ply loops (x = t + 1.5 sin 2t, y = 4 cos t, z = cos 2t) bent on a cylinder.
Strands stockinette(uint32_t rows, uint32_t loops, uint32_t steps_per_loop, double scale = 0.01,
                    double bend_radius = 40);

/// The device of all tests of this program: one context, so that programs are compiled once.
const Device& test_device();

/// A hit as the float build or the double build of the kernels writes it.
template <typename Real>
struct HitOf {
  Real t;
  uint32_t kind, code;
  Real u, v;
  uint32_t occluded;
};
using Hit = HitOf<float>;

/// What w_ply_surface says about a hit.
template <typename Real>
struct SurfaceOf {
  Real anchor[3], x[3], n[3], t[3], smooth_n[3], smooth_t[3];
  Real phi, u, length, radius, h;
  uint32_t segment;
};
using Surface = SurfaceOf<float>;

/// Strands on the device, traced with given build options.
class Tracer {
 public:
  Tracer(const Device& device, const Strands& strands, LeafForm form = {});
  /// With -DW_SIMT in `options`, down the quantised nodes.
  std::vector<Hit> trace(const std::vector<Ray>& rays, const std::string& options);
  /// Nearest hits of packets of 16 rays in the order given; `occluded` is left 0.
  std::vector<Hit> trace_packets(const std::vector<Ray>& rays);
  /// The same source built with double arithmetic: the device must have fp64.
  std::vector<HitOf<double>> trace_in_double(const std::vector<Ray>& rays);
  /// CPU seconds, of all threads, of one launch of kernel `closest`, `closest_packets` or `occluded` over the rays,
  /// without copies. `wall`: receives seconds by the clock on the wall.
  double time(const std::vector<Ray>& rays, const std::string& options, const std::string& kernel,
              double* wall = nullptr);
  std::vector<Surface> surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                                const std::string& options = "-DW_LANES=16");
  std::vector<SurfaceOf<double>> surfaces_in_double(const std::vector<Ray>& rays,
                                                    const std::vector<HitOf<double>>& hits);
  /// Id of the segment behind a hit code.
  uint32_t segment(uint32_t code) const;
  /// The device's counters of rare events (W_EVENT_*), and of visits (W_VISIT_*) where options had -DW_COUNT_VISITS,
  /// since the tracer was made.
  std::vector<uint32_t> events() const;
  uint32_t stack_overflows() const { return events()[W_EVENT_STACK_FULL]; }
  const QuantisedTree& quantised() const { return quantised_; }
  const PlyTree& tree() const { return tree_; }

 private:
  // All but the kernel's own arguments, which start at 6.
  cl::Kernel bound(const std::string& options, const char* name, const Buffer<Ray>& rays) const;
  template <typename Real>
  std::vector<HitOf<Real>> trace_as(const std::vector<Ray>& rays, const std::string& options,
                                    const char* kernel = "trace", size_t rays_per_item = 1);
  template <typename Real>
  std::vector<SurfaceOf<Real>> surfaces_as(const std::vector<Ray>& rays, const std::vector<HitOf<Real>>& hits,
                                           const std::string& options);

  const Device& device_;
  Buffer<float> frames_;
  PlyTree tree_;
  QuantisedTree quantised_;
  std::vector<uint32_t> leaves_;
  Buffer<uint32_t> counters_;
};

Ray make_ray(dvec3 origin, dvec3 direction, uint32_t key);
/// Rays from points of a far sphere round the bounds towards points inside them.
std::vector<Ray> primary_rays(const Box& bounds, size_t count, uint32_t seed);
/// Rays that leave the hits of `rays` into the outer hemisphere, as a renderer would start them.
std::vector<Ray> bounce_rays(const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                             const std::vector<Surface>& surfaces, uint32_t seed);

}  // namespace wale::test
