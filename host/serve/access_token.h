#pragma once
#include <string>
#include <string_view>

namespace wale {

/// 128 random bits of the operating system as 32 hexadecimal digits: whoever knows them may use the editor.
std::string make_access_token();

/// Equality of texts of any length in a time that does not depend on where they differ.
bool same_secret(std::string_view a, std::string_view b);

}  // namespace wale
