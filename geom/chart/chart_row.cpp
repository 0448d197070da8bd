#include "geom/chart/chart_row.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "geom/error.h"

namespace wale {
namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)); }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

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
    case 'T':
      return Stitch::tuck_front;
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

// The count behind a symbol at text[i - 1]; 1 without one. Moves i past it.
int count(std::string_view text, size_t& i, const TextPlace& place) {
  if (i >= text.size() || !is_digit(text[i])) return 1;
  std::string_view rest = text.substr(i);
  const auto number = take_number(rest);
  if (!number || *number < 1) user_error("{}:{}: a count is 1 to 1000", place.where, place.column(i));
  i = text.size() - rest.size();
  return *number;
}

int yarn_of(char letter, const std::string& where, int column, std::vector<ChartYarn>& yarns, bool closed) {
  for (size_t i = 0; i < yarns.size(); ++i)
    if (yarns[i].letter == letter) return int(i);
  std::string known;
  for (const ChartYarn& y : yarns) known += std::string(known.empty() ? "" : ", ") + y.letter;
  if (letter < 'a' || letter > 'z')
    user_error("{}:{}: '{}' is no yarn; yarns are letters a to z", where, column, one_line(std::string(1, letter)));
  if (closed) user_error("{}:{}: no yarn is called {}; there are {}", where, column, letter, known);
  yarns.push_back({letter, {}});
  return int(yarns.size()) - 1;
}

class Reader {
 public:
  Reader(const std::string& where, int column) : where_(where), first_(column) { row_.where = where; }

  ChartRow row(std::string_view stitches) {
    for (size_t at = 0; at < stitches.size();) {
      size_t end = at;
      while (end < stitches.size() && !is_blank(stitches[end])) ++end;
      if (end > at) word(stitches.substr(at, end - at), first_ + int(at));
      at = end + 1;
    }
    row_.yarn.assign(size_t(row_.makes()), 0);
    return std::move(row_);
  }

 private:
  void add(ChartCell cell, int column) {
    cell.column = column;
    row_.cells.push_back(cell);
    loops_ += cell.makes();
    if (loops_ > kMostStitches) user_error("{}:{}: a row of more than {} stitches", where_, column, kMostStitches);
  }

  void word(std::string_view text, int column) {
    for (const StitchWord& known : stitch_words())
      if (text == known.word) {
        ChartCell cell;
        cell.stitch = known.stitch;
        cell.apart = known.apart;
        return add(cell, column);
      }
    if (const auto found = cable(text)) {
      add(*found, column);
      return;
    }
    for (size_t i = 0; i < text.size();) {
      const auto stitch = symbol(text[i]);
      if (!stitch)
        user_error("{}:{}: \"{}\" is no stitch; valid: k p s S t T o / \\, {}, cables such as c4f or c2/1b", where_,
                   column + int(i), one_line(std::string(text.substr(i))), words());
      const int there = column + int(i);
      ++i;
      for (int k = count(text, i, {where_, [&](size_t c) { return column + int(c); }}); k > 0; --k)
        add({*stitch}, there);
    }
  }

  static std::string words() {
    std::string out;
    for (const StitchWord& known : stitch_words()) out.append(out.empty() ? "" : ", ").append(known.word);
    return out;
  }

  const std::string& where_;
  int first_;
  int loops_ = 0;
  ChartRow row_;
};

}  // namespace

ChartRow parse_chart_row(std::string_view text, const std::string& where, int column, std::vector<ChartYarn>& yarns,
                         bool closed) {
  const size_t bar = text.find('|');
  ChartRow row = Reader(where, column).row(text.substr(0, bar));
  if (bar != std::string_view::npos) {
    const int first = column + int(bar) + 1;
    parse_row_yarns(row, text.substr(bar + 1), {where, [&](size_t i) { return first + int(i); }}, yarns, closed);
  }
  return row;
}

void parse_row_yarns(ChartRow& row, std::string_view text, const TextPlace& place, std::vector<ChartYarn>& yarns,
                     bool closed) {
  const int makes = row.makes();
  row.yarn.clear();
  bool single = false;
  int last = 0;
  for (size_t i = 0; i < text.size();) {
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    last = place.column(i);
    const int number = yarn_of(text[i], place.where, last, yarns, closed);
    ++i;
    const int times = count(text, i, place);
    if (int(row.yarn.size()) + times > std::max(makes, 1) || int(row.yarn.size()) + times > kMostStitches)
      user_error("{}:{}: yarns for more than the {} stitches of the row", place.where, last, makes);
    row.yarn.insert(row.yarn.end(), size_t(times), number);
    if (row.yarn.size() == 1) single = times == 1;
  }
  if (row.yarn.empty())
    user_error("{}:{}: no yarn is given; leave it out, or give one letter", place.where, place.column(0));
  if (row.yarn.size() == 1 && single)
    row.yarn.assign(size_t(makes), row.yarn.front());
  else if (int(row.yarn.size()) < makes)
    user_error("{}:{}: yarn {} ends in mid-air: {} of {} stitches have a yarn", place.where, last,
               yarns[size_t(row.yarn.back())].letter, row.yarn.size(), makes);
}

std::optional<std::array<uint8_t, 3>> parse_color(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::array<uint8_t, 3> out{};
  for (size_t k = 0; k < 3; ++k) {
    const char* begin = text.data() + 1 + 2 * k;
    if (std::from_chars(begin, begin + 2, out[k], 16).ptr != begin + 2) return std::nullopt;
  }
  return out;
}

}  // namespace wale
