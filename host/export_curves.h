#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace wale {

/// One ply as a polyline with a constant radius, metres.
struct ExportCurve {
  std::vector<std::array<float, 3>> points;
  float radius = 0;
};

/// Writes ply curves for other renderers, by suffix, through a temporary name:
///   .obj   `v` and `l` records (no radius in the format: it stands in a comment per curve)
///   .pbrt  pbrt-v4 `Shape "curve"`, one straight cubic Bezier per segment, "float width" = 2 radius
///   .txt   Mitsuba 3 linearcurve: "x y z radius" per line, an empty line between curves
///   .usda  USD BasisCurves, linear, with widths
/// Throws a user error on an unknown suffix (the valid ones are listed), a curve of fewer than 2 points, a coordinate
/// that is not finite, or a file that cannot be written. Numbers read back to the same float.
void export_curves(const std::vector<ExportCurve>& curves, const std::filesystem::path& file);

/// Throws what export_curves would throw about the name of the file; called before the knitting starts.
void require_export_path(const std::filesystem::path& file);

}  // namespace wale
