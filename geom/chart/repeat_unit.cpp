#include "geom/chart/repeat_unit.h"

#include <algorithm>
#include <cstdint>

namespace wale {
namespace {

// A row by wales: what is made there, and how many loops the row has taken before it.
struct Line {
  std::vector<int64_t> token;  // -1: within a cable
  std::vector<int> taken;
  std::vector<size_t> cell;
};

Line line_of(const ChartRow& row) {
  Line line;
  int taken = 0;
  for (size_t c = 0; c < row.cells.size(); ++c) {
    const ChartCell& cell = row.cells[c];
    for (int k = 0; k < cell.makes(); ++k) {
      const int yarn = cell.slips() ? 0 : row.yarn[line.token.size()];
      const int kind = cell.stitch == Stitch::cable
                           ? 16 + 2 * (cell.left * 1024 + cell.right) + (cell.left_in_front ? 1 : 0)
                           : int(cell.stitch);
      line.token.push_back(k ? -1 : int64_t(kind) << 32 | yarn);
      line.taken.push_back(taken);
      line.cell.push_back(c);
    }
    taken += cell.takes();
  }
  return line;
}

class Search {
 public:
  explicit Search(const std::vector<ChartRow>& swatch) : swatch_(swatch) {
    for (const ChartRow& row : swatch) lines_.push_back(line_of(row));
  }

  RepeatUnit unit() {
    if (lines_.empty()) return {};
    // Rows about the middle one that are as wide.
    const size_t middle = lines_.size() / 2;
    wales_ = int(lines_[middle].token.size());
    size_t lo = middle, hi = middle + 1;
    while (lo > 0 && int(lines_[lo - 1].token.size()) == wales_) --lo;
    while (hi < lines_.size() && int(lines_[hi].token.size()) == wales_) ++hi;
    if (lo > 0 || swatch_[lo].takes() != wales_) ++lo;  // it came from a row of another width
    // Half of them, and of the wales, are far from every border.
    const size_t rows = hi > lo ? hi - lo : 0;
    low_ = lo + rows / 4, high_ = hi - rows / 4;
    left_ = wales_ / 4, right_ = wales_ - wales_ / 4;
    if (rows == 0) return {};
    for (size_t up = 1; 2 * up <= high_ - low_; ++up)
      if (repeats_up(up))
        for (int across = 1; 2 * across <= right_ - left_; ++across)
          if (repeats_across(up, across)) return cut(up, across);
    return {};
  }

 private:
  bool same(size_t a, size_t b) const {
    return std::equal(lines_[a].token.begin() + left_, lines_[a].token.begin() + right_,
                      lines_[b].token.begin() + left_);
  }
  bool repeats_up(size_t up) const {
    for (size_t r = low_; r + up < high_; ++r)
      if (!same(r, r + up)) return false;
    return true;
  }
  bool repeats_across(size_t up, int across) const {
    for (size_t r = low_; r < low_ + up; ++r)
      for (int w = left_; w + across < right_; ++w)
        if (lines_[r].token[size_t(w)] != lines_[r].token[size_t(w + across)]) return false;
    return true;
  }
  bool begins(size_t up, int wale) const {
    for (size_t r = low_; r < low_ + up; ++r)
      if (lines_[r].taken[size_t(wale)] != wale || lines_[r].token[size_t(wale)] < 0) return false;
    return true;
  }

  RepeatUnit cut(size_t up, int across) const {
    std::vector<int64_t> best;
    RepeatUnit unit;
    for (int wale = left_; wale < left_ + across; ++wale) {
      if (!begins(up, wale) || !begins(up, wale + across)) continue;
      for (size_t row = low_; row < low_ + up; ++row) {
        std::vector<int64_t> text;
        for (size_t r = row; r < row + up; ++r)
          text.insert(text.end(), lines_[r].token.begin() + wale, lines_[r].token.begin() + wale + across);
        if (!best.empty() && best <= text) continue;
        best = text;
        unit.first_row = row, unit.first_wale = wale, unit.last_wale = wale + across - 1;
      }
    }
    if (best.empty()) return {};
    for (size_t r = unit.first_row; r < unit.first_row + up; ++r) {
      ChartRow row;
      row.where = swatch_[r].where;
      const Line& line = lines_[r];
      for (int w = unit.first_wale; w <= unit.last_wale; ++w) {
        if (line.token[size_t(w)] >= 0) row.cells.push_back(swatch_[r].cells[line.cell[size_t(w)]]);
        row.yarn.push_back(swatch_[r].yarn[size_t(w)]);
      }
      unit.rows.push_back(std::move(row));
    }
    return unit;
  }

  const std::vector<ChartRow>& swatch_;
  std::vector<Line> lines_;
  int wales_ = 0, left_ = 0, right_ = 0;
  size_t low_ = 0, high_ = 0;
};

}  // namespace

RepeatUnit repeat_unit(const std::vector<ChartRow>& swatch) { return Search(swatch).unit(); }

}  // namespace wale
