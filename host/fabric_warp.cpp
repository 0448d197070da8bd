#include "host/fabric_warp.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/large_pages.h"
#include "host/program.h"

namespace wale {
namespace {

// What the warp reads, of all fabrics.
struct WarpInput {
  size_t vertices = 0, points = 0;
  std::vector<float> cloth;
  std::vector<uint32_t> triangles;
  std::vector<uint8_t> flags;
};

void append(WarpInput& out, const Fabric& fabric) {
  const uint32_t first_point = uint32_t(out.points);
  out.points += fabric.mesh.position.size();
  const size_t first_vertex = out.vertices;
  out.vertices += fabric.anchors.size();
  for (size_t t = 0; t < fabric.mesh.triangle.size(); ++t) {
    const uint32_t chart = t < fabric.chart_of_triangle.size() ? fabric.chart_of_triangle[t] : W_NONE;
    const dvec2 per_metre = chart < fabric.uv_per_metre.size() ? fabric.uv_per_metre[chart] : dvec2(1);
    for (int corner = 0; corner < 3; ++corner) {
      out.triangles.push_back(fabric.mesh.triangle[t][corner] + first_point);
      // Only differences matter: relative to the first corner, which keeps their precision in float.
      const dvec2 xy = (fabric.mesh.uv[t][corner] - fabric.mesh.uv[t][0]) / per_metre;
      out.cloth.push_back(float(xy.x));
      out.cloth.push_back(float(xy.y));
    }
  }
  out.flags.resize(out.vertices, 0);
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; p < run.plies; ++p) {
      const size_t first = first_vertex + run.first_vertex + size_t(p) * run.count;
      if (run.count == 0) continue;
      out.flags[first] |= 1;
      out.flags[first + run.count - 1] |= 2;
    }
}

// In pieces that stay in a cache, so that the host never holds all of them twice.
void write_anchors(const Device& device, std::span<const FabricInput> inputs, const Buffer<WAnchor>& out) {
  constexpr size_t kPiece = 1u << 14;
  std::vector<WAnchor> piece;
  uint32_t first_triangle = 0;
  size_t at = 0;
  for (const FabricInput& input : inputs) {
    const Fabric& fabric = *input.fabric;
    if (!fabric.lattice.empty()) continue;
    for (size_t first = 0; first < fabric.anchors.size(); first += piece.size()) {
      piece.resize(std::min(kPiece, fabric.anchors.size() - first));
      for (size_t i = 0; i < piece.size(); ++i) {
        const Anchor& a = fabric.anchors[first + i];
        piece[i] = {a.triangle + first_triangle, a.b1, a.b2, a.height, a.nx, a.ny, a.nz, a.length};
      }
      device.queue().enqueueWriteBuffer(out.cl(), CL_TRUE, at * sizeof(WAnchor), piece.size() * sizeof(WAnchor),
                                        piece.data());
      at += piece.size();
    }
    first_triangle += uint32_t(fabric.mesh.triangle.size());
  }
}

}  // namespace

MeshVertices mesh_vertices(std::span<const FabricInput> inputs, dvec3 origin) {
  MeshVertices out;
  for (const FabricInput& input : inputs) {
    if (!input.fabric->lattice.empty()) continue;
    const BaseMesh& mesh = input.fabric->mesh;
    for (size_t i = 0; i < mesh.position.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        out.positions.push_back(float(mesh.position[i][k] - origin[k]));
        out.normals.push_back(float(mesh.normal[i][k]));
      }
  }
  return out;
}

FabricWarp::FabricWarp(const Device& device, std::span<const FabricInput> inputs, dvec3 origin, size_t more) {
  WarpInput in;
  for (const FabricInput& input : inputs)
    if (input.fabric->lattice.empty()) append(in, *input.fabric);
  const MeshVertices mesh = mesh_vertices(inputs, origin);
  count_ = uint32_t(in.vertices);
  points_ = Buffer<float>(device, (count_ + more) * 3);
  frames_ = Buffer<float>(device, (count_ + more) * W_FRAME_WORDS);
  ask_for_large_pages(device, frames_.cl());
  positions_ = Buffer<float>(device, mesh.positions);
  triangles_ = Buffer<uint32_t>(device, in.triangles);
  if (count_ == 0) return;
  anchors_ = Buffer<WAnchor>(device, count_);
  write_anchors(device, inputs, anchors_);
  normals_ = Buffer<float>(device, mesh.normals);
  cloth_ = Buffer<float>(device, in.cloth);
  flags_ = Buffer<uint8_t>(device, in.flags);
  const cl::Program program = build_program(device, "warp.cl");
  warp_points_ = cl::Kernel(program, "warp_points");
  warp_normals_ = cl::Kernel(program, "warp_normals");
  for (cl::Kernel* kernel : {&warp_points_, &warp_normals_}) {
    kernel->setArg(0, anchors_.cl());
    kernel->setArg(1, positions_.cl());
    kernel->setArg(2, normals_.cl());
    kernel->setArg(3, triangles_.cl());
  }
  warp_points_.setArg(4, points_.cl());
  warp_points_.setArg(5, count_);
  warp_normals_.setArg(4, cloth_.cl());
  warp_normals_.setArg(5, flags_.cl());
  warp_normals_.setArg(6, points_.cl());
  warp_normals_.setArg(7, frames_.cl());
  warp_normals_.setArg(8, count_);
  run(device);
  device.queue().finish();
}

void FabricWarp::run(const Device& device) {
  if (count_ == 0) return;
  const size_t lanes = device.traits().lanes,
               items = (count_ + lanes - 1) / lanes;  // a work-item warps W_LANES vertices
  for (const cl::Kernel* kernel : {&warp_points_, &warp_normals_})
    device.queue().enqueueNDRangeKernel(*kernel, cl::NullRange, device.large_global(items), device.local());
}

void FabricWarp::move(const Device& device, std::span<const float> positions, std::span<const float> normals) {
  if (positions.size() != positions_.count() || normals.size() != positions_.count())
    bug("warp: {} and {} floats for base meshes of {}", positions.size(), normals.size(), positions_.count());
  for (size_t i = 0; i < positions.size(); ++i)
    if (!std::isfinite(positions[i]) || !std::isfinite(normals[i]))
      user_error("base mesh: vertex {} was moved to {} with normal component {}; both must be finite", i / 3,
                 positions[i], normals[i]);
  if (count_ == 0) return;
  device.queue().enqueueWriteBuffer(positions_.cl(), CL_TRUE, 0, positions.size_bytes(), positions.data());
  device.queue().enqueueWriteBuffer(normals_.cl(), CL_TRUE, 0, normals.size_bytes(), normals.data());
  run(device);
}

size_t FabricWarp::bytes() const {
  return anchors_.bytes() + positions_.bytes() + normals_.bytes() + cloth_.bytes() + triangles_.bytes() +
         flags_.bytes();
}

}  // namespace wale
