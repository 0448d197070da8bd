#pragma once
#include <filesystem>
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
  tuck,        ///< the yarn is laid beside the loop, which is passed on with it
  yarn_over,   ///< a loop through nothing: one stitch more
  k2tog,       ///< two loops as one, the right one in front: one stitch fewer, leaning right
  ssk,         ///< ... the left one in front, leaning left
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
};

/// A tile's worth of stitches, knitted from the first row on, each row from left to right as seen from the front.
struct StitchChart {
  std::string name;
  std::vector<std::vector<ChartCell>> rows;
  std::vector<int> line;  ///< of each row in its file, for messages
  int wales() const;      ///< loops on the needle after each row
};

/// Reads a chart from text: one row per line, the last line is knitted first, as charts are printed. Symbols follow one
/// another with or without blanks: k p s S t o / \ (as Stitch, S = slip_front), each with a count if wanted (k2p2), or
/// words: k2tog, ssk, yo, and cables c4f, c4b, c2/1f (two loops in front of one; f: the left ones in front, b: behind).
/// "# ..." is a comment, "name: ..." names it. Throws user errors with row and column: unknown symbols, rows that end
/// with different numbers of loops, a decrease with nothing to take, a cable wider than the row.
StitchChart parse_chart(std::string_view text, const std::filesystem::path& file);

}  // namespace wale
