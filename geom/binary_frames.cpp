// Sequences of MADYPG: file format of its framesio.h and bitsery_eigen.h.
#include <numeric>

#include "geom/error.h"
#include "geom/frame_store.h"
#include "geom/polygon_soup.h"

namespace wale {
namespace {

/// A matrix of 32-bit numbers, row after row.
struct Matrix {
  uint64_t at = 0;  ///< byte of its first number
  uint32_t rows = 0, columns = 0;
  uint64_t bytes() const { return uint64_t(rows) * columns * 4; }
};

struct Frame {
  Matrix vertices, triangles, uv, uv_triangles;
  uint64_t begin = 0, end = 0;
};

class Index {
 public:
  explicit Index(const ByteSource& source) : source_(source) {}

  /// Sizes as bitsery packs them: 7, 14 or 30 bits by the first two bits of the first byte.
  uint32_t size() {
    const uint32_t first = byte();
    if (first < 0x80) return first;
    const uint32_t second = byte();
    if (!(first & 0x40)) return (first & 0x3f) << 8 | second;
    const uint32_t low = byte();
    return ((first & 0x3f) << 8 | second) << 16 | byte() << 8 | low;
  }

  Matrix matrix(const char* what) {
    Matrix m;
    m.rows = source_.read<uint32_t>(at_);
    m.columns = source_.read<uint32_t>(at_ + 4);
    m.at = at_ + 8;
    // An empty one has columns all the same; 16 are more than any of them has.
    if (m.columns > 16 || m.bytes() > source_.size() - m.at)
      user_error("{}: frame {}: {} of {} x {} do not fit into the {} bytes that are left; is the file cut off?",
                 source_.name(), frame, what, m.rows, m.columns, source_.size() - m.at);
    at_ = m.at + m.bytes();
    return m;
  }

  void skip_obstacles() {
    for (uint32_t n = size(); n > 0; --n) {
      at_ += 4;  // scale
      matrix("the translation of an obstacle");
      matrix("the rotation of an obstacle");
    }
    for (const char* what : {"the vertices of an obstacle", "the faces of an obstacle"})
      for (uint32_t n = size(); n > 0; --n) matrix(what);
  }

  uint64_t at() const { return at_; }
  size_t frame = 0;

 private:
  uint32_t byte() { return source_.read<uint8_t>(at_++); }

  const ByteSource& source_;
  uint64_t at_ = 0;
};

class BinaryFrames : public FrameStore {
 public:
  explicit BinaryFrames(ByteSource source) : source_(std::move(source)) {
    Index index(source_);
    const uint32_t count = index.size();
    // Four empty matrices and three counts are the least that a frame is.
    constexpr uint64_t kLeast = 4 * 8 + 3;
    if (count == 0) user_error("{}: a sequence without frames", source_.name());
    if (count > source_.size() / kLeast)
      user_error("{}: {} frames do not fit into its {} bytes; is the file cut off?", source_.name(), count,
                 source_.size());
    for (index.frame = 0; index.frame < count; ++index.frame) {
      Frame f;
      f.begin = index.at();
      f.vertices = index.matrix("vertices");
      f.triangles = index.matrix("triangles");
      f.uv = index.matrix("UV");
      f.uv_triangles = index.matrix("UV triangles");
      index.skip_obstacles();
      f.end = index.at();
      if (!frames_.empty())
        for (Matrix Frame::*m : {&Frame::vertices, &Frame::triangles, &Frame::uv, &Frame::uv_triangles})
          if ((f.*m).rows == 0) f.*m = frames_[0].*m;
      require(f, index.frame);
      frames_.push_back(f);
    }
    if (index.at() != source_.size())
      user_error("{}: {} bytes behind the last of its {} frames; is it another format?", source_.name(),
                 source_.size() - index.at(), count);
    numbers_.resize(count);
    std::iota(numbers_.begin(), numbers_.end(), 0L);
  }

  const std::vector<long>& numbers() const override { return numbers_; }
  std::string name(long number) const override { return fmt::format("{}, frame {}", source_.name(), number); }

  BaseMesh read(long number) const override {
    const Frame& f = frames_.at(size_t(number));
    PolygonSoup soup;
    const auto xyz = values<float>(f.vertices), uv = values<float>(f.uv);
    for (size_t i = 0; i < f.vertices.rows; ++i) soup.position.emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    for (size_t i = 0; i < f.uv.rows; ++i) soup.uv.emplace_back(uv[2 * i], uv[2 * i + 1]);
    soup.vertex = values<uint32_t>(f.triangles);
    const auto uv_corner = values<uint32_t>(f.uv_triangles);
    soup.uv_index.assign(uv_corner.begin(), uv_corner.end());
    soup.uv_index.resize(soup.vertex.size(), -1);  // no UV triangles: no UV
    for (size_t i = 0; i < soup.vertex.size(); ++i) {
      if (i % 3 == 0) soup.face_begin.push_back(uint32_t(i));
      if (soup.vertex[i] >= soup.position.size() || soup.uv_index[i] >= int64_t(soup.uv.size()))
        user_error("{}: triangle {} names vertex {} and UV {}; there are {} and {}", name(number), i / 3,
                   soup.vertex[i], soup.uv_index[i], soup.position.size(), soup.uv.size());
    }
    return triangulate(soup, name(number));
  }

  uint64_t hash(long number) const override {
    const Frame& f = frames_.at(size_t(number));
    uint64_t h = kHashSeed;
    for (const Matrix* m : {&f.vertices, &f.triangles, &f.uv, &f.uv_triangles})
      h = hash_bytes(source_, m->at, m->bytes(), h);
    return h;
  }

 private:
  void require(const Frame& f, size_t number) const {
    const auto columns = [&](const Matrix& m, uint32_t wanted, const char* what) {
      if (m.rows > 0 && m.columns != wanted)
        user_error("{}: frame {}: {} of {} numbers each; there must be {}", source_.name(), number, what, m.columns,
                   wanted);
    };
    columns(f.vertices, 3, "vertices");
    columns(f.triangles, 3, "triangles");
    columns(f.uv, 2, "UV");
    columns(f.uv_triangles, 3, "UV triangles");
    if (f.vertices.rows == 0 || f.triangles.rows == 0)
      user_error("{}: frame {}: {} vertices and {} triangles; the first frame must have some", source_.name(), number,
                 f.vertices.rows, f.triangles.rows);
    if (f.uv_triangles.rows != f.triangles.rows && f.uv_triangles.rows != 0)
      user_error("{}: frame {}: {} UV triangles for {} triangles", source_.name(), number, f.uv_triangles.rows,
                 f.triangles.rows);
  }

  template <typename T>
  std::vector<T> values(const Matrix& m) const {
    std::vector<T> out(m.bytes() / sizeof(T));
    source_.read(m.at, out.data(), m.bytes());
    return out;
  }

  ByteSource source_;
  std::vector<Frame> frames_;
  std::vector<long> numbers_;
};

}  // namespace

std::unique_ptr<FrameStore> binary_frames(ByteSource source) {
  return std::make_unique<BinaryFrames>(std::move(source));
}

}  // namespace wale
