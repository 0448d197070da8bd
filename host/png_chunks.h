#pragma once
#include <string>
#include <string_view>

namespace wale {

/// Refuses a PNG file with a chunk that is said to be longer than the rest of the file, with a user error naming
/// `file`: libpng reserves what a chunk says, up to 2 GiB, before it finds the file's end. What else may be wrong is
/// left to libpng. Layout: ISO/IEC 15948, section 5.3.
void require_whole_png_chunks(std::string_view bytes, const std::string& file);

}  // namespace wale
