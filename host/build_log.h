#pragma once
#include <string>

namespace wale {

/// Keeps what a driver's compiler said in a file below $XDG_CACHE_HOME/wale (or ~/.cache/wale), or in the folder for
/// temporary files where that cannot be written, and returns its name; "" when neither can. `title` becomes part of it.
std::string keep_build_log(const std::string& title, const std::string& log);

/// The line of a log that says what is wrong: the first with "error:", else the first two that are not empty.
std::string first_error(const std::string& log);

}  // namespace wale
