#pragma once
#include <cstring>
#include <string>
#include <vector>

#include "geom/base_mesh.h"

namespace wale::test {

template <typename T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline void put_size(std::string& out, uint32_t size) {
  if (size < 0x80) {
    put(out, uint8_t(size));
  } else if (size < 0x4000) {
    put(out, uint8_t(size >> 8 | 0x80));
    put(out, uint8_t(size));
  } else {
    put(out, uint8_t(size >> 24 | 0xC0));
    put(out, uint8_t(size >> 16));
    put(out, uint16_t(size));
  }
}

/// A file of frames as MADYPG writes it, all but the first with vertices alone; `obstacles` in every frame.
inline std::string bin_file(const std::vector<BaseMesh>& frames, uint32_t obstacles = 0) {
  std::string out;
  put_size(out, uint32_t(frames.size()));
  const auto shape = [&](size_t rows, uint32_t columns) { put(out, uint32_t(rows)), put(out, columns); };
  for (size_t f = 0; f < frames.size(); ++f) {
    const BaseMesh& mesh = frames[f];
    shape(mesh.position.size(), 3);
    for (const dvec3& p : mesh.position)
      for (int k = 0; k < 3; ++k) put(out, float(p[k]));
    const bool same = f > 0 && mesh.triangle == frames[0].triangle;
    const size_t triangles = same ? 0 : mesh.triangle.size();
    shape(triangles, 3);
    for (size_t t = 0; t < triangles; ++t)
      for (const uint32_t v : mesh.triangle[t]) put(out, v);
    shape(3 * triangles, 2);
    for (size_t t = 0; t < triangles; ++t)
      for (const dvec2& uv : mesh.uv[t]) put(out, float(uv.x)), put(out, float(uv.y));
    shape(triangles, 3);
    for (uint32_t i = 0; i < 3 * triangles; ++i) put(out, i);
    put_size(out, obstacles);
    for (uint32_t i = 0; i < obstacles; ++i) {
      put(out, 1.0f);
      shape(3, 1), out.append(12, '\0');
      shape(4, 1), out.append(16, '\0');
    }
    for (int list = 0; list < 2; ++list) {
      put_size(out, obstacles);
      for (uint32_t i = 0; i < obstacles; ++i) shape(2, 3), out.append(24, '\0');
    }
  }
  return out;
}

/// A point cache of these samples, `rate` frames a sample.
inline std::string pc2_file(const std::vector<BaseMesh>& samples, float rate = 1) {
  std::string out("POINTCACHE2\0", 12);
  put(out, int32_t(1));
  put(out, int32_t(samples[0].position.size()));
  put(out, 1.0f), put(out, rate);
  put(out, int32_t(samples.size()));
  for (const BaseMesh& mesh : samples)
    for (const dvec3& p : mesh.position)
      for (int k = 0; k < 3; ++k) put(out, float(p[k]));
  return out;
}

}  // namespace wale::test
