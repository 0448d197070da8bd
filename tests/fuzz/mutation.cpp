#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <iterator>

namespace wale::fuzz {
namespace {

constexpr std::string_view kExtreme[] = {"0",
                                         "-1",
                                         "1e-320",
                                         "1e308",
                                         "-1e308",
                                         "1e999",
                                         "nan",
                                         "inf",
                                         "2147483648",
                                         "4294967296",
                                         "1e-30",
                                         "9223372036854775807",
                                         "-9223372036854775808",
                                         "0.0"};

}  // namespace

Mutation::Mutation(std::vector<std::string> seeds, std::vector<std::string_view> words, uint64_t seed)
    : seeds_(std::move(seeds)), words_(std::move(words)), random_(seed) {}

std::string Mutation::next(size_t most) {
  std::string bytes = seeds_[below(seeds_.size())];
  for (size_t left = 1 + below(4); left > 0; --left) once(bytes);
  bytes.resize(std::min(bytes.size(), most));
  return bytes;
}

void Mutation::once(std::string& bytes) {
  const size_t at = below(bytes.size() + 1), length = std::min(bytes.size() - at, 1 + below(16));
  switch (below(8)) {
    case 0:
      if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      return;
    case 1:
      if (at < bytes.size()) bytes[at] = static_cast<char>(random_());
      return;
    case 2:
      bytes.erase(at, length);
      return;
    case 3:
      bytes.insert(at, bytes.substr(at, length));
      return;
    case 4:
      bytes.resize(at);
      return;
    case 5: {
      const std::string& other = seeds_[below(seeds_.size())];
      bytes = bytes.substr(0, at) + other.substr(below(other.size()));
      return;
    }
    case 6:
      if (!words_.empty()) bytes.insert(at, words_[below(words_.size())]);
      return;
    case 7: {  // a number of the text, if there is one behind this place
      const size_t from = bytes.find_first_of("0123456789", at);
      if (from == std::string::npos) return;
      const size_t to = std::min(bytes.find_first_not_of("0123456789.e-", from), bytes.size());
      bytes.replace(from, to - from, kExtreme[below(std::size(kExtreme))]);
      return;
    }
  }
}

}  // namespace wale::fuzz
