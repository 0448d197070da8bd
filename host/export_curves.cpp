#include "host/export_curves.h"

#include <cmath>
#include <fstream>

#include "geom/error.h"
#include "host/atomic_file.h"

namespace wale {
namespace {

using Point = std::array<float, 3>;
using Out = std::ofstream;

// fmt writes the shortest text that reads back to the same float.
std::string text(const Point& p) { return fmt::format("{} {} {}", p[0], p[1], p[2]); }

void write_obj_lines(const std::vector<ExportCurve>& curves, Out& out) {
  out << "# Wale ply curves, metres\n";
  size_t first = 1;  // OBJ counts from 1
  for (size_t c = 0; c < curves.size(); ++c) {
    out << fmt::format("o ply{}\n# radius {}\n", c, curves[c].radius);
    for (const auto& p : curves[c].points) out << "v " << text(p) << "\n";
    out << "l";
    for (size_t i = 0; i < curves[c].points.size(); ++i) out << ' ' << first + i;
    out << "\n";
    first += curves[c].points.size();
  }
}

// A straight segment as a cubic: control points at its thirds, so that the parameter runs evenly. Consecutive segments
// share their end point: 3n+1 control points for n segments.
void write_pbrt(const std::vector<ExportCurve>& curves, Out& out) {
  out << "# Wale ply curves, metres\n";
  for (const auto& curve : curves) {
    out << "Shape \"curve\" \"string type\" [ \"cylinder\" ] \"string basis\" [ \"bezier\" ] \"integer degree\" [ 3 ] "
        << fmt::format("\"float width\" [ {} ] \"point3 P\" [\n", 2 * curve.radius) << text(curve.points[0]) << "\n";
    for (size_t i = 1; i < curve.points.size(); ++i) {
      const Point &a = curve.points[i - 1], &b = curve.points[i];
      Point third, two_thirds;
      for (int k = 0; k < 3; ++k) {
        third[k] = float((2.0 * a[k] + b[k]) / 3);
        two_thirds[k] = float((a[k] + 2.0 * b[k]) / 3);
      }
      out << text(third) << "\n" << text(two_thirds) << "\n" << text(b) << "\n";
    }
    out << "]\n";
  }
}

void write_mitsuba(const std::vector<ExportCurve>& curves, Out& out) {
  for (size_t c = 0; c < curves.size(); ++c) {
    if (c) out << "\n";
    for (const auto& p : curves[c].points) out << text(p) << fmt::format(" {}\n", curves[c].radius);
  }
}

void write_usda(const std::vector<ExportCurve>& curves, Out& out) {
  out << "#usda 1.0\n(\n    defaultPrim = \"plies\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
      << "def BasisCurves \"plies\"\n{\n    uniform token type = \"linear\"\n    uniform token wrap = "
         "\"nonperiodic\"\n";
  const auto array = [&](const char* declaration, const char* tail, auto&& items) {
    out << "    " << declaration << " = [";
    bool first = true;
    items([&](const std::string& item) {
      out << (first ? "" : ", ") << item;
      first = false;
    });
    out << "]" << tail << "\n";
  };
  array("int[] curveVertexCounts", "", [&](auto&& item) {
    for (const auto& curve : curves) item(fmt::format("{}", curve.points.size()));
  });
  array("point3f[] points", "", [&](auto&& item) {
    for (const auto& curve : curves)
      for (const auto& p : curve.points) item(fmt::format("({}, {}, {})", p[0], p[1], p[2]));
  });
  array("float[] widths", " (\n        interpolation = \"uniform\"\n    )", [&](auto&& item) {
    for (const auto& curve : curves) item(fmt::format("{}", 2 * curve.radius));
  });
  out << "}\n";
}

void check(const std::vector<ExportCurve>& curves, const std::string& file) {
  for (size_t c = 0; c < curves.size(); ++c) {
    if (curves[c].points.size() < 2) user_error("{}: curve {} has fewer than 2 points", file, c);
    if (!(curves[c].radius > 0) || !std::isfinite(curves[c].radius))
      user_error("{}: curve {}: radius {} is not positive", file, c, curves[c].radius);
    for (size_t i = 0; i < curves[c].points.size(); ++i)
      for (float v : curves[c].points[i])
        if (!std::isfinite(v)) user_error("{}: curve {}, point {}: {} is not a finite number", file, c, i, v);
  }
}

using Writer = void (*)(const std::vector<ExportCurve>&, Out&);

Writer writer_for(const std::filesystem::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".obj") return write_obj_lines;
  if (suffix == ".pbrt") return write_pbrt;
  if (suffix == ".txt") return write_mitsuba;
  if (suffix == ".usda") return write_usda;
  user_error("{}: no export format has the suffix \"{}\"; valid: .obj, .pbrt, .txt (Mitsuba), .usda", file.string(),
             suffix);
}

}  // namespace

void require_export_path(const std::filesystem::path& file) {
  writer_for(file);
  require_writable_path(file);
}

void export_curves(const std::vector<ExportCurve>& curves, const std::filesystem::path& file) {
  const auto write = writer_for(file);
  check(curves, file.string());
  AtomicFile target(file);
  std::ofstream out(target.temporary());
  write(curves, out);
  out.close();
  if (!out) user_error("{}: cannot be written; is the disk full?", file.string());
  target.commit();
}

}  // namespace wale
