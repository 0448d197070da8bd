#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// Refuses a PNG file with a chunk that is said to be longer than the rest of the file, with a user error naming
/// `file`: libpng reserves what a chunk says, up to 2 GiB, before it finds the file's end. What else may be wrong is
/// left to libpng. Layout: ISO/IEC 15948, section 5.3.
void require_whole_png_chunks(std::string_view bytes, const std::string& file);

/// Puts a text (tEXt, Latin-1) into a PNG file, behind its header.
void add_png_text(std::string& png, const std::string& name, const std::string& text);

/// The text of that name, where it stands before the pixels; `bytes` may end after them.
std::optional<std::string> png_text(std::string_view bytes, std::string_view name);

}  // namespace wale
