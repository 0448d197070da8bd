#pragma once
#include <string>
#include <string_view>

namespace wale {

/// OpenMesh's readers of text files run past the end without noticing: stale numbers become corners, and a face that
/// claims two thousand million corners never ends. These look over a text PLY or OFF first and throw a user error
/// file:line where an element is missing or its line holds too few numbers, or, in a binary PLY, bytes are missing. A
/// binary OFF is refused.
void require_whole_ply(std::string_view text, const std::string& file);
void require_whole_off(std::string_view text, const std::string& file);

}  // namespace wale
