#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
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
  cable,       ///< knit loops that have changed places
};

/// One symbol of a chart.
struct ChartCell {
  Stitch stitch = Stitch::knit;
  int left = 0, right = 0;    ///< cable: loops that stand left and right of each other and change places
  bool left_in_front = true;  ///< cable: the left ones go in front (to the right)
  int column = 0;             ///< where it stands in the file's row, from 1, for messages
  int takes() const {
    return stitch == Stitch::yarn_over                        ? 0
           : stitch == Stitch::cable                          ? left + right
           : stitch == Stitch::k2tog || stitch == Stitch::ssk ? 2
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
