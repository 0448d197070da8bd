// The plot of `wale cost`: its front and its labels.
#include <cmath>

#include "host/cost/pareto.h"
#include "tests/temporary_folder.h"

namespace wale::cost {
namespace {

ParetoPoint point(double price, double bias, const std::string& label = "level") {
  return {label, price, 0.9 * price, 1.1 * price, bias, 0.9 * bias, 1.1 * bias, true, 0};
}

TEST(CostChart, FrontHoldsWhatNothingBeats) {
  EXPECT_EQ(pareto_front({point(1, 0.1), point(2, 0.2), point(0.5, 0.5), point(3, 0.01), point(0.5, 0.6)}),
            (std::vector<size_t>{2, 0, 3}));
  EXPECT_EQ(pareto_front({point(1, 0.1), point(1, 0.1)}), (std::vector<size_t>{0}));  // of equals the first
  EXPECT_TRUE(pareto_front({}).empty());
}

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

// Forty levels in a heap, as cheap options make them.
TEST(CostChart, EveryLevelHasALabelAndNoneLiesOverAnother) {
  std::vector<ParetoPoint> points;
  for (int i = 0; i < 40; ++i)
    points.push_back(point(1 + 0.01 * std::sin(3.0 * i) * i, 0.02 + 0.0005 * std::cos(5.0 * i) * i,
                           "level number " + std::to_string(i)));
  points.push_back(point(90, 0.9, "far away"));
  const Drawing chart = pareto_chart(points, "title");
  std::vector<Box> labels;
  for (const auto& text : chart.texts)
    if (text.text.starts_with("level") || text.text == "far away")
      labels.push_back(
          {text.x, text.y - 0.8 * text.size, text.x + text_width(text.text, text.size) - 2, text.y + 0.2 * text.size});
  ASSERT_EQ(labels.size(), points.size());
  ASSERT_EQ(chart.discs.size(), points.size());
  for (size_t i = 0; i < labels.size(); ++i) {
    EXPECT_GE(labels[i].x0, 0);
    EXPECT_LE(labels[i].x1, chart.width);
    EXPECT_GE(labels[i].y0, 0);
    EXPECT_LE(labels[i].y1, chart.height);
    for (size_t j = 0; j < i; ++j) EXPECT_FALSE(labels[i].meets(labels[j])) << i << " and " << j;
    for (const auto& disc : chart.discs)
      EXPECT_FALSE(labels[i].meets({disc.x - 3, disc.y - 3, disc.x + 3, disc.y + 3})) << i;
  }
}

TEST(CostChart, UnresolvedLevelsAreRings) {
  ParetoPoint hidden = point(2, 0.01);
  hidden.resolved = false;
  const Drawing chart = pareto_chart({point(1, 0.1), hidden}, "title");
  ASSERT_EQ(chart.discs.size(), 2u);
  EXPECT_FALSE(chart.discs[0].open);
  EXPECT_TRUE(chart.discs[1].open);
  EXPECT_GT(chart.discs[1].x, chart.discs[0].x);  // dearer
  EXPECT_GT(chart.discs[1].y, chart.discs[0].y);  // nearer to 0
}

TEST(CostChart, IsPaintedAsSvgAndPng) {
  const Drawing chart = pareto_chart({point(1, 0.1, "one"), point(2, 0.01, "two")}, "a < b");
  std::string svg, png;
  EXPECT_EQ(drawing_painter().svg(chart, svg), "");
  EXPECT_EQ(drawing_painter().png(chart, 1, png), "");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_GT(png.size(), 2000u);  // something is in it
}

// A text that is wider than its room would lie over others.
TEST(CostChart, EmptyChartHasAFrame) { EXPECT_GE(pareto_chart({}, "nothing").lines.size(), 4u); }

}  // namespace
}  // namespace wale::cost
