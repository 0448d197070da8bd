// Every trap is a test; the document lists every trap.
#include "tests/hard/trap.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace wale::test {
namespace {

/// A trap's name as a test's: letters and digits, words begin with capitals.
std::string test_name(const std::string& name) {
  std::string out;
  bool capital = true;
  for (const char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) {
      capital = true;
      continue;
    }
    out += capital ? char(std::toupper(c)) : c;
    capital = false;
  }
  return out;
}

class HardCase : public ::testing::TestWithParam<size_t> {};

TEST_P(HardCase, KeepsItsPromise) {
  const Trap& trap = traps()[GetParam()];
  const Finding f = trap.look();
  EXPECT_EQ(f.broken, "") << trap.promise;
  EXPECT_GT(f.trials, 0u);
  ASSERT_FALSE(std::isnan(f.error_float)) << "nothing was measured";
  EXPECT_LE(f.error_float, trap.limit) << trap.unit << ", in float: " << trap.breaks;
  if (!std::isnan(f.error_double)) {
    EXPECT_LE(f.error_double, trap.limit) << trap.unit << ", in double";
  }
  EXPECT_LE(double(f.rare), trap.rare_limit * double(f.trials)) << "rare events";
}

INSTANTIATE_TEST_SUITE_P(Traps, HardCase, ::testing::Range(size_t(0), traps().size()),
                         [](const auto& trap) { return test_name(traps()[trap.param].name); });

// The document holds one row per trap with its promise and limit; the measured columns are those of the machine named
// there.
TEST(HardCases, TheDocumentListsEveryOne) {
  std::ifstream in(WALE_SOURCE_DIR "/docs/hard_cases.md");
  ASSERT_TRUE(in) << "docs/hard_cases.md";
  std::vector<std::string> written, expected;
  // name, what breaks, promise, limit
  const auto cells = [](const std::string& row) {
    size_t end = 0;
    for (int i = 0; i < 4; ++i) end = row.find('|', end + 1);
    return row.substr(0, end);
  };
  const auto rows = [&](std::istream& stream, std::vector<std::string>& out) {
    for (std::string line; std::getline(stream, line);)
      if (line.starts_with("| ")) out.push_back(cells(line));
  };
  rows(in, written);
  std::istringstream table(trap_table(false));
  rows(table, expected);
  EXPECT_EQ(written, expected) << "renew it with: ./wale test --table";
}

}  // namespace
}  // namespace wale::test
