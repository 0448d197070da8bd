// Machine instructions become the chart of the unit that repeats in them.
#include "geom/chart/stitch_chart.h"
#include "geom/text_lines.h"
#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;
using Lines = std::vector<std::string>;

constexpr int kNeedles = 24;

// A swatch: cast on, then `rows` passes to and fro of what `work` writes for the needle in the pass.
std::string swatch(int rows, const std::function<std::string(int row, int needle, const std::string& way)>& work,
                   const std::function<std::string(int row)>& before = {}) {
  std::string text = ";!knitout-2\n;;Carriers: 1 2\ninhook 1\n";
  for (int row = -2; row < rows; ++row) {
    if (before && row >= 0) text += before(row);
    for (int i = 1; i <= kNeedles; ++i) {
      const int needle = row % 2 == 0 ? i : kNeedles + 1 - i;
      const std::string way = row % 2 == 0 ? "+" : "-";
      text += row < 0 ? fmt::format("knit {} f{} 1\n", way, needle) : work(row, needle, way);
    }
  }
  return text + "outhook 1\n";
}
std::string knit(int, int needle, const std::string& way) { return fmt::format("knit {} f{} 1\n", way, needle); }
StitchChart read(const std::string& text) { return parse_chart(text, "s.knitout"); }
void refused(const std::string& text, const Lines& texts) {
  expect_user_error([&] { read(text); }, texts);
}

TEST(Knitout, SingleJersey) { EXPECT_EQ(chart_lines(read(swatch(20, knit))), (Lines{"k"})); }

TEST(Knitout, TucksAndMissedNeedles) {
  const auto text = swatch(20, [](int row, int needle, const std::string& way) {
    const bool odd = needle % 2;
    return fmt::format("{} {} f{} 1\n", row % 2 && odd ? "tuck" : row % 4 == 2 && !odd ? "miss" : "knit", way, needle);
  });
  EXPECT_EQ(chart_lines(read(text)), (Lines{"kt", "sk", "kt", "kk"}));
}

// A V-bed knits it with both beds full, each pass on every other needle of each.
TEST(Knitout, Interlock) {
  std::string text = ";!knitout-2\n";
  for (int i = 1; i <= kNeedles; ++i) text += fmt::format("knit + f{} 1\nknit + b{} 1\n", i, i);
  for (int row = 0; row < 20; ++row) {
    const bool odd = row % 2;
    for (int k = 1; k <= kNeedles; ++k) {
      const int i = odd ? kNeedles + 1 - k : k;
      text += fmt::format("knit {} {}{} 1\n", odd ? "-" : "+", (i + row) % 2 ? 'f' : 'b', i);
    }
  }
  EXPECT_EQ(chart_lines(read(text)), (Lines{"spkS", "kSsp"})) << "front and back in turn";
}

// Every fourth loop moves one needle to the right: a hole, and a decrease. The loop that was there came first, and lies
// in front.
TEST(Knitout, Lace) {
  const auto text = swatch(24, knit, [](int row) {
    std::string out;
    if (row % 4 != 0) return out;
    for (int i = 3; i < kNeedles; i += 4) out += fmt::format("xfer f{} b{}\n", i, i);
    out += "rack 1\n";
    for (int i = 3; i < kNeedles; i += 4) out += fmt::format("xfer b{} f{}\n", i, i + 1);
    return out + "rack 0\n";
  });
  EXPECT_EQ(chart_lines(read(text)), (Lines{"kko\\", "kkkk", "kkkk", "kkkk"}));
}

// For one that leans right the moved loop must come first, so the other one makes way for it on the back bed.
TEST(Knitout, TheFirstToComeLiesInFront) {
  const auto text = swatch(24, knit, [](int row) {
    std::string out;
    if (row % 4 != 0) return out;
    for (int i = 3; i < kNeedles; i += 4) out += fmt::format("xfer f{} b{}\nxfer f{} b{}\n", i, i, i + 1, i + 1);
    out += "rack 1\n";
    for (int i = 3; i < kNeedles; i += 4) out += fmt::format("xfer b{} f{}\n", i, i + 1);
    out += "rack 0\n";
    for (int i = 3; i < kNeedles; i += 4) out += fmt::format("xfer b{} f{}\n", i + 1, i + 1);
    return out;
  });
  EXPECT_EQ(chart_lines(read(text)), (Lines{"kko/", "kkkk", "kkkk", "kkkk"}));
}

// A pile that goes over to the other bed: what lay in front lies in front still, and is beneath where it is purled.
TEST(Knitout, PilesKeepTheirOrderInTheCloth) {
  for (const bool there_and_back : {false, true}) {
    const auto text = swatch(
        24,
        [&](int row, int needle, const std::string& way) {
          const bool back = !there_and_back && row % 4 == 0 && needle % 4 == 0;
          return fmt::format("knit {} {}{} 1\n", way, back ? 'b' : 'f', needle);
        },
        [&](int row) {
          std::string out;
          for (int i = 4; i <= kNeedles && row % 4 == 0; i += 4) {
            out +=
                fmt::format("xfer f{} b{}\nrack 1\nxfer b{} f{}\nrack 0\nxfer f{} b{}\n", i - 1, i - 1, i - 1, i, i, i);
            if (there_and_back) out += fmt::format("xfer b{} f{}\n", i, i);
          }
          for (int i = 4; i <= kNeedles && row % 4 == 1; i += 4) out += fmt::format("xfer b{} f{}\n", i, i);
          return out;
        });
    EXPECT_EQ(chart_lines(read(text)), (Lines{there_and_back ? "kko\\" : "kko ssp", "kkkk", "kkkk", "kkkk"}));
  }
}

