#pragma once
#include <string>
#include <string_view>

namespace wale {

/// OpenMesh's readers of text files run past the end without noticing: stale numbers become corners, and a face that
/// claims two thousand million corners never ends. These look over a text PLY or OFF first and throw a user error
/// file:line where an element is missing, its line holds too few numbers, or one of them is none that a float can hold:
/// NaN, infinite, larger than 3.4e38; in a binary PLY where bytes are missing. A binary OFF is refused.
void require_whole_ply(std::string_view text, const std::string& file);
void require_whole_off(std::string_view text, const std::string& file);

}  // namespace wale
