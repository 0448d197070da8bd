#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace wale {

/// Exit status of the program, by whose fault it is.
enum class Fault { user = 1, device = 2, bug = 3 };

/// The text on one line: control characters, from a file's name or its content, become blanks.
inline std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  return text;
}

/// Every failure leaves as one of these; `what()` is one line: file, place, what is wrong, the nearest valid choice.
/// Only a device's build log keeps its lines.
class Error : public std::runtime_error {
 public:
  Error(Fault fault, const std::string& line)
      : std::runtime_error(fault == Fault::user ? one_line(line) : line), fault_(fault) {}
  Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

/// Throws an Error that the user can mend (exit status 1).
template <typename... Args>
[[noreturn]] void user_error(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(Fault::user, fmt::format(format, std::forward<Args>(args)...));
}

/// Throws an Error of the device or its driver (exit status 2).
template <typename... Args>
[[noreturn]] void device_error(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(Fault::device, fmt::format(format, std::forward<Args>(args)...));
}

/// Throws an Error that is Wale's own fault (exit status 3).
template <typename... Args>
[[noreturn]] void bug(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(Fault::bug, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace wale
