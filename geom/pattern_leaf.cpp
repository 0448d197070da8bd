// Text format of Leaf et al. 2018, "Interactive design of periodic yarn-level cloth patterns": blocks of uniform cubic
// B-spline control points; neighbouring blocks repeat one control point, sometimes two.
#include <algorithm>

#include "geom/near_points.h"
#include "geom/pattern_readers.h"
#include "geom/stitch.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

/// NAME_RADIUS.txt: the number behind the last underscore, 0 if there is none.
double radius_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const size_t at = stem.rfind('_');
  if (at == std::string::npos) return 0;
  char* end = nullptr;
  const double value = std::strtod(stem.c_str() + at + 1, &end);
  return end && *end == '\0' && std::isfinite(value) ? value : 0;
}

std::vector<PatternCurve> read_blocks(std::string_view text, const std::filesystem::path& file, double unit) {
  const std::vector<TextLine> lines = text_lines(text);
  if (lines.empty() || lines[0].words.size() != 3 || lines[0].words[0] != "Num" || lines[0].words[1] != "Yarns:")
    user_error("{}:1: expected 'Num Yarns: n', as in the files of Leaf et al.", file.string());
  const long wanted = whole_number(file, lines[0].number, lines[0].words[2]);
  if (wanted < 1) user_error("{}:{}: {} yarns; at least one is needed", file.string(), lines[0].number, wanted);
  std::vector<PatternCurve> curves;
  size_t at = 1;
  while (at < lines.size()) {
    const TextLine& head = lines[at++];
    if (head.words.size() != 1)
      user_error("{}:{}: expected the number of control points of curve {}, found {} words", file.string(), head.number,
                 curves.size(), head.words.size());
    const long count = whole_number(file, head.number, head.words[0]);
    if (count < 2) user_error("{}:{}: curve of {} points; at least 2 are needed", file.string(), head.number, count);
    PatternCurve curve;
    for (long i = 0; i < count; ++i, ++at) {
      if (at >= lines.size())
        user_error("{}: ends after {} of {} points of curve {}; is the file cut off?", file.string(), i, count,
                   curves.size());
      const TextLine& row = lines[at];
      if (row.words.size() != 3)
        user_error("{}:{}: expected x y z, found {} words", file.string(), row.number, row.words.size());
      dvec3 p;
      for (const int axis : {0, 1, 2}) p[axis] = unit * finite_number(file, row.number, row.words[axis]);
      curve.points.push_back(p);
    }
    curves.push_back(std::move(curve));
  }
  if (static_cast<long>(curves.size()) != wanted)
    user_error("{}:{}: says {} yarns, but {} follow", file.string(), lines[0].number, wanted, curves.size());
  return curves;
}

dvec3 displacement(const Pattern& pattern, ivec2 shift) {
  return {shift.x * pattern.period.x, shift.y * pattern.period.y, 0};
}

bool same_curve(const PatternCurve& a, const PatternCurve& b, dvec3 shift, bool reversed, double tolerance) {
  if (a.points.size() != b.points.size()) return false;
  const size_t count = a.points.size();
  for (size_t i = 0; i < count; ++i)
    if (glm::distance(a.points[i], b.points[reversed ? count - 1 - i : i] + shift) > tolerance) return false;
  return true;
}

/// Drops curves that repeat an earlier one, in either direction, here or in a neighbouring tile.
void drop_duplicates(Pattern& pattern) {
  const double tolerance = 1e-3 * pattern.yarn_radius;
  std::vector<PatternCurve> kept;
  NearPoints ends(tolerance);  // of the kept curves, both
  for (PatternCurve& curve : pattern.curves) {
    bool repeated = false;
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const dvec3 shift = displacement(pattern, {x, y});
        ends.visit_near(curve.points.front() - shift, [&](int number) {
          for (const bool reversed : {false, true})
            repeated = repeated || same_curve(curve, kept[static_cast<size_t>(number)], shift, reversed, tolerance);
        });
      }
    if (repeated) continue;
    for (const dvec3& end : {curve.points.front(), curve.points.back()}) ends.add(end, static_cast<int>(kept.size()));
    kept.push_back(std::move(curve));
  }
  pattern.curves = std::move(kept);
}

