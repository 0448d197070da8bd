#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace wale {

/// How many bytes OpenEXR reads for a value of this type that begins `bytes`, whatever its declared size: from the type
/// or from the value itself (channel lists, previews). Nothing for types that it takes as long as declared, and for
/// values that end within `bytes`' end. After "OpenEXR File Layout", section "Predefined Attribute Types".
std::optional<size_t> exr_value_size(std::string_view type, std::string_view bytes, size_t declared);

}  // namespace wale
