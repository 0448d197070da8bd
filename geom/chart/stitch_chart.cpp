#include "geom/chart/stitch_chart.h"

#include <algorithm>

#include "geom/chart/chart_row.h"
#include "geom/error.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

int sum(const std::vector<ChartCell>& row, int (ChartCell::*count)() const) {
  int total = 0;
  for (const ChartCell& cell : row) total += (cell.*count)();
  return total;
}

std::string_view trimmed(std::string_view text) {
  const char* blanks = " \t\r\f\v";
  const size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// "a: #1d3f72", "a:" of a line "yarn a: #1d3f72  # navy".
ChartYarn yarn_line(std::string_view text, const std::string& where, const std::vector<ChartYarn>& yarns) {
  text = trimmed(text);
  const size_t colon = text.find(':');
  const std::string_view letter = trimmed(text.substr(0, colon));
  if (letter.size() != 1 || letter[0] < 'a' || letter[0] > 'z')
    user_error("{}:1: a yarn is named by a letter, for example: yarn a: #1d3f72", where);
  for (const ChartYarn& other : yarns)
    if (other.letter == letter[0]) user_error("{}:1: yarn {} is there already", where, letter);
  ChartYarn yarn{letter[0], {}};
  const std::string_view rest = colon == std::string_view::npos ? "" : trimmed(text.substr(colon + 1));
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  if (!word.empty()) {
    yarn.color = parse_color(word);
    if (!yarn.color)
      user_error("{}:1: \"{}\" is no colour; valid: #rrggbb (sRGB), or nothing", where, one_line(std::string(word)));
  }
  return yarn;
}

const char* name_of(const ChartCell& cell) {
  return cell.stitch == Stitch::cable ? "this cable" : is_decrease(cell.stitch) ? "this decrease" : "this stitch";
}

// Rows do not match where one of these words was meant as single stitches.
std::string hint_at_blanks(const ChartRow& row, const ChartRow& below) {
  for (const ChartRow* read : {&row, &below})
    for (const ChartCell& cell : read->cells)
      if (!cell.apart.empty()) {
        std::string word(cell.apart);
        std::erase(word, ' ');
        return fmt::format("; {} is one decrease, single stitches are written with blanks: {}", word, cell.apart);
      }
  return "";
}

std::string cell_text(const ChartCell& cell) {
  switch (cell.stitch) {
    case Stitch::knit:
      return "k";
    case Stitch::purl:
      return "p";
    case Stitch::slip:
      return "s";
    case Stitch::slip_front:
      return "S";
    case Stitch::tuck:
      return "t";
    case Stitch::tuck_front:
      return "T";
    case Stitch::yarn_over:
      return "o";
    case Stitch::k2tog:
      return "/";
    case Stitch::ssk:
      return "\\";
    case Stitch::p2tog:
    case Stitch::ssp:
    case Stitch::k3tog:
    case Stitch::k3togtbl:
    case Stitch::sk2p:
    case Stitch::cdd:
      for (const StitchWord& known : stitch_words())
        if (known.stitch == cell.stitch) return fmt::format(" {} ", known.word);
      break;
    case Stitch::cable:
      break;
  }
  const int front = cell.left_in_front ? cell.left : cell.right, behind = cell.left_in_front ? cell.right : cell.left;
  return fmt::format(" c{}/{}{} ", front, behind, cell.left_in_front ? 'f' : 'b');
}

}  // namespace

std::span<const int> taken_order(Stitch stitch) {
  static constexpr int kTwo[] = {0, 1}, kTwoTurned[] = {1, 0}, kThree[] = {0, 1, 2}, kThreeTurned[] = {2, 1, 0},
                       kPassedOver[] = {2, 0, 1}, kMiddle[] = {1, 2, 0};
  switch (stitch) {
    case Stitch::k2tog:
    case Stitch::ssp:  // uppermost behind, and so not in front
      return kTwo;
    case Stitch::ssk:
    case Stitch::p2tog:
      return kTwoTurned;
    case Stitch::k3tog:
      return kThree;
    case Stitch::k3togtbl:
      return kThreeTurned;
    case Stitch::sk2p:
      return kPassedOver;
    case Stitch::cdd:
      return kMiddle;
    default:
      return {};
  }
}

// The first word of a stitch is that of chart_lines().
std::span<const StitchWord> stitch_words() {
  static constexpr StitchWord kWords[] = {{"k2tog", Stitch::k2tog},         {"ssk", Stitch::ssk, "s s k"},
                                          {"p2tog", Stitch::p2tog},         {"ssp", Stitch::ssp, "s s p"},
                                          {"k3tog", Stitch::k3tog},         {"k3togtbl", Stitch::k3togtbl},
                                          {"sk2p", Stitch::sk2p, "s k2 p"}, {"cdd", Stitch::cdd},
                                          {"s2kp", Stitch::cdd, "s2 k p"},  {"yo", Stitch::yarn_over}};
  return kWords;
}

int ChartRow::takes() const { return sum(cells, &ChartCell::takes); }
int ChartRow::makes() const { return sum(cells, &ChartCell::makes); }
int StitchChart::wales() const { return rows.empty() ? 0 : rows.front().makes(); }

