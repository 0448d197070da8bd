#include "geom/chart/loops.h"

#include <algorithm>

#include "geom/error.h"

namespace wale {
namespace {

// Loops held on one needle, the one in front first.
using Needle = std::vector<int>;

class Knitter {
 public:
  explicit Knitter(const StitchChart& chart) : chart_(chart), rows_(int(chart.rows.size())) {
    // What is there before the first tile is no loop of it: -1.
    needles_.assign(size_t(chart.wales()), Needle{-1});
  }

  void row(int number) {
    std::vector<Needle> after;
    places_.assign(size_t(chart_.wales()), {});
    const ChartRow& row = chart_.rows[size_t(number % rows_)];
    std::vector<bool> used(chart_.yarns.size(), false);
    size_t next = 0;  // needle of the row below
    for (const ChartCell& cell : row.cells) {
      const auto first = needles_.begin() + long(next);
      next += size_t(cell.takes());
      const int wale = int(after.size());
      if (!cell.slips())
        for (int k = 0; k < cell.makes(); ++k) used[size_t(row.yarn[size_t(wale + k)])] = true;
      switch (cell.stitch) {
        case Stitch::knit:
        case Stitch::purl:
          after.push_back(pull(*first, number, wale, pulls_to_front(cell.stitch)));
          break;
        case Stitch::k2tog:
        case Stitch::ssk:
        case Stitch::p2tog:
        case Stitch::ssp:
        case Stitch::k3tog:
        case Stitch::k3togtbl:
        case Stitch::sk2p:
        case Stitch::cdd: {
          Needle all;
          for (const int from : taken_order(cell.stitch)) all.insert(all.end(), first[from].begin(), first[from].end());
          after.push_back(pull(all, number, wale, pulls_to_front(cell.stitch)));
          break;
        }
        case Stitch::slip:
        case Stitch::slip_front:
          after.push_back(*first);
          places_[size_t(wale)].float_front = cell.stitch == Stitch::slip_front;
          break;
        case Stitch::tuck:
        case Stitch::tuck_front:
          after.push_back(*first);
          after.back().push_back(make(Loop::Foot::tuck, number, wale, cell.stitch == Stitch::tuck));
          break;
        case Stitch::yarn_over:
          after.push_back({make(Loop::Foot::yarn_over, number, wale, true)});
          break;
        case Stitch::cable:
          // The right ones come first now.
          for (int k = 0; k < cell.makes(); ++k) {
            const bool was_right = k < cell.right;
            const Needle& from = first[was_right ? cell.left + k : k - cell.right];
            for (const int loop : from)
              if (loop >= 0) knit_.loops[size_t(loop)].crossing = was_right == cell.left_in_front ? -1 : 1;
            after.push_back(pull(from, number, wale + k, true));
          }
          break;
      }
    }
    needles_ = std::move(after);
    courses(number, row, used);
  }

  const std::vector<Needle>& needles() const { return needles_; }

  Knit knit_;

 private:
  // One for each yarn of the row: it floats behind the loops of the others.
  void courses(int number, const ChartRow& row, const std::vector<bool>& used) {
    const int lanes = int(std::count(used.begin(), used.end(), true));
    int lane = 0;
    for (size_t yarn = 0; yarn < used.size(); ++yarn) {
      if (!used[yarn]) continue;
      Course course{number, int(yarn), lane++, lanes, places_};
      for (size_t wale = 0; wale < places_.size(); ++wale)
        if (places_[wale].loop >= 0 && row.yarn[wale] != int(yarn)) course.places[wale].loop = -1;
      knit_.courses.push_back(std::move(course));
    }
  }

  int make(Loop::Foot foot, int row, int wale, bool front) {
    Loop loop;
    loop.foot = foot;
    loop.row = row, loop.wale = wale, loop.knit = front;
    loop.top_row = -1;
    knit_.loops.push_back(loop);
    const int number = int(knit_.loops.size()) - 1;
    places_[size_t(wale)].loop = number;
    return number;
  }

  Needle pull(const Needle& through, int row, int wale, bool front) {
    int place = 0;
    for (const int number : through) {
      if (number >= 0) {
        Loop& loop = knit_.loops[size_t(number)];
        loop.top_row = row, loop.top_wale = wale, loop.top_knit = front;
        loop.place = place, loop.beside = int(through.size());
      }
      ++place;
    }
    return {make(Loop::Foot::pulled, row, wale, front)};
  }

  const StitchChart& chart_;
  int rows_;
  std::vector<Needle> needles_;
  std::vector<Course::Place> places_;  // of the row that is knitted
};

}  // namespace

Knit knit_chart(const StitchChart& chart) {
  // A tile below settles what is held when the tile begins; tiles above take what it holds when it ends.
  constexpr int kTiles = 4;
  const int rows = int(chart.rows.size());
  Knitter knitter(chart);
  for (int row = 0; row < kTiles * rows; ++row) knitter.row(row);
  for (size_t wale = 0; wale < knitter.needles().size(); ++wale)
    if (knitter.needles()[wale] == Needle{-1})
      user_error("{}:1: wale {} is slipped in every row: there is no loop in it", chart.rows.front().where, wale + 1);
  Knit out;
  out.wales = chart.wales();
  out.rows = rows;
  for (Course& course : knitter.knit_.courses) {
    if (course.row < rows || course.row >= 2 * rows) continue;
    course.row -= rows;
    for (size_t wale = 0; wale < course.places.size(); ++wale) {
      auto& place = course.places[wale];
      if (place.loop < 0) continue;
      Loop loop = knitter.knit_.loops[size_t(place.loop)];
      if (loop.top_row < 0)
        user_error("{}:1: the loop of wale {} is held by every row above and never taken",
                   chart.rows[size_t(course.row)].where, wale + 1);
      loop.row -= rows;
      loop.top_row -= rows;
      place.loop = int(out.loops.size());
      out.loops.push_back(loop);
    }
    out.courses.push_back(std::move(course));
  }
  return out;
}

}  // namespace wale
