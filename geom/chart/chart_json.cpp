// {"wale_chart": 1, "name": "...", "yarns": {"a": "#rrggbb", "b": null}, "rows": [row, ...]}, the last row knitted
// first. A row is a text as in the text language, a list of its words, or {"stitches": text or list, "yarns": text or
// list of letters}. Messages name row and column as those of texts do: "row 2:5" is the second row and its fifth
// character, or the fifth word where it is a list; "row 2, yarns:5" is a letter of its yarns.
#include <algorithm>

#include "geom/chart/chart_row.h"
#include "geom/error.h"
#include "geom/json_value.h"

namespace wale {
namespace {

// Words with blanks between; each one is looked at by itself, so that a message names its place in the list.
std::string words_of(const JsonValue& list, const std::string& place, const char* what) {
  std::string text;
  size_t number = 0;
  for (const JsonValue& unnamed : list.items()) {
    const JsonValue item = unnamed.called(fmt::format("{}:{}", place, ++number));
    const std::string word = item.text();
    if (word.empty() || word.find_first_of(" \t\r\n|") != std::string::npos)
      item.complain(fmt::format("\"{}\" is not one {}", one_line(word), what));
    text += word + " ";
  }
  return text;
}

ChartRow row_of(const JsonValue& value, const std::string& file, const std::string& place,
                std::vector<ChartYarn>& yarns, bool closed) {
  const std::string where = file + ": " + place;
  if (value.is_text()) return parse_chart_row(value.text(), where, 1, yarns, closed);
  const bool named = !value.is_list();
  if (named) value.only({"stitches", "yarns"});
  const JsonValue stitches = named ? value["stitches"].called(place) : value;
  std::vector<int> word_of;  // of each symbol
  std::string text;
  if (stitches.is_list()) {
    text = words_of(stitches, place, "word of stitches");
    int number = 0;
    for (const JsonValue& item : stitches.items()) {
      ++number;
      std::vector<ChartYarn> none{{}};
      const ChartRow alone = parse_chart_row(item.text(), fmt::format("{}:{}", where, number), 1, none, true);
      word_of.insert(word_of.end(), alone.cells.size(), number);
    }
  } else {
    text = stitches.text();
    if (text.find('|') != std::string::npos) user_error("{}: yarns stand under \"yarns\" here", where);
  }
  ChartRow row = parse_chart_row(text, where, 1, yarns, closed);
  if (named && value.has("yarns")) {
    const std::string there = place + ", yarns";
    const JsonValue letters = value["yarns"].called(there);
    const bool list = letters.is_list();
    const std::string read = list ? words_of(letters, there, "letter of a yarn") : letters.text();
    // A character of a text, an entry of a list: they are joined with blanks.
    const auto column = [&](size_t i) {
      return 1 + int(list ? std::count(read.begin(), read.begin() + std::ptrdiff_t(i), ' ') : std::ptrdiff_t(i));
    };
    parse_row_yarns(row, read, {file + ": " + there, column}, yarns, closed);
  }
  for (size_t i = 0; i < word_of.size() && i < row.cells.size(); ++i) row.cells[i].column = word_of[i];
  return row;
}

}  // namespace

StitchChart parse_chart_json(std::string_view text, const std::filesystem::path& path) {
  const std::string file = path.string();
  const nlohmann::json json = parse_json(text, file);
  const JsonValue root(file, "", json);
  root.only({"wale_chart", "name", "yarns", "rows"});
  if (root["wale_chart"].whole() != 1) root["wale_chart"].complain("only version 1 is known");
  StitchChart chart;
  if (root.has("name")) chart.name = one_line(root["name"].text());
  if (root.has("yarns"))
    for (const std::string& key : root["yarns"].keys()) {
      const JsonValue color = root["yarns"][key.c_str()];
      if (key.size() != 1 || key[0] < 'a' || key[0] > 'z') color.complain("a yarn is named by a letter, a to z");
      ChartYarn yarn{key[0], {}};
      if (!color.is_null()) {
        yarn.color = parse_color(color.text());
        if (!yarn.color) color.complain("no colour; valid: \"#rrggbb\" (sRGB), or null");
      }
      chart.yarns.push_back(yarn);
    }
  const bool closed = !chart.yarns.empty();
  if (!closed) chart.yarns.push_back({});
  const std::vector<JsonValue> rows = root["rows"].items();
  if (rows.size() > size_t(kMostStitches)) root["rows"].complain(fmt::format("more than {} rows", kMostStitches));
  size_t stitches = 0;
  for (size_t r = rows.size(); r-- > 0;) {
    const std::string place = fmt::format("row {}", r + 1);
    const JsonValue row = rows[r].called(place);
    chart.rows.push_back(row_of(row, file, place, chart.yarns, closed));
    stitches += size_t(chart.rows.back().makes());
    if (stitches > size_t(kMostStitches)) row.complain(fmt::format("a tile has at most {} stitches", kMostStitches));
  }
  return chart;
}

}  // namespace wale
