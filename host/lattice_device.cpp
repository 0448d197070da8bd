#include "host/lattice_device.h"

#include "host/large_pages.h"
#include "host/program.h"

namespace wale {

LatticeDevice::LatticeDevice(const Device& device, const LatticeTables& tables)
    : lattice(in_large_pages(device, tables.lattice())),
      tiles(device, tables.words()),
      patch_bits(tables.patch_bits()) {}

void LatticeDevice::warp(const Device& device, std::span<const StoredRun> runs, const Buffer<float>& points,
                         const Buffer<float>& frames) const {
  if (runs.empty()) return;
  const cl::Program program = build_program(device, "lattice_vertices.cl");
  for (const char* name : {"lattice_points", "lattice_normals"})
    for (const auto& [run, items] : runs) {
      cl::Kernel kernel(program, name);
      kernel.setArg(0, lattice.cl());
      kernel.setArg(1, tiles.cl());
      kernel.setArg(2, run);
      kernel.setArg(3, points.cl());
      kernel.setArg(4, frames.cl());
      kernel.setArg(5, items);
      device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.large_global(items), device.local());
    }
  device.queue().finish();
}

std::vector<Box> LatticeDevice::boxes(const Device& device, const std::vector<uint32_t>& leaves, Joints joints,
                                      uint32_t& tight) const {
  const Buffer<uint32_t> numbers(device, leaves);
  const Buffer<Box> boxes(device, leaves.size());
  Buffer<uint32_t> found(device, 1);
  found.fill(device, 0);
  cl::Kernel kernel(build_program(device, "lattice_boxes.cl"), "lattice_boxes");
  kernel.setArg(0, numbers.cl());
  kernel.setArg(1, lattice.cl());
  kernel.setArg(2, tiles.cl());
  kernel.setArg(3, patch_bits);
  kernel.setArg(4, uint32_t(joints));
  kernel.setArg(5, boxes.cl());
  kernel.setArg(6, found.cl());
  kernel.setArg(7, uint32_t(leaves.size()));
  device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, device.large_global(leaves.size()), device.local());
  tight = found.read(device)[0];
  return boxes.read(device);
}

}  // namespace wale
