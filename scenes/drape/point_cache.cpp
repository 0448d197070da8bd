#include "scenes/drape/point_cache.h"

#include "geom/error.h"

namespace wale::drape {
namespace {

template <typename T>
void put(std::ofstream& out, T value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

PointCache::PointCache(const std::filesystem::path& file, uint32_t points, uint32_t samples)
    : name_(file), file_(file), out_(file_.temporary(), std::ios::binary) {
  out_.write("POINTCACHE2", 12);
  put(out_, int32_t(1));  // version
  put(out_, int32_t(points));
  put(out_, 0.0f);  // frame of the first sample
  put(out_, 1.0f);  // frames a sample
  put(out_, int32_t(samples));
}

void PointCache::add(const std::vector<dvec3>& positions) {
  for (const dvec3& p : positions)
    for (int k = 0; k < 3; ++k) put(out_, float(p[k]));
}

void PointCache::finish() {
  out_.close();
  if (!out_) user_error("{}: could not be written", name_.string());
  file_.commit();
}

}  // namespace wale::drape
