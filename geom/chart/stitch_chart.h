#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

/// What the needle does; seen from the front of the cloth.
enum class Stitch {
  knit,
  purl,
  slip,        ///< the loop is passed on, the yarn floats behind it
  slip_front,  ///< ... in front of it
  tuck,        ///< the yarn is laid behind the loop, which is passed on with it
  tuck_front,  ///< ... in front of it, as a needle of the back bed does
  yarn_over,   ///< a loop through nothing: one stitch more
  k2tog,       ///< two loops as one, the left one in front, leaning right: one stitch fewer
  ssk,         ///< ... the right one in front, leaning left
  p2tog,       ///< two purled as one, the left one in front, leaning right; from behind it is a k2tog
  ssp,         ///< ... the right one in front, leaning left; from behind it is an ssk
  k3tog,       ///< three as one, from left to right behind each other, leaning right
  k3togtbl,    ///< ... from right to left, leaning left (sssk)
  sk2p,        ///< ... the right one in front, then the left one, leaning left (slip 1, k2tog, pass it over)
  cdd,         ///< ... the middle one in front, then the right one, upright (s2kp)
  cable,       ///< knit loops that have changed places
};

/// Of the loops that a decrease takes as one, counted from the left: which lies uppermost on the side that they are
/// pulled to, which beneath it, and so on. Empty for what is no decrease.
std::span<const int> taken_order(Stitch stitch);
inline bool is_decrease(Stitch stitch) { return !taken_order(stitch).empty(); }
/// Whether a stitch pulls its loop to the front.
inline bool pulls_to_front(Stitch stitch) {
  return stitch != Stitch::purl && stitch != Stitch::p2tog && stitch != Stitch::ssp;
}

/// A word of the text language that is no single symbol.
struct StitchWord {
  std::string_view word;
  Stitch stitch;
  std::string_view apart = {};  ///< where its characters are symbols too, those with blanks between
};
std::span<const StitchWord> stitch_words();

/// One symbol of a chart.
struct ChartCell {
  Stitch stitch = Stitch::knit;
  int left = 0, right = 0;    ///< cable: loops that stand left and right of each other and change places
  bool left_in_front = true;  ///< cable: the left ones go in front (to the right)
  int column = 0;             ///< where it stands in the file's row, from 1, for messages
  std::string_view apart = {};     ///< StitchWord::apart of the word that it was written as, for messages
  int takes() const {
    return stitch == Stitch::yarn_over ? 0
           : stitch == Stitch::cable   ? left + right
           : is_decrease(stitch)       ? int(taken_order(stitch).size())
                                       : 1;
  }
  int makes() const { return stitch == Stitch::cable ? left + right : 1; }
  bool slips() const { return stitch == Stitch::slip || stitch == Stitch::slip_front; }
};

/// A yarn that a chart knits with.
struct ChartYarn {
  char letter = 'a';
  std::optional<std::array<uint8_t, 3>> color;  ///< sRGB
};

/// One row of stitches.
struct ChartRow {
  std::vector<ChartCell> cells;
  std::vector<int> yarn;  ///< of each loop on the needle after it: index into StitchChart::yarns; unused where it slips
  std::string where;      ///< file and line, for messages
  int takes() const;
  int makes() const;
};

/// A tile's worth of stitches, knitted from the first row on, each row from left to right as seen from the front.
struct StitchChart {
  std::string name;
  std::vector<ChartRow> rows;
  std::vector<ChartYarn> yarns;
  int wales() const;  ///< loops on the needle after each row
};

/// Stitches of a tile, at most; larger ones could not be relaxed in a day.
constexpr int kMostStitches = 16384;

/// Loops of a cable, at most. All of them touch each other where they cross, so that time grows with the sixth power of
/// its width: 16 over 16 are wider than any that is knitted.
constexpr int kWidestCable = 32;

/// Reads a chart by its suffix (docs/patterns.md): .json, .knitout (or .k), and text for anything else. Throws user
/// errors with row and column: unknown symbols, rows that end with different numbers of loops, a decrease with nothing
/// to take, a cable wider than the row, stitches without yarn.
StitchChart read_chart(const std::filesystem::path& file);
StitchChart parse_chart(std::string_view bytes, const std::filesystem::path& file);

/// The readers of the single formats; parse_chart() checks what comes back.
StitchChart parse_chart_text(std::string_view text, const std::filesystem::path& file);
StitchChart parse_chart_json(std::string_view text, const std::filesystem::path& file);
StitchChart parse_knitout(std::string_view text, const std::filesystem::path& file);

/// Throws the user errors that parse_chart() promises for a chart whose symbols are known.
void check_chart(const StitchChart& chart, const std::filesystem::path& file);

/// The chart in the text language, one line per row, the first knitted last; yarns come first.
std::vector<std::string> chart_lines(const StitchChart& chart);

}  // namespace wale
