#pragma once
#include <string>

namespace wale {

/// OpenMesh's readers of text files run past the end without noticing: stale numbers become corners, and a face that
/// claims two thousand million corners never ends. These look over a text PLY or OFF first and throw a user error
/// file:line where an element is missing, its line holds too few numbers, or one of them is none that a float can hold:
/// NaN, infinite, larger than 3.4e38. A binary PLY passes (its reader notices);
/// a binary OFF is refused.
void require_whole_ply(const std::string& text, const std::string& file);
void require_whole_off(const std::string& text, const std::string& file);

}  // namespace wale
