#include "host/cost/pareto.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace wale::cost {
namespace {

constexpr double kWidth = 900, kHeight = 600, kLeft = 74, kRight = 16, kTop = 40, kBottom = 56;
constexpr double kLabel = 10, kTick = 10, kTitle = 13, kDot = 3.6;
constexpr Drawing::Color kInk{0.15, 0.15, 0.15}, kGrid{0.88, 0.88, 0.88}, kFront{0.6, 0.6, 0.6};

// Seven of Okabe and Ito's for the colour blind, without yellow, and three more.
constexpr std::array<Drawing::Color, 10> kColors = {{{0.00, 0.45, 0.70},
                                                     {0.84, 0.37, 0.00},
                                                     {0.00, 0.62, 0.45},
                                                     {0.80, 0.47, 0.65},
                                                     {0.90, 0.62, 0.00},
                                                     {0.34, 0.71, 0.91},
                                                     {0.00, 0.00, 0.00},
                                                     {0.55, 0.35, 0.20},
                                                     {0.45, 0.55, 0.10},
                                                     {0.45, 0.30, 0.65}}};

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

// A logarithmic axis with room at both ends.
class Axis {
 public:
  Axis(double low, double high, double from, double to) : from_(from), to_(to) {
    const double margin = std::max(0.06 * std::log10(high / low), 0.08);
    low_ = std::log10(low) - margin, high_ = std::log10(high) + margin;
  }
  double at(double value) const { return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_); }
  /// 1, 2, 5 times powers of ten, or the powers alone on a long axis.
  std::vector<double> ticks() const {
    std::vector<double> out;
    const bool dense = high_ - low_ < 2.5;
    for (int e = int(std::floor(low_)); e <= int(std::ceil(high_)); ++e)
      for (const double digit : {1.0, 2.0, 5.0})
        if (const double v = digit * std::pow(10, e);
            (dense || digit == 1) && std::log10(v) >= low_ && std::log10(v) <= high_)
          out.push_back(v);
    return out;
  }

 private:
  double low_, high_, from_, to_;
};

struct Range {
  double low = 1e300, high = 0;
  void add(double v) {
    if (v > 0) low = std::min(low, v), high = std::max(high, v);
  }
  Axis axis(double from, double to) const { return high > 0 ? Axis(low, high, from, to) : Axis(0.1, 1, from, to); }
};

class Chart {
 public:
  Chart(const std::vector<ParetoPoint>& points, const std::string& title)
      : points_(points), x_(x_axis(points)), y_(y_axis(points)) {
    drawing_.width = kWidth, drawing_.height = kHeight;
    frame(title);
    frame_lines_ = drawing_.lines.size();
    front();
    for (size_t i = 0; i < points_.size(); ++i) mark(i);
    for (const auto& line : drawing_.lines)
      if (&line - drawing_.lines.data() >= std::ptrdiff_t(frame_lines_)) avoid(line);
    for (size_t i : by_crowd()) label(i);
  }
  Drawing take() { return std::move(drawing_); }

 private:
  static Axis x_axis(const std::vector<ParetoPoint>& points) {
    Range range;
    for (const auto& p : points) range.add(p.price), range.add(p.price_low), range.add(p.price_high);
    return range.axis(kLeft, kWidth - kRight);
  }
  static Axis y_axis(const std::vector<ParetoPoint>& points) {
    Range range;
    for (const auto& p : points) {
      range.add(p.bias), range.add(p.high);
      // An interval that nearly reaches 0 must not stretch the axis.
      if (p.resolved) range.add(std::max(p.low, 0.3 * p.bias));
    }
    return range.axis(kHeight - kBottom, kTop);
  }

  void frame(const std::string& title) {
    const double right = kWidth - kRight, bottom = kHeight - kBottom;
    for (const double v : x_.ticks()) {
      drawing_.lines.push_back({x_.at(v), kTop, x_.at(v), bottom, 0.6, kGrid});
      drawing_.texts.push_back({x_.at(v), bottom + 15, kTick, fmt::format("{:g}", v), kInk, 0.5});
    }
    for (const double v : y_.ticks()) {
      drawing_.lines.push_back({kLeft, y_.at(v), right, y_.at(v), 0.6, kGrid});
      drawing_.texts.push_back({kLeft - 6, y_.at(v) + 3.5, kTick, fmt::format("{:g}%", 100 * v), kInk, 1});
    }
    for (const auto& [x0, y0, x1, y1] :
         {std::array{kLeft, kTop, right, kTop}, std::array{kLeft, bottom, right, bottom},
          std::array{kLeft, kTop, kLeft, bottom}, std::array{right, kTop, right, bottom}})
      drawing_.lines.push_back({x0, y0, x1, y1, 0.8, kInk});
    drawing_.texts.push_back({kLeft, kTop - 16, kTitle, title, kInk});
    drawing_.texts.push_back({0.5 * (kLeft + right), kHeight - 16, kTick + 1,
                              "time to equal noise, over that of the scene as it is", kInk, 0.5});
    drawing_.texts.push_back(
        {18, 0.5 * (kTop + bottom), kTick + 1, "bias against the reference, relative RMS", kInk, 0.5, true});
  }

