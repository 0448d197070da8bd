#include "geom/pattern.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "geom/pattern_readers.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

bool finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_hints(const std::filesystem::path& file, const PatternHints& hints) {
  for (const double value : {hints.period.x, hints.period.y, hints.yarn_radius, hints.unit})
    if (!(value >= 0) || !std::isfinite(value))
      user_error("{}: period, yarn radius and unit given for it must be positive (0 = take from the file), not {}",
                 file.string(), value);
  if (hints.stitches.x < 0 || hints.stitches.y < 0)
    user_error("{}: stitches given for it must be positive (0 = estimate), not {} x {}", file.string(),
               hints.stitches.x, hints.stitches.y);
}

void check_curve(const std::filesystem::path& file, const PatternCurve& curve, size_t index) {
  const size_t least = curve.closed ? 3 : 2;
  if (curve.points.size() < least)
    user_error("{}: curve {}: has {} points; at least {} are needed", file.string(), index, curve.points.size(), least);
  double length = 0;
  for (size_t i = 0; i < curve.points.size(); ++i) {
    if (!finite(curve.points[i])) user_error("{}: curve {}: point {} is not finite", file.string(), index, i);
    if (i > 0) length += glm::distance(curve.points[i - 1], curve.points[i]);
  }
  if (!(length > 0)) user_error("{}: curve {}: all points coincide", file.string(), index);
}

void check_pattern(const std::filesystem::path& file, const Pattern& pattern) {
  const dvec2 period = pattern.period;
  if (!(period.x > 0 && period.y > 0) || !std::isfinite(period.x) || !std::isfinite(period.y))
    user_error("{}: the period is {} x {} m; both must be positive", file.string(), period.x, period.y);
  if (!(pattern.yarn_radius > 0) || !std::isfinite(pattern.yarn_radius))
    user_error("{}: the yarn radius is {} m; it must be positive", file.string(), pattern.yarn_radius);
  if (pattern.curves.empty()) user_error("{}: the tile has no curves", file.string());
  size_t points = 0;
  for (size_t c = 0; c < pattern.curves.size(); ++c) {
    check_curve(file, pattern.curves[c], c);
    points += pattern.curves[c].points.size();
  }
  if (const std::string fault = fault_of(pattern.strains, points); !fault.empty())
    user_error("{}: strains.{}", file.string(), fault);
}

/// Some writers end a ring with its first point; the spline closes it by itself.
void open_rings(Pattern& pattern) {
  size_t first = 0;  // of a curve among all points of the tile
  for (PatternCurve& curve : pattern.curves) {
    auto& points = curve.points;
    if (curve.closed && points.size() > 1 && points.front() == points.back()) {
      points.pop_back();
      for (auto& shape : pattern.strains.offsets)
        if (first + points.size() < shape.size()) shape.erase(shape.begin() + ptrdiff_t(first + points.size()));
    }
    first += points.size();
  }
}

/// In lower case, one of those that the readers have.
std::string known_suffix(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  if (suffix != ".pyp" && suffix != ".txt" && suffix != ".bcc" && suffix != ".json")
    user_error("{}: no pattern format has the suffix '{}'; it is one of .pyp, .txt, .bcc, .json", file.string(),
               suffix);
  return suffix;
}

}  // namespace

Pattern read_pattern(const std::filesystem::path& file, const PatternHints& hints) {
  check_hints(file, hints);
  known_suffix(file);
  return parse_pattern(read_bytes(file), file, hints);
}

Pattern parse_pattern(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints) {
  check_hints(file, hints);
  const std::string suffix = known_suffix(file);
  Pattern pattern;
  if (suffix == ".pyp") {
    pattern = parse_pyp(bytes, file, hints);
  } else if (suffix == ".txt") {
    pattern = parse_leaf(bytes, file, hints);
  } else if (suffix == ".bcc") {
    pattern = parse_bcc(bytes, file, hints);
  } else {
    pattern = parse_pattern_json(bytes, file, hints);
  }
  open_rings(pattern);
  if (pattern.name.empty()) pattern.name = file.stem().string();
  check_pattern(file, pattern);
  if (hints.stitches.x > 0) pattern.stitches.x = hints.stitches.x;
  if (hints.stitches.y > 0) pattern.stitches.y = hints.stitches.y;
  if (pattern.stitches.x == 0 || pattern.stitches.y == 0) {
    const ivec2 estimate = estimate_stitches(pattern);
    if (pattern.stitches.x == 0) pattern.stitches.x = estimate.x;
    if (pattern.stitches.y == 0) pattern.stitches.y = estimate.y;
  }
  return pattern;
}

void recentre_z(Pattern& pattern) {
  double lo = INFINITY, hi = -INFINITY;
  for (const PatternCurve& curve : pattern.curves)
    for (const dvec3& p : curve.points) lo = std::min(lo, p.z), hi = std::max(hi, p.z);
  if (!(hi >= lo)) return;
  for (PatternCurve& curve : pattern.curves)
    for (dvec3& p : curve.points) p.z -= (lo + hi) / 2;
}

}  // namespace wale