StitchChart parse_chart_text(std::string_view text, const std::filesystem::path& file) {
  // Editors of Windows begin a text with this mark of UTF-8.
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  StitchChart chart;
  int line = 0;
  size_t stitches = 0;
  bool named = false;  // yarns
  while (!text.empty()) {
    const std::string where = fmt::format("{}:{}", file.string(), ++line);
    const size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (row.starts_with("yarn ")) {
      if (!chart.rows.empty()) user_error("{}:1: yarns are named before the first row", where);
      chart.yarns.push_back(yarn_line(row.substr(5), where, chart.yarns));
      named = true;
      continue;
    }
    row = row.substr(0, row.find('#'));
    if (row.starts_with("name:")) {
      chart.name = std::string(trimmed(row.substr(5)));
      continue;
    }
    if (trimmed(row).empty()) continue;
    if (chart.yarns.empty()) chart.yarns.push_back({});
    chart.rows.push_back(parse_chart_row(row, where, 1, chart.yarns, named));
    stitches += size_t(chart.rows.back().makes());
    if (chart.rows.size() > size_t(kMostStitches)) user_error("{}:1: more than {} rows", where, kMostStitches);
    // Here and not when all is read, as all of it might not fit into memory.
    if (stitches > size_t(kMostStitches)) user_error("{}:1: a tile has at most {} stitches", where, kMostStitches);
  }
  std::reverse(chart.rows.begin(), chart.rows.end());
  return chart;
}

StitchChart parse_chart(std::string_view bytes, const std::filesystem::path& file) {
  const auto suffix = file.extension();
  StitchChart chart = suffix == ".json"                        ? parse_chart_json(bytes, file)
                      : suffix == ".knitout" || suffix == ".k" ? parse_knitout(bytes, file)
                                                               : parse_chart_text(bytes, file);
  if (chart.name.empty()) chart.name = file.stem().string();
  check_chart(chart, file);
  return chart;
}

StitchChart read_chart(const std::filesystem::path& file) { return parse_chart(read_bytes(file), file); }

void check_chart(const StitchChart& chart, const std::filesystem::path& file) {
  if (chart.rows.empty()) user_error("{}: no row of stitches", file.string());
  // The first row knitted follows the last one, in the next tile.
  for (size_t r = 0; r < chart.rows.size(); ++r) {
    const ChartRow &row = chart.rows[r], &below = chart.rows[(r + chart.rows.size() - 1) % chart.rows.size()];
    if (row.cells.empty()) user_error("{}:1: a row without stitches", row.where);
    const int there = below.makes();
    int left = there;
    for (const ChartCell& cell : row.cells) {
      if (cell.takes() > left)
        user_error("{}:{}: {} takes {} loops, but of the {} of the row below ({}) {} are left{}", row.where,
                   cell.column, name_of(cell), cell.takes(), there, below.where, left, hint_at_blanks(row, below));
      if (cell.takes() > kWidestCable)
        user_error("{}:{}: a cable over {} loops; valid: up to {}", row.where, cell.column, cell.takes(), kWidestCable);
      left -= cell.takes();
    }
    if (left > 0)
      user_error("{}:{}: this row takes {} of the {} loops of the row below ({}){}", row.where, row.cells.back().column,
                 there - left, there, below.where, hint_at_blanks(row, below));
    if (std::all_of(row.cells.begin(), row.cells.end(), [](const ChartCell& c) { return c.slips(); }))
      user_error("{}:{}: every stitch of this row is slipped, and its yarn is held by none", row.where,
                 row.cells.front().column);
  }
  for (const ChartRow& row : chart.rows)
    if (row.makes() != chart.wales())
      user_error(
          "{}:{}: this row ends with {} loops, the one knitted first ({}) with {}; every yarn over needs a decrease in "
          "the same row{}",
          row.where, row.cells.back().column, row.makes(), chart.rows.front().where, chart.wales(),
          hint_at_blanks(row, row));
  if (size_t(chart.wales()) * chart.rows.size() > size_t(kMostStitches))
    user_error("{}: {} x {} stitches; a tile has at most {}", file.string(), chart.wales(), chart.rows.size(),
               kMostStitches);
}

std::vector<std::string> chart_lines(const StitchChart& chart) {
  std::vector<std::string> lines;
  for (const ChartYarn& yarn : chart.yarns)
    if (chart.yarns.size() > 1 || yarn.color)
      lines.push_back(yarn.color ? fmt::format("yarn {}: #{:02x}{:02x}{:02x}", yarn.letter, (*yarn.color)[0],
                                               (*yarn.color)[1], (*yarn.color)[2])
                                 : fmt::format("yarn {}:", yarn.letter));
  for (auto row = chart.rows.rbegin(); row != chart.rows.rend(); ++row) {
    std::string line;
    std::string run;  // of symbols
    const auto end_run = [&] {
      const bool reads_as_word =
          std::ranges::any_of(stitch_words(), [&](const StitchWord& known) { return known.word == run; });
      for (const char symbol : run) line.append(reads_as_word ? " " : "").push_back(symbol);
      run.clear();
    };
    for (const ChartCell& cell : row->cells) {
      const std::string text = cell_text(cell);
      if (text.size() == 1) {
        run += text;
        continue;
      }
      end_run();
      line += text;
    }
    end_run();
    line = std::string(trimmed(line));
    if (chart.yarns.size() > 1) {
      line += " | ";
      for (const int yarn : row->yarn) line += chart.yarns[size_t(yarn)].letter;
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace wale
