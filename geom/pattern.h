#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/strain_table.h"
#include "geom/vec.h"

namespace wale {

/// How control points are to be read: passed through by a smooth spline, or as uniform cubic B-spline control points.
enum class CurveKind { interpolating, bspline };

/// One yarn curve of a tile. Open curves carry, at both ends, the point at which a curve of a neighbouring tile goes
/// on.
struct PatternCurve {
  std::vector<dvec3> points;  ///< metres; x along the course, y along the wale, z through the fabric, 0 = mid-surface
  bool closed = false;
  int yarn = 0;  ///< of what colour: index into Pattern::palette
};

/// A tile of relaxed yarn, periodic in x and y (KNIT21 section 3.1).
struct Pattern {
  std::string name;
  dvec2 period{0, 0};      ///< metres
  double yarn_radius = 0;  ///< metres
  ivec2 stitches{0, 0};    ///< wales and courses in one tile; estimated by the reader where the file does not say
  CurveKind kind = CurveKind::interpolating;
  std::vector<PatternCurve> curves;
  std::vector<std::array<uint8_t, 3>> palette;  ///< sRGB colours of its yarns; empty: that of the material
  std::vector<std::string> chart;               ///< rows of the chart that it was knitted from (docs/patterns.md) ...
  std::vector<std::pair<std::string, double>> settings;  ///< ... and the settings, by name
  StrainTable strains;  ///< empty where it is not known how the tile gives way
};

/// Most yarns of different colours in one tile.
constexpr int kMostYarns = 256;

/// What a file does not say; zero means "take it from the file, or recover it".
struct PatternHints {
  dvec2 period{0, 0};
  double yarn_radius = 0;
  ivec2 stitches{0, 0};
  double unit = 0;  ///< metres per file unit (Leaf text, BCC)

  bool operator==(const PatternHints&) const = default;
};

/// Reads a tile by its suffix: .pyp, .txt (Leaf et al. 2018), .bcc, .json (Wale). Throws a user error naming the file
/// and line on anything malformed: no curves, NaN, period or radius not positive.
Pattern read_pattern(const std::filesystem::path& file, const PatternHints& hints = {});

/// The same from the bytes of a file; `file` gives the suffix, and the name for messages.
Pattern parse_pattern(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints = {});

/// Closed-form stockinette (Crane's plain-knit curve): one stitch per tile, sized so that neighbouring rows touch.
/// `wale_width` is the stitch width in metres.
Pattern stockinette_pattern(double wale_width = 0.002);

/// Writes Wale's own JSON tile (through a temporary name).
void write_pattern_json(const Pattern& pattern, const std::filesystem::path& file);

/// Writes Leaf et al.'s text format; lengths are multiplied by 1/unit.
void write_pattern_leaf(const Pattern& pattern, const std::filesystem::path& file, double unit = 1e-3);

}  // namespace wale
