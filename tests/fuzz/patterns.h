#pragma once
#include <string_view>

#include "geom/pattern.h"

namespace wale::fuzz {

/// Reads a tile from memory; what is accepted is finite, its periods, radius and stitches are positive, and its ends
/// pair up. True when accepted.
bool read_tile(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints);

}  // namespace wale::fuzz
