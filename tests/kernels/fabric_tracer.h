#pragma once
// Knitted fabrics on the device, traced with lists of rays by any of the three local stages.
#include "host/fabric_device.h"
#include "tests/kernels/synthetic.h"

namespace wale::test {

/// The patches of one fabric as the device numbers them, made from the fabric alone.
std::vector<PlyPatch> patches_of(const Fabric& fabric, float tau);

class FabricTracer {
 public:
  /// The cell stages need a tree and lists of their own: `stage` says for which one the fabric is uploaded.
  FabricTracer(const Device& device, const Fabric& fabric, float tau = -1, LocalStage stage = LocalStage::exact);

  std::vector<Hit> trace(const std::vector<Ray>& rays) const;
  std::vector<Surface> surfaces(const std::vector<Ray>& rays, const std::vector<Hit>& hits) const;
  /// Seconds that the device reports for one launch of the nearest-hit kernel, without copies.
  double seconds(const std::vector<Ray>& rays) const;
  /// Id of the segment behind a hit code: the vertex id of its start.
  uint32_t segment(uint32_t code) const;
  uint32_t stack_overflows() const;
  const Box& bounds() const { return fabric_.tree.bounds; }
  const FabricDevice& fabric() const { return fabric_; }
  std::vector<float> vertices() const { return fabric_.vertices.read(device_); }

 private:
  cl::Kernel bound(const char* name, const Buffer<Ray>& rays, size_t count) const;

  const Device& device_;
  LocalStage stage_;
  bool fibres_;
  FabricDevice fabric_;
  std::vector<uint32_t> leaves_;
  Buffer<uint32_t> counters_;
};

}  // namespace wale::test
