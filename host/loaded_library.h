#pragma once

namespace wale {

/// What the function `table` of the library `name` returns, a table of functions. The library lies beside the program,
/// wherever that was moved to, else where both were built. Throws a user error when it is not there or cannot be
/// loaded. It stays loaded.
const void* load_table(const char* name, const char* table);

/// Throws that error where the library is missing, and loads nothing.
void require_library(const char* name);

}  // namespace wale