const dvec3& from_end(const PatternCurve& curve, int end, size_t i) {
  return curve.points[end == 0 ? i : curve.points.size() - 1 - i];
}

/// Where two blocks share two control points, the end of one is the second point of the other and the other way round:
/// the first of the two gives its last point up, which leaves the usual overlap by one.
void trim_double_overlaps(Pattern& pattern, double tolerance) {
  const int count = static_cast<int>(pattern.curves.size());
  NearPoints seconds(tolerance);  // the point next to each end, 2 d + end; trimming moves it, so both places are kept
  const auto add_seconds = [&](int d) {
    for (const int other : {0, 1}) seconds.add(from_end(pattern.curves[d], other, 1), 2 * d + other);
  };
  for (int d = 0; d < count; ++d) add_seconds(d);
  for (int c = 0; c < count; ++c)
    for (const int end : {0, 1}) {
      PatternCurve& curve = pattern.curves[c];
      if (curve.points.size() < 3) continue;
      bool overlaps = false;
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const dvec3 shift = displacement(pattern, {x, y});
          seconds.visit_near(from_end(curve, end, 0) - shift, [&](int number) {
            const int d = number / 2, other = number % 2;
            if (overlaps || (c == d && end == other)) return;
            const PatternCurve& next = pattern.curves[d];
            overlaps = glm::distance(from_end(curve, end, 0), from_end(next, other, 1) + shift) <= tolerance &&
                       glm::distance(from_end(curve, end, 1), from_end(next, other, 0) + shift) <= tolerance;
          });
        }
      if (!overlaps) continue;
      curve.points.erase(end == 0 ? curve.points.begin() : curve.points.end() - 1);
      add_seconds(c);
    }
}

/// Puts partner ends at their common mean, so that they coincide up to the shift.
void average_ends(Pattern& pattern) {
  const PartnerMap partners = match_partners(pattern);
  const std::vector<PatternCurve> before = pattern.curves;
  for (size_t c = 0; c < before.size(); ++c)
    for (const int end : {0, 1}) {
      const Partner& partner = partners.of[c][end];
      const dvec3 other = from_end(before[partner.to.curve], partner.to.end, 0) + displacement(pattern, partner.shift);
      auto& points = pattern.curves[c].points;
      dvec3& mine = end == 0 ? points.front() : points.back();
      mine = (mine + other) * 0.5;
    }
}

}  // namespace

Pattern parse_leaf(std::string_view text, const std::filesystem::path& file, const PatternHints& hints) {
  const double unit = hints.unit > 0 ? hints.unit : 1e-3;
  Pattern pattern;
  pattern.kind = CurveKind::bspline;
  pattern.yarn_radius = hints.yarn_radius > 0 ? hints.yarn_radius : radius_in_name(file) * unit;
  if (!(pattern.yarn_radius > 0))
    user_error("{}: the file name does not end in a positive yarn radius (NAME_RADIUS.txt); give the yarn radius",
               file.string());
  pattern.curves = read_blocks(text, file, unit);
  drop_duplicates(pattern);  // the period is not known yet: duplicates in place only
  // Published tiles miss by up to 5 % of a radius, and the next end is several radii away.
  const double tolerance = 0.25 * pattern.yarn_radius;
  pattern.period = recover_periods(pattern, hints.period, tolerance, file);
  drop_duplicates(pattern);
  trim_double_overlaps(pattern, tolerance);
  pattern.name = file.stem().string();
  average_ends(pattern);
  recentre_z(pattern);
  return pattern;
}

void write_pattern_leaf(const Pattern& pattern, const std::filesystem::path& file, double unit) {
  std::string text = fmt::format("Num Yarns: {}\n", pattern.curves.size());
  for (const PatternCurve& curve : pattern.curves) {
    if (curve.closed)
      user_error("{}: the format of Leaf et al. has no closed curves; write .json instead", file.string());
    text += fmt::format("\n{}\n", curve.points.size());
    for (const dvec3& p : curve.points)
      text += fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x / unit, p.y / unit, p.z / unit);
  }
  write_whole_file(file, text);
}

}  // namespace wale
