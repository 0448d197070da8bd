#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// Refuses an OpenEXR file whose header asks for more than the file can hold, with a user error naming `file`: OpenEXR
/// reserves what a header says, up to gigabytes, before it finds the file's end. What else may be wrong is left to
/// OpenEXR. Layout: "OpenEXR File Layout", openexr.com.
void require_plausible_exr(std::string_view bytes, const std::string& file);

/// The value of a text attribute of the first part, from the bytes that a file begins with; nothing where there is none.
std::optional<std::string> exr_text(std::string_view bytes, std::string_view name);

}  // namespace wale