  double y_of(const ParetoPoint& p) const { return p.bias > 0 ? y_.at(p.bias) : kHeight - kBottom - 8; }

  void front() {
    const std::vector<size_t> on_it = pareto_front(points_);
    for (size_t k = 0; k + 1 < on_it.size(); ++k) {
      const double x0 = x_.at(points_[on_it[k]].price), y0 = y_of(points_[on_it[k]]);
      const double x1 = x_.at(points_[on_it[k + 1]].price), y1 = y_of(points_[on_it[k + 1]]);
      drawing_.lines.push_back({x0, y0, x1, y0, 1.5, kFront});
      drawing_.lines.push_back({x1, y0, x1, y1, 1.5, kFront});
    }
  }

  void mark(size_t i) {
    const ParetoPoint& p = points_[i];
    const Drawing::Color color = kColors[p.group % kColors.size()];
    const double x = x_.at(p.price), y = y_of(p), bottom = kHeight - kBottom;
    if (p.price_low > 0) drawing_.lines.push_back({x_.at(p.price_low), y, x_.at(p.price_high), y, 1, color});
    if (p.resolved) {
      const double low = p.low > 0 ? std::min(y_.at(p.low), bottom) : bottom;
      if (p.high > 0) drawing_.lines.push_back({x, low, x, y_.at(p.high), 1, color});
    } else {
      const double tip = std::min(y + 18, bottom - 1);
      drawing_.lines.push_back({x, y, x, tip, 1, color});
      drawing_.lines.push_back({x - 3, tip - 4, x, tip, 1, color});
      drawing_.lines.push_back({x + 3, tip - 4, x, tip, 1, color});
    }
    drawing_.discs.push_back({x, y, kDot, color, !p.resolved});
    taken_.push_back({x - kDot - 1, y - kDot - 1, x + kDot + 1, y + kDot + 1});
  }

  void avoid(const Drawing::Line& l) {
    taken_.push_back(
        {std::min(l.x0, l.x1) - 1, std::min(l.y0, l.y1) - 1, std::max(l.x0, l.x1) + 1, std::max(l.y0, l.y1) + 1});
  }

  // Those with the most neighbours choose their label's place first.
  std::vector<size_t> by_crowd() const {
    std::vector<size_t> order(points_.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::vector<int> near(points_.size(), 0);
    for (size_t i : order)
      for (size_t j : order)
        near[i] +=
            std::hypot(x_.at(points_[i].price) - x_.at(points_[j].price), y_of(points_[i]) - y_of(points_[j])) < 60;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return near[a] > near[b]; });
    return order;
  }

  void label(size_t i) {
    const ParetoPoint& p = points_[i];
    const double x = x_.at(p.price), y = y_of(p), w = text_width(p.label, kLabel);
    const Box inside{kLeft + 1, kTop + 1, kWidth - kRight - 1, kHeight - kBottom - 1};
    // Rings about the point, ever wider; the whole chart is searched before a label is given up.
    for (double ring = kDot + 3; ring < kWidth; ring += 4)
      for (int step = 0; step < 24; ++step) {
        const double angle = step * 2 * 3.14159265358979 / 24, ux = std::cos(angle), uy = std::sin(angle);
        const double cx = x + ux * (ring + 0.5 * w), cy = y + uy * (ring + 0.5 * kLabel);
        const Box box{cx - 0.5 * w, cy - 0.55 * kLabel, cx + 0.5 * w, cy + 0.65 * kLabel};
        if (box.x0 < inside.x0 || box.x1 > inside.x1 || box.y0 < inside.y0 || box.y1 > inside.y1) continue;
        if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); })) continue;
        const Drawing::Color color = kColors[p.group % kColors.size()];
        if (ring > 12) {
          const double ex = std::clamp(x, box.x0, box.x1), ey = std::clamp(y, box.y0, box.y1);
          drawing_.lines.push_back({x, y, ex, ey, 0.5, kFront});
        }
        drawing_.texts.push_back({box.x0 + 1, cy + 0.36 * kLabel, kLabel, p.label, color});
        taken_.push_back(box);
        return;
      }
  }

  const std::vector<ParetoPoint>& points_;
  Axis x_, y_;
  Drawing drawing_;
  size_t frame_lines_ = 0;
  std::vector<Box> taken_;
};

}  // namespace

double text_width(const std::string& text, double size) {
  // DejaVu Sans: 0.64 of its size for the widest of common letters but m, w and capitals, which others make up for.
  size_t letters = 0;
  for (const char c : text) letters += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  return 0.64 * size * double(letters) + 2;
}

std::vector<size_t> pareto_front(const std::vector<ParetoPoint>& points) {
  std::vector<size_t> order(points.size()), out;
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return points[a].price != points[b].price ? points[a].price < points[b].price : points[a].bias < points[b].bias;
  });
  for (const size_t i : order)
    if (out.empty() || points[i].bias < points[out.back()].bias) out.push_back(i);
  return out;
}

Drawing pareto_chart(const std::vector<ParetoPoint>& points, const std::string& title) {
  return Chart(points, title).take();
}

}  // namespace wale::cost
