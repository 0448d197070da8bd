#include "host/suggest.h"

#include <fmt/format.h>

#include <algorithm>

namespace wale {

size_t edit_distance(const std::string& a, const std::string& b) {
  // Optimal string alignment: rows i of the table; d[i][j] = distance of the first i and first j letters.
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string nearest_choice(const std::string& word, const std::vector<std::string>& choices) {
  const std::string* best = nullptr;
  size_t best_distance = 0;
  if (word.size() <= 64)  // the table is quadratic; no key is nearly as long
    for (const auto& choice : choices) {
      const size_t distance = edit_distance(word, choice);
      if (!best || distance < best_distance) best = &choice, best_distance = distance;
    }
  if (best && best_distance <= std::max<size_t>(1, best->size() / 3)) return fmt::format("did you mean \"{}\"?", *best);
  if (choices.empty()) return "none can be named here";
  return fmt::format("valid: \"{}\"", fmt::join(choices, "\", \""));
}

}  // namespace wale
