// The only file that knows Cairo; a library of its own, see host/cost/drawing.h.
#include <cairo-svg.h>
#include <cairo.h>

#include <cmath>

#include "host/cost/drawing.h"

namespace wale::cost {
namespace {

constexpr double kPi = 3.14159265358979323846;

cairo_status_t append(void* out, const unsigned char* bytes, unsigned count) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void set_color(cairo_t* to, const Drawing::Color& c) { cairo_set_source_rgb(to, c.r, c.g, c.b); }

void paint_text(cairo_t* to, const Drawing::Text& t) {
  cairo_save(to);
  cairo_set_font_size(to, t.size);
  cairo_text_extents_t extents;
  cairo_text_extents(to, t.text.c_str(), &extents);
  cairo_translate(to, t.x, t.y);
  if (t.upright) cairo_rotate(to, -kPi / 2);
  cairo_move_to(to, -t.anchor * extents.x_advance, 0);
  set_color(to, t.color);
  cairo_show_text(to, t.text.c_str());
  cairo_restore(to);
}

void paint(cairo_t* to, const Drawing& drawing) {
  cairo_set_source_rgb(to, 1, 1, 1);
  cairo_paint(to);
  cairo_select_font_face(to, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  for (const auto& line : drawing.lines) {
    const double dashes[] = {4, 3};
    cairo_set_dash(to, dashes, line.dashed ? 2 : 0, 0);
    cairo_set_line_width(to, line.width);
    set_color(to, line.color);
    cairo_move_to(to, line.x0, line.y0);
    cairo_line_to(to, line.x1, line.y1);
    cairo_stroke(to);
  }
  cairo_set_dash(to, nullptr, 0, 0);
  for (const auto& disc : drawing.discs) {
    cairo_arc(to, disc.x, disc.y, disc.radius, 0, 2 * kPi);
    if (disc.open) {
      cairo_set_source_rgb(to, 1, 1, 1);
      cairo_fill_preserve(to);
    }
    set_color(to, disc.color);
    cairo_set_line_width(to, 1.2);
    disc.open ? cairo_stroke(to) : cairo_fill(to);
  }
  for (const auto& text : drawing.texts) paint_text(to, text);
}

std::string words(cairo_status_t status) {
  return status == CAIRO_STATUS_SUCCESS ? std::string() : cairo_status_to_string(status);
}

std::string svg(const Drawing& drawing, std::string& out) {
  cairo_surface_t* surface = cairo_svg_surface_create_for_stream(append, &out, drawing.width, drawing.height);
  cairo_t* to = cairo_create(surface);
  paint(to, drawing);
  const std::string failure = words(cairo_status(to));
  cairo_destroy(to);
  cairo_surface_finish(surface);
  const std::string at_end = words(cairo_surface_status(surface));
  cairo_surface_destroy(surface);
  return failure.empty() ? at_end : failure;
}

std::string png(const Drawing& drawing, double pixels_per_point, std::string& out) {
  const auto pixels = [&](double points) { return int(std::lround(points * pixels_per_point)); };
  cairo_surface_t* surface =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(drawing.width), pixels(drawing.height));
  cairo_t* to = cairo_create(surface);
  cairo_scale(to, pixels_per_point, pixels_per_point);
  paint(to, drawing);
  std::string failure = words(cairo_status(to));
  cairo_destroy(to);
  if (failure.empty()) failure = words(cairo_surface_write_to_png_stream(surface, append, &out));
  cairo_surface_destroy(surface);
  return failure;
}

constexpr DrawingPainter kPainter{svg, png};

}  // namespace
}  // namespace wale::cost

extern "C" const void* wale_drawing_painter() { return &wale::cost::kPainter; }
