// The tests of the hard cases, or with --table what they measure, as the rows of docs/hard_cases.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "tests/hard/trap.h"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--table") == 0) {
    fmt::print("{}", wale::test::trap_table(true));
    return 0;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