// Two and two change places: those that are back first lie in front.
TEST(Knitout, Cable) {
  const auto text = swatch(24, knit, [](int row) {
    std::string out;
    if (row % 4 != 0) return out;
    for (int i = 1; i + 5 <= kNeedles; i += 6) {
      for (int k = 1; k <= 4; ++k) out += fmt::format("xfer f{} b{}\n", i + k, i + k);
      out += "rack 2\n";
      for (int k = 1; k <= 2; ++k) out += fmt::format("xfer b{} f{}\n", i + k, i + k + 2);
      out += "rack -2\n";
      for (int k = 3; k <= 4; ++k) out += fmt::format("xfer b{} f{}\n", i + k, i + k - 2);
      out += "rack 0\n";
    }
    return out;
  });
  const StitchChart chart = read(text);
  EXPECT_EQ(chart.wales(), 6);
  EXPECT_EQ(chart.rows.size(), 4u);
  size_t cables = 0;
  for (const ChartRow& row : chart.rows)
    for (const ChartCell& cell : row.cells)
      if (cell.stitch == Stitch::cable) {
        ++cables;
        EXPECT_EQ(cell.left, 2);
        EXPECT_EQ(cell.right, 2);
        EXPECT_TRUE(cell.left_in_front);
      }
  EXPECT_EQ(cables, 1u);
}

// Their loops come back in turn: each strand lies in front of some of the others and behind some, and no symbol says
// so.
TEST(Knitout, InterleavedStrandsAreNoCable) {
  const auto cable = [](const std::vector<int>& order) {  // of the loops that come back, 1 and 2 from the left
    return swatch(24, knit, [&](int row) {
      std::string out;
      if (row % 4 != 0) return out;
      for (int i = 1; i + 5 <= kNeedles; i += 6) {
        for (int k = 1; k <= 4; ++k) out += fmt::format("xfer f{} b{}\n", i + k, i + k);
        for (const int k : order) {
          const int by = k <= 2 ? 2 : -2;
          out += fmt::format("rack {}\nxfer b{} f{}\n", by, i + k, i + k + by);
        }
        out += "rack 0\n";
      }
      return out;
    });
  };
  EXPECT_EQ(chart_lines(read(cable({2, 1, 4, 3}))), chart_lines(read(cable({1, 2, 3, 4}))));
  EXPECT_NE(chart_lines(read(cable({3, 4, 1, 2}))), chart_lines(read(cable({1, 2, 3, 4}))));
  for (const std::vector<int>& order : {std::vector<int>{1, 3, 2, 4}, {1, 3, 4, 2}, {3, 1, 2, 4}})
    refused(cable(order), {"s.knitout:", "moved across others in a way that is neither a decrease nor a cable"});
}

// Neighbours on both sides move onto one needle.
TEST(Knitout, DoubleDecreases) {
  const auto lace = [](bool right_first, bool middle_last) {
    return swatch(24, knit, [=](int row) {
      std::string out;
      if (row % 4 != 0) return out;
      for (int i = 2; i + 1 <= kNeedles; i += 4) {
        const auto move = [&](int from) {
          out += fmt::format("xfer f{} b{}\nrack {}\nxfer b{} f{}\nrack 0\n", from, from, i - from, from, i);
        };
        if (middle_last) out += fmt::format("xfer f{} b{}\n", i, i);
        move(right_first ? i + 1 : i - 1);
        move(right_first ? i - 1 : i + 1);
        if (middle_last) out += fmt::format("xfer b{} f{}\n", i, i);
      }
      return out;
    });
  };
  EXPECT_EQ(chart_lines(read(lace(true, false))), (Lines{"ko cdd o", "kkkk", "kkkk", "kkkk"}));
  EXPECT_EQ(chart_lines(read(lace(true, true))), (Lines{"ko sk2p o", "kkkk", "kkkk", "kkkk"}));
  expect_user_error(
      [&] { read(lace(false, true)); },
      {"s.knitout:", "3 loops on needle f2 are taken together in another order", "k3tog, k3togtbl, sk2p and cdd"});
}

