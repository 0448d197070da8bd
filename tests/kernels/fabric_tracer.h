#pragma once
// Knitted fabrics on the device, traced with lists of rays by any of the three local stages.
#include "host/fabric_device.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {

/// The patches of one fabric as the device numbers them, made from the fabric alone.
std::vector<PlyPatch> patches_of(const Fabric& fabric, float tau);

class FabricTracer {
 public:
  /// `fabric` must outlive the tracer. The cell stages need a tree and lists of their own: `stage` says for which one
  /// the fabric is uploaded.
  FabricTracer(const Device& device, const Fabric& fabric, float tau = -1, LocalStage stage = LocalStage::exact,
               bool updatable = false, LeafForm form = {});
  /// Carries an updatable fabric on to a moved mesh: see update_fabrics().
  void move(std::span<const float> positions, std::span<const float> normals) {
    update_fabrics(device_, fabric_, positions, normals);
  }

  std::vector<Hit> trace(const std::vector<Ray>& rays) const;
  std::vector<Surface> surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits) const;
  /// The same source built with double arithmetic: the device must have fp64.
  std::vector<HitOf<double>> trace_in_double(const std::vector<Ray>& rays) const;
  std::vector<SurfaceOf<double>> surfaces_in_double(const std::vector<Ray>& rays,
                                                    const std::vector<HitOf<double>>& hits) const;
  /// Seconds that the device reports for one launch of the nearest-hit kernel, without copies.
  double seconds(const std::vector<Ray>& rays) const;
  /// CPU seconds, of all threads, of one launch of kernel `nearest` or `any_hit` over the rays, without copies.
  double cpu_seconds(const std::vector<Ray>& rays, const char* kernel) const;
  /// Id of the segment behind a hit code of a stored leaf: the vertex id of its start.
  uint32_t segment(uint32_t code) const;
  /// The device's counters of rare events (W_EVENT_*) since the tracer was made.
  std::vector<uint32_t> events() const;
  uint32_t stack_overflows() const { return events()[W_EVENT_STACK_FULL]; }
  const Box& bounds() const { return fabric_.tree.bounds; }
  const FabricDevice& fabric() const { return fabric_; }
  /// Where the vertices lie: x, y, z each.
  std::vector<float> positions() const;

 private:
  // *next: first argument of the kernel's own.
  cl::Kernel bound(const char* name, const Buffer<Ray>& rays, size_t count, bool twice, cl_uint* next) const;
  template <typename Real>
  std::vector<HitOf<Real>> trace_as(const std::vector<Ray>& rays) const;
  template <typename Real>
  std::vector<SurfaceOf<Real>> surfaces_as(const std::vector<Ray>& rays, const std::vector<HitOf<Real>>& hits) const;

  const Device& device_;
  const Fabric& knit_;
  LocalStage stage_;
  bool fibres_, procedural_;
  FabricDevice fabric_;
  std::vector<uint32_t> leaves_;
  Buffer<uint32_t> counters_;
  mutable cl::Program programs_[2];  // float and double, built when first used
};

}  // namespace wale::test
