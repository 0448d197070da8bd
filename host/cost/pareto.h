#pragma once
#include <string>
#include <vector>

#include "host/cost/drawing.h"

namespace wale::cost {

/// A level in the plane of price and bias.
struct ParetoPoint {
  std::string label;
  double price = 1;  ///< time to equal noise over the base's, above 0
  double price_low = 1, price_high = 1;
  double bias = 0;           ///< relative root mean square; where it is not resolved: its upper limit
  double low = 0, high = 0;  ///< its interval
  bool resolved = true;
  size_t group = 0;  ///< points of one option have one colour
};

/// Places of the points that no other one beats in both price and bias, by price.
std::vector<size_t> pareto_front(const std::vector<ParetoPoint>& points);

/// The chart: both axes logarithmic, intervals as bars, an arrow down where only a limit is known, the front as a
/// stair, a label beside every point, none over another, a point, a bar, the stair or the frame.
Drawing pareto_chart(const std::vector<ParetoPoint>& points, const std::string& title);

/// Room that a text takes, from above: no font that a chart is painted with is wider.
double text_width(const std::string& text, double size);

}  // namespace wale::cost
