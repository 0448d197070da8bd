#pragma once
#include <cmath>
#include <exception>
#include <string>

#include "geom/error.h"
#include "geom/vec.h"

namespace wale::fuzz {

/// A reader that broke its promise. No std::exception, so that nothing on the way swallows it: it ends a fuzzer, which
/// then keeps the input, and fails a test.
struct Broken {
  std::string what;
};

[[noreturn]] inline void broken(const std::string& what, const char* detail = "") { throw Broken{what + detail}; }

inline void expect(bool holds, const char* what) {
  if (!holds) broken(what);
}

inline bool finite(const dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }
inline bool finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// True when `read` ends well, false when it throws a user error of one line; nothing else may leave it.
template <typename Read>
bool accepted(Read&& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    if (error.fault() != Fault::user) broken("not the user's fault: ", error.what());
    for (const char* c = error.what(); *c; ++c)
      if (static_cast<unsigned char>(*c) < 0x20) broken("several lines: ", error.what());
    return false;
  } catch (const std::exception& error) {
    broken("an exception that is no user error: ", error.what());
  }
}

}  // namespace wale::fuzz
