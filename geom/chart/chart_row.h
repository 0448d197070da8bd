#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/chart/stitch_chart.h"

namespace wale {

/// Where the characters of a text stand, for messages "where:column: ...".
struct TextPlace {
  std::string where;
  std::function<int(size_t)> column;  ///< of a character, by its index
};

/// A row in the text language, "k2 p2 | a": symbols k p s S t T o / \ (as Stitch, S and T = yarn in front) that follow
/// one another with or without blanks, each with a count if wanted (k2p2), or words between blanks: those of
/// stitch_words(), and cables c4f, c4b, c2/1f (two loops in front of one; f: the left ones in front, b: behind). Behind
/// "|" the yarn of each loop, with counts, or one yarn for the whole row; without it the first yarn. `column` is that
/// of the text's first character. Throws user errors "where:column: ...". Yarns that `yarns` lacks are added to it
/// unless it is `closed`.
ChartRow parse_chart_row(std::string_view text, const std::string& where, int column, std::vector<ChartYarn>& yarns,
                         bool closed);

/// The yarns of a row of stitches: what stands behind the "|", which may come from elsewhere.
void parse_row_yarns(ChartRow& row, std::string_view text, const TextPlace& place, std::vector<ChartYarn>& yarns,
                     bool closed);

/// "#rrggbb", or nothing.
std::optional<std::array<uint8_t, 3>> parse_color(std::string_view text);

}  // namespace wale
