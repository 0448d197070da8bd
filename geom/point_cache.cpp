// PC2 as 3ds Max and Blender write it: "POINTCACHE2\0", then version, points, start frame, frames per sample, samples,
// then x, y, z of every point of every sample; 32 bits each, little endian.
#include <cmath>
#include <cstring>
#include <numeric>

#include "geom/error.h"
#include "geom/frame_store.h"

namespace wale {
namespace {

struct Header {
  char magic[12];
  int32_t version, points;
  float start, rate;
  int32_t samples;
};
static_assert(sizeof(Header) == 32);

Header header_of(const ByteSource& source) {
  if (source.size() < sizeof(Header)) user_error("{}: ends within its header; is the file cut off?", source.name());
  const auto h = source.read<Header>(0);
  if (std::memcmp(h.magic, "POINTCACHE2", 12) != 0)
    user_error("{}: not a point cache; it must begin with POINTCACHE2 (.pc2)", source.name());
  if (h.version != 1) user_error("{}: point cache of version {}; version 1 is known", source.name(), h.version);
  if (h.points <= 0 || h.samples <= 0)
    user_error("{}: {} points and {} samples; both must be above 0", source.name(), h.points, h.samples);
  if (!(h.rate > 0) || !(h.rate < 1e6f))
    user_error("{}: {} frames per sample; a number above 0 is needed", source.name(), h.rate);
  if (uint64_t(h.points) * uint64_t(h.samples) > (source.size() - sizeof(Header)) / 12)
    user_error("{}: {} samples of {} points do not fit into its {} bytes; is the file cut off?", source.name(),
               h.samples, h.points, source.size());
  return h;
}

class PointCache : public FrameStore {
 public:
  PointCache(ByteSource source, BaseMesh base) : source_(std::move(source)), base_(std::move(base)) {
    const Header h = header_of(source_);
    if (size_t(h.points) != base_.position.size())
      user_error("{}: a cache of {} points for {}, which has {} vertices; both must have as many", source_.name(),
                 h.points, base_.name, base_.position.size());
    numbers_.resize(size_t(h.samples));
    std::iota(numbers_.begin(), numbers_.end(), 0L);
  }

  const std::vector<long>& numbers() const override { return numbers_; }
  std::string name(long number) const override { return fmt::format("{}, sample {}", source_.name(), number); }

  BaseMesh read(long number) const override {
    std::vector<float> xyz(3 * base_.position.size());
    source_.read(place(number), xyz.data(), bytes());
    BaseMesh mesh = base_;
    for (size_t i = 0; i < mesh.position.size(); ++i) {
      mesh.position[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(mesh.position[i][k]))
          user_error("{}: vertex {}: position is NaN or infinite; write a finite number", name(number), i + 1);
    }
    compute_normals(mesh);
    return mesh;
  }

  uint64_t hash(long number) const override { return hash_bytes(source_, place(number), bytes()); }

 private:
  uint64_t bytes() const { return 12 * uint64_t(base_.position.size()); }
  uint64_t place(long number) const { return sizeof(Header) + uint64_t(number) * bytes(); }

  ByteSource source_;
  BaseMesh base_;
  std::vector<long> numbers_;
};

}  // namespace

double frames_per_sample(const ByteSource& source) { return header_of(source).rate; }

std::unique_ptr<FrameStore> point_cache(ByteSource source, BaseMesh base) {
  return std::make_unique<PointCache>(std::move(source), std::move(base));
}

}  // namespace wale
