#pragma once
#include <string>
#include <vector>

namespace wale {

/// The end of an error message about a wrong word: `did you mean "fov"?` when a choice is near (edit distance with
/// transpositions at most a third of its length, at least 1), else `valid: "a", "b"`.
std::string nearest_choice(const std::string& word, const std::vector<std::string>& choices);

/// Edit distance where insertion, deletion, replacement and swapping two neighbours cost 1 each.
size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace wale
