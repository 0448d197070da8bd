// Every reader on its seeds, on a few thousand files damaged in a fixed order, and on large ones.
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/expect.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/targets.h"
#include "tests/tolerances.h"

namespace wale::fuzz {
namespace {

std::vector<std::string> seeds_of(const Target& target) {
  const auto folder = std::filesystem::path(WALE_SOURCE_DIR) / "tests/fuzz/corpus" / target.name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return seeds;
}

std::string printable(const std::string& bytes) {
  std::string text;
  for (const unsigned char c : bytes.substr(0, 2000))
    text += c >= 0x20 && c < 0x7F && c != '\\' ? std::string(1, char(c)) : fmt::format("\\x{:02x}", c);
  return text;
}

/// True when accepted. Fails the test when the reader breaks its promise or takes longer than it may.
bool run(const Target& target, const std::string& bytes) {
  const std::clock_t start = std::clock();
  bool taken = false;
  try {
    taken = target.run(bytes);
  } catch (const Broken& broken) {
    ADD_FAILURE() << target.name << ": " << broken.what << "\n" << printable(bytes);
  }
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_LE(seconds, tolerance::kReaderSeconds) << target.name << ": " << bytes.size() << " bytes\n"
                                                << printable(bytes);
  return taken;
}

class Readers : public testing::TestWithParam<size_t> {
 protected:
  const Target& target() const { return targets()[GetParam()]; }
};

TEST_P(Readers, TakeTheirSeeds) {
  const auto seeds = seeds_of(target());
  ASSERT_FALSE(seeds.empty());
  for (const std::string& seed : seeds) EXPECT_TRUE(run(target(), seed)) << printable(seed);
}

TEST_P(Readers, RefuseOrTakeDamagedFiles) {
  const size_t runs = target().own ? 20000 : 1000;
  Mutation mutation(seeds_of(target()), target().words, 1);
  size_t taken = 0;
  for (size_t i = 0; i < runs && !HasFailure(); ++i) taken += run(target(), mutation.next());
  // Damage that is always refused, or never, would test one half of the reader alone.
  EXPECT_GT(taken, runs / 200);
  EXPECT_LT(taken, runs - runs / 200);
}

// What is quadratic in a file's length hides in small files: the same pieces over and over, up to 64 KiB.
TEST_P(Readers, AreQuickOnLargeFiles) {
  constexpr size_t kLarge = 64 * 1024;
  Mutation mutation(seeds_of(target()), target().words, 2);
  for (int i = 0; i < 12 && !HasFailure(); ++i) {
    const std::string whole = mutation.next();
    const size_t from = whole.size() * size_t(i % 4) / 8, length = 1 + whole.size() / 2;
    const std::string piece = whole.substr(from, length);
    if (piece.empty()) continue;
    std::string bytes = whole.substr(0, from);
    while (bytes.size() + piece.size() + whole.size() < kLarge) bytes += piece;
    run(target(), bytes + whole.substr(std::min(whole.size(), from + length)));
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, testing::Range<size_t>(0, targets().size()),
                         [](const auto& c) { return std::string(targets()[c.param].name); });

}  // namespace
}  // namespace wale::fuzz
