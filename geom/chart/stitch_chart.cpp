#include "geom/chart/stitch_chart.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "geom/error.h"

namespace wale {
namespace {

std::optional<Stitch> symbol(char c) {
  switch (c) {
    case 'k':
      return Stitch::knit;
    case 'p':
      return Stitch::purl;
    case 's':
      return Stitch::slip;
    case 'S':
      return Stitch::slip_front;
    case 't':
      return Stitch::tuck;
    case 'o':
      return Stitch::yarn_over;
    case '/':
      return Stitch::k2tog;
    case '\\':
      return Stitch::ssk;
    default:
      return std::nullopt;
  }
}

// Reads a number at the start of `text` and takes it off.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || value < 0 || value > 1000) return std::nullopt;
  text.remove_prefix(size_t(end - text.data()));
  return value;
}

// c4f, c2/1b; null where the word is no cable.
std::optional<ChartCell> cable(std::string_view word) {
  if (word.empty() || (word[0] != 'c' && word[0] != 'C')) return std::nullopt;
  word.remove_prefix(1);
  const auto first = take_number(word);
  if (!first) return std::nullopt;
  std::optional<int> second;
  if (!word.empty() && word[0] == '/') {
    word.remove_prefix(1);
    second = take_number(word);
    if (!second) return std::nullopt;
  } else if (*first % 2) {
    return std::nullopt;
  }
  if (word.size() != 1) return std::nullopt;
  const char side = char(std::tolower(static_cast<unsigned char>(word[0])));
  if (side != 'f' && side != 'b') return std::nullopt;
  ChartCell cell;
  cell.stitch = Stitch::cable;
  const int front = second ? *first : *first / 2, behind = second ? *second : *first / 2;
  if (front < 1 || behind < 1) return std::nullopt;
  cell.left_in_front = side == 'f';
  cell.left = cell.left_in_front ? front : behind;
  cell.right = cell.left_in_front ? behind : front;
  return cell;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, int line) : file_(file), line_(line) {}

  std::vector<ChartCell> row(std::string_view text) {
    size_t at = 0;
    while (at < text.size()) {
      if (std::isspace(static_cast<unsigned char>(text[at]))) {
        ++at;
        continue;
      }
      size_t end = at;
      while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end]))) ++end;
      word(text.substr(at, end - at), int(at) + 1);
      at = end;
    }
    return std::move(cells_);
  }

 private:
  void add(ChartCell cell, int column) {
    cell.column = column;
    if (cells_.size() >= 4096) user_error("{}:{}:{}: a row of more than 4096 stitches", file_.string(), line_, column);
    cells_.push_back(cell);
  }

  void word(std::string_view text, int column) {
    if (text == "k2tog" || text == "ssk" || text == "yo") {
      add({text == "k2tog" ? Stitch::k2tog : text == "ssk" ? Stitch::ssk : Stitch::yarn_over}, column);
      return;
    }
    if (const auto found = cable(text)) {
      add(*found, column);
      return;
    }
    for (size_t i = 0; i < text.size();) {
      const auto stitch = symbol(text[i]);
      if (!stitch)
        user_error(
            "{}:{}:{}: \"{}\" is no stitch; valid: k p s S t o / \\, k2tog, ssk, yo, cables such as c4f or c2/1b",
            file_.string(), line_, column + int(i), one_line(std::string(text.substr(i))));
      const int where = column + int(i);
      std::string_view rest = text.substr(++i);
      int count = 1;
      if (!rest.empty() && std::isdigit(static_cast<unsigned char>(rest[0]))) {
        const size_t before = rest.size();
        const auto number = take_number(rest);
        if (!number || *number < 1)
          user_error("{}:{}:{}: a stitch is repeated 1 to 1000 times", file_.string(), line_, where + 1);
        count = *number;
        i += before - rest.size();
      }
      for (int k = 0; k < count; ++k) add({*stitch}, where);
    }
  }

  const std::filesystem::path& file_;
  int line_;
  std::vector<ChartCell> cells_;
};

int sum(const std::vector<ChartCell>& row, int (ChartCell::*count)() const) {
  int total = 0;
  for (const ChartCell& cell : row) total += (cell.*count)();
  return total;
}

}  // namespace

int StitchChart::wales() const { return rows.empty() ? 0 : sum(rows.front(), &ChartCell::makes); }

StitchChart parse_chart(std::string_view text, const std::filesystem::path& file) {
  StitchChart chart;
  chart.name = file.stem().string();
  int line = 0;
  while (!text.empty()) {
    ++line;
    const size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    row = row.substr(0, row.find('#'));
    if (row.starts_with("name:")) {
      row.remove_prefix(5);
      while (!row.empty() && std::isspace(static_cast<unsigned char>(row.front()))) row.remove_prefix(1);
      while (!row.empty() && std::isspace(static_cast<unsigned char>(row.back()))) row.remove_suffix(1);
      chart.name = std::string(row);
      continue;
    }
    auto cells = Reader(file, line).row(row);
    if (cells.empty()) continue;
    chart.rows.push_back(std::move(cells));
    chart.line.push_back(line);
    if (chart.rows.size() > 1000) user_error("{}:{}: a chart of more than 1000 rows", file.string(), line);
  }
  if (chart.rows.empty()) user_error("{}: no row of stitches", file.string());
  std::reverse(chart.rows.begin(), chart.rows.end());
  std::reverse(chart.line.begin(), chart.line.end());
  // The first row knitted follows the last one, in the next tile.
  for (size_t r = 0; r < chart.rows.size(); ++r) {
    const size_t below = (r + chart.rows.size() - 1) % chart.rows.size();
    int left = sum(chart.rows[below], &ChartCell::makes);
    const int there = left;
    for (const ChartCell& cell : chart.rows[r]) {
      if (cell.takes() > left)
        user_error("{}:{}:{}: {} takes {} loops, but of the {} of the row below (line {}) {} are left", file.string(),
                   chart.line[r], cell.column,
                   cell.stitch == Stitch::cable ? "this cable"
                   : cell.takes() == 2          ? "this decrease"
                                                : "this stitch",
                   cell.takes(), there, chart.line[below], left);
      left -= cell.takes();
    }
    if (left > 0)
      user_error("{}:{}: this row takes {} of the {} loops of the row below (line {})", file.string(), chart.line[r],
                 there - left, there, chart.line[below]);
  }
  for (size_t r = 1; r < chart.rows.size(); ++r)
    if (sum(chart.rows[r], &ChartCell::makes) != chart.wales())
      user_error(
          "{}:{}: this row ends with {} loops, the row of line {} with {}; every yarn over needs a decrease in "
          "the same row",
          file.string(), chart.line[r], sum(chart.rows[r], &ChartCell::makes), chart.line[0], chart.wales());
  return chart;
}

}  // namespace wale
