#pragma once
#include <string>
#include <vector>

namespace wale::cost {

/// A drawing as a list of strokes, discs and texts; lengths in points, y down. What paints it knows nothing of charts.
struct Drawing {
  struct Color {
    double r = 0, g = 0, b = 0;
  };
  struct Line {
    double x0, y0, x1, y1, width;
    Color color;
    bool dashed = false;
  };
  struct Disc {
    double x, y, radius;
    Color color;
    bool open = false;  ///< its rim alone
  };
  struct Text {
    double x, y;  ///< left end (or middle, or right end) of its base line
    double size;
    std::string text;  ///< UTF-8
    Color color;
    double anchor = 0;     ///< 0 left end, 0.5 middle, 1 right end
    bool upright = false;  ///< turned by 90 degrees, reads upwards
  };
  double width = 0, height = 0;
  std::vector<Line> lines;
  std::vector<Disc> discs;
  std::vector<Text> texts;
};

/// Paints drawings; in a library of its own (Cairo), loaded when one is painted.
struct DrawingPainter {
  /// Both return what went wrong, in Cairo's words, or an empty string.
  std::string (*svg)(const Drawing& drawing, std::string& out);
  std::string (*png)(const Drawing& drawing, double pixels_per_point, std::string& out);
};

constexpr const char* kPainterLibrary = "libwale_drawing_painter.so";
constexpr const char* kPainterFunction = "wale_drawing_painter";

/// Throws a user error when the library is not beside the program or cannot be loaded.
const DrawingPainter& drawing_painter();

}  // namespace wale::cost
