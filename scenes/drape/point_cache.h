#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "geom/vec.h"
#include "host/atomic_file.h"

namespace wale::drape {

/// Writes a PC2 point cache, one sample a frame. It appears when all samples are there.
class PointCache {
 public:
  PointCache(const std::filesystem::path& file, uint32_t points, uint32_t samples);
  void add(const std::vector<dvec3>& positions);
  /// Throws a user error when the disk did not take it.
  void finish();

 private:
  std::filesystem::path name_;
  AtomicFile file_;
  std::ofstream out_;
};

}  // namespace wale::drape
