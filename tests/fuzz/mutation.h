#pragma once
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace wale::fuzz {

/// Damages bytes a few times over: bits turned, pieces cut out, doubled, moved or taken from another file, words of the
/// format put in, numbers made extreme. The same random numbers give the same bytes on every machine.
class Mutation {
 public:
  Mutation(std::vector<std::string> seeds, std::vector<std::string_view> words, uint64_t seed);
  /// The next damaged file, at most `most` bytes.
  std::string next(size_t most = 4096);

 private:
  size_t below(size_t count) { return count ? random_() % count : 0; }
  void once(std::string& bytes);

  std::vector<std::string> seeds_;
  std::vector<std::string_view> words_;
  std::mt19937_64 random_;
};

}  // namespace wale::fuzz
