#pragma once
#include <string>
#include <string_view>

namespace wale {

/// OpenMesh's reader of text files runs past the end without noticing: stale numbers become corners, and a face that
/// claims two thousand million corners never ends. This looks over a PLY first and throws a user error file:line where
/// an element is missing, its line holds too few numbers, or one of them is none that a float can hold: NaN, infinite,
/// larger than 3.4e38; in a binary PLY where bytes are missing.
void require_whole_ply(std::string_view text, const std::string& file);

}  // namespace wale
