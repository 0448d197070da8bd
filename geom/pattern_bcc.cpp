// Binary curve collections (Yuksel's .bcc, little-endian): header of 64 bytes, then per curve an int32 count, negative
// where it is closed, and count x 3 float32.
#include <bit>
#include <cstring>

#include "geom/error.h"
#include "geom/pattern_readers.h"

namespace wale {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian and is read as it lies");

class Bytes {
 public:
  Bytes(std::string_view bytes, const std::filesystem::path& file) : file_(file), bytes_(bytes) {}

  template <typename T>
  T next(const char* what) {
    if (left() < sizeof(T)) user_error("{}: byte {}: ends inside {}; is the file cut off?", file_.string(), at_, what);
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  void seek(size_t at) { at_ = at; }
  size_t left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }
  size_t at() const { return at_; }

 private:
  const std::filesystem::path& file_;
  std::string_view bytes_;
  size_t at_ = 0;
};

struct Header {
  char magic[3];
  uint8_t sizes;
  char type[2];
  uint8_t dimensions, up;
};

CurveKind kind_of(const std::filesystem::path& file, const Header& header) {
  const std::string type(header.type, 2);
  // A polyline of relaxed yarn is a sampled smooth curve: it is interpolated like a Catmull-Rom chain.
  if (type == "C0" || type == "PL") return CurveKind::interpolating;
  if (type == "BS") return CurveKind::bspline;
  user_error("{}: curves of type '{}' are not supported; C0, BS and PL are", file.string(), type);
}

/// Turns the file's up axis to z, through the fabric, keeping the handedness.
dvec3 upright(const dvec3& p, int up) {
  if (up == 0) return {p.y, p.z, p.x};
  if (up == 1) return {p.x, -p.z, p.y};
  return p;
}

}  // namespace

Pattern parse_bcc(std::string_view text, const std::filesystem::path& file, const PatternHints& hints) {
  Bytes bytes(text, file);
  const Header header = bytes.next<Header>("the header");
  if (std::string_view(header.magic, 3) != "BCC") user_error("{}: does not begin with 'BCC'", file.string());
  if (header.sizes != 0x44)
    user_error("{}: numbers of kind 0x{:02x} are not supported; 4-byte ones (0x44) are", file.string(), header.sizes);
  if (header.dimensions != 3)
    user_error("{}: curves have {} dimensions; 3 are needed", file.string(), header.dimensions);
  if (header.up > 2) user_error("{}: up axis {} does not exist; it is 0, 1 or 2", file.string(), header.up);
  const uint64_t curves = bytes.next<uint64_t>("the header"), points = bytes.next<uint64_t>("the header");
  bytes.seek(64);

  const double unit = hints.unit > 0 ? hints.unit : 1e-2;
  Pattern pattern;
  pattern.kind = kind_of(file, header);
  if (!(hints.period.x > 0 && hints.period.y > 0))
    user_error("{}: a BCC file states no period, as it holds a whole swatch or garment; give the period",
               file.string());
  if (!(hints.yarn_radius > 0)) user_error("{}: a BCC file states no yarn radius; give the yarn radius", file.string());
  pattern.period = hints.period;
  pattern.yarn_radius = hints.yarn_radius;
  uint64_t total = 0;
  for (uint64_t c = 0; c < curves; ++c) {
    const int64_t signed_count = bytes.next<int32_t>("a curve's point count");
    const size_t count = static_cast<size_t>(std::abs(signed_count));
    if (count * 12 > bytes.left())
      user_error("{}: byte {}: curve {} has {} points, but only {} fit into the rest; is the file cut off?",
                 file.string(), bytes.at(), c, count, bytes.left() / 12);
    PatternCurve curve;
    curve.closed = signed_count < 0;
    for (size_t i = 0; i < count; ++i) {
      dvec3 p;
      for (const int axis : {0, 1, 2}) p[axis] = unit * bytes.next<float>("a point");
      curve.points.push_back(upright(p, header.up));
    }
    total += count;
    pattern.curves.push_back(std::move(curve));
  }
  if (total != points) user_error("{}: the header says {} points, the curves have {}", file.string(), points, total);
  if (bytes.left() > 0) user_error("{}: {} bytes follow the last of {} curves", file.string(), bytes.left(), curves);
  recentre_z(pattern);
  return pattern;
}

}  // namespace wale
