#pragma once
#include <vector>

#include "geom/chart/stitch_chart.h"

namespace wale {

/// A loop of yarn: where it was made, and what took it off the needle. Rows count on through tiles above.
struct Loop {
  enum class Foot { pulled, tuck, yarn_over } foot = Foot::pulled;  ///< pulled: through the loops below
  int row = 0, wale = 0;                                            ///< where it was made
  bool knit = true;                                                 ///< pulled to the front; false: to the back
  int top_row = 0, top_wale = 0;                                    ///< where the next loop is pulled through it
  bool top_knit = true;
  int place = 0, beside = 1;  ///< of `beside` loops taken together the place-th, 0 = uppermost where they are pulled to
  int crossing = 0;           ///< cable: on its way up it passes in front (1) or behind (-1) of others
};

/// What one yarn of a row does at each of its wales.
struct Course {
  int row = 0, yarn = 0;    ///< yarn: of the chart
  int lane = 0, lanes = 1;  ///< of `lanes` yarns of the row the lane-th, which float past each other in this order

  struct Place {
    int loop = -1;             ///< index into Knit::loops; -1: it floats past
    bool float_front = false;  ///< ... in front
  };
  std::vector<Place> places;  ///< from left to right
};

/// A tile as loops: one course per row and yarn, rows in order.
struct Knit {
  int wales = 0, rows = 0;
  std::vector<Loop> loops;
  std::vector<Course> courses;
};

/// Follows every loop from the row that makes it to the one that takes it. Throws a user error naming row and wale
/// when a loop is slipped all the way through the tile and never taken. The chart has passed check_chart().
Knit knit_chart(const StitchChart& chart);

}  // namespace wale
