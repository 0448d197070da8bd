// What a fit writes down to go on from.
#include <gtest/gtest.h>

#include <limits>

#include "host/fit/journal_file.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

// JSON has no infinity: the file would be refused.
TEST(FitJournalFile, LossesWithoutANumberAreLeftOut) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  FitJournal journal;
  journal.chosen = {{0.1}, {0.2}, {0.3}};
  journal.finished = {{{0.1}, {0.4}, 2, 1, 3, true}, {{0.2}, {0.2}, 2, kInfinite, 1, false}, {{0.3}, {0.4}, 2, 1, 9}};
  journal.steps = {{0, 1, 2, {0.1}}, {1, 2, kNone, {0.2}}, {2, 3, 4, {0.3}}};
  const TemporaryFolder folder;
  write_journal(journal, "this", folder / "journal");
  const auto read = read_journal(folder / "journal", "this", 1);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->chosen, journal.chosen);
  ASSERT_EQ(read->finished.size(), 1u);  // a later one would take the place of the second
  EXPECT_EQ(read->finished[0].to, journal.finished[0].to);
  EXPECT_EQ(read->finished[0].loss, 1);
  EXPECT_TRUE(read->finished[0].converged);
  ASSERT_EQ(read->steps.size(), 2u);
  EXPECT_EQ(read->steps[1].places, journal.steps[2].places);
}

}  // namespace
}  // namespace wale::fit