TEST(Knitout, PurledDecreases) {
  const auto lace = [](int to) {
    std::string text = ";!knitout-2\n";
    for (int row = -2; row < 24; ++row) {
      if (row >= 0 && row % 4 == 0)
        for (int i = 3; i < kNeedles; i += 4)
          text += fmt::format("xfer b{} f{}\nrack {}\nxfer f{} b{}\nrack 0\n", i, i, -to, i, i + to);
      for (int i = 1; i <= kNeedles; ++i)
        text += row % 2 == 0 ? fmt::format("knit + b{} 1\n", i) : fmt::format("knit - b{} 1\n", kNeedles + 1 - i);
    }
    return text;
  };
  EXPECT_EQ(chart_lines(read(lace(1))), (Lines{"ppo p2tog", "pppp", "pppp", "pppp"}));
  EXPECT_EQ(chart_lines(read(lace(-1))), (Lines{"pp ssp o", "pppp", "pppp", "pppp"}));
}

// Half a needle: both beds knit, back needles between the front ones, but none face each other.
TEST(Knitout, RacksBetweenNeedles) {
  const auto rib = [](const std::string& rack) {
    std::string text = ";!knitout-2\nrack " + rack + "\n";
    for (int row = 0; row < 20; ++row)
      for (int k = 1; k <= kNeedles; ++k) {
        const int i = row % 2 ? kNeedles + 1 - k : k;
        text += row % 2 ? fmt::format("knit - b{} 1\nknit - f{} 1\n", i, i)
                        : fmt::format("knit + f{} 1\nknit + b{} 1\n", i, i);
      }
    return text;
  };
  EXPECT_EQ(chart_lines(read(rib("0.5"))), (Lines{"kp"}));
  refused(rib("1"), {"s.knitout:", "a pass at rack 1 with loops on both beds; valid: racks from 0 on and below 1"});
  refused(rib("-0.5"), {"a pass at rack -0.5"});
  refused(";!knitout-2\nknit + f1 1\nrack 0.5\nxfer f1 b1\n", {"s.knitout:4: at rack 0.5 no needles face each other"});
}

// More yarns than letters were told apart by their number modulo 32: a stripe of 33 carriers was none.
TEST(Knitout, CarriersAreAtMostLetters) {
  std::string text = ";!knitout-2\n";
  for (int row = 0; row < 40; ++row)
    for (int k = 1; k <= kNeedles; ++k)
      text += fmt::format("knit {} f{} {}\n", row % 2 ? '-' : '+', row % 2 ? kNeedles + 1 - k : k, row % 33);
  refused(text, {"s.knitout:626: more than 26 yarns"});
}

// Loops pile up one by one; nothing takes so many, and they are refused before there are thousands.
TEST(Knitout, PiledLoops) {
  std::string text = ";!knitout-2\n";
  for (int i = 1; i <= kNeedles; ++i) text += fmt::format("knit + f{} 1\n", i);
  for (int i = 2; i <= kNeedles; ++i) text += fmt::format("rack {}\nxfer f{} b1\n", i - 1, i);
  refused(text, {"s.knitout:33: 4 loops on needle b1; a chart takes up to 3 as one"});
}

TEST(Knitout, WhatCannotBeRead) {
  refused("knit + f1 1\n", {"s.knitout:1", ";!knitout-2"});
  refused(";!knitout-2\n", {"no stitches"});
  const std::string start = ";!knitout-2\nknit + f1 1\n";
  refused(start + "split + f1 b1 1\n", {"s.knitout:3: split is not read"});
  refused(start + "nit + f2 1\n", {"s.knitout:3: \"nit\" is no instruction"});
  refused(start + "knit + g2 1\n", {"s.knitout:3: \"g2\" is no needle"});
  refused(start + "knit + f99999999999 1\n", {"s.knitout:3", "is no needle"});
  refused(start + "knit ? f2 1\n", {"s.knitout:3: \"?\" is no direction"});
  refused(start + "knit + f2\n", {"s.knitout:3", "a carrier"});
  refused(start + "xfer f1 f2\n", {"s.knitout:3", "one bed to the other"});
  refused(start + "xfer f1 b2\n", {"s.knitout:3", "at rack 0 these needles do not face each other"});
  refused(start + "rack nan\n", {"s.knitout:3"});
  refused(start, {"no unit of stitches repeats"});
}

TEST(Knitout, YarnThatEndsInMidAir) {
  // Every second row turns after three needles.
  const auto text = swatch(20, [](int row, int needle, const std::string& way) {
    return row % 4 >= 2 && needle > 3 ? "" : fmt::format("knit {} f{} 1\n", way, needle);
  });
  expect_user_error([&] { read(text); }, {"s.knitout:", "the yarn ends in mid-air: this pass reaches stitches 1 to 3"});
}

TEST(Knitout, RealSwatches) {
  const char* data = std::getenv("WALE_REAL_DATA");
  if (!data) GTEST_SKIP() << "skipped: real data not present";
  const auto folder = std::filesystem::path(data) / "yarn-patterns/knitout-examples";
  const std::pair<const char*, Lines> wanted[] = {
      {"singlejersey", {"k"}}, {"garter", {"p", "k"}}, {"rib-1x1", {"kp"}}, {"rib-2x2", {"kkpp"}}};
  for (const auto& [name, lines] : wanted)
    EXPECT_EQ(chart_lines(read_chart(folder / (std::string(name) + ".knitout"))), lines) << name;
}

}  // namespace
}  // namespace wale
