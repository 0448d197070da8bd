#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace wale {

/// A file's name with its number: "cloth_####.obj", where the signs stand for at least so many digits.
class NumberedName {
 public:
  /// Throws a user error when the signs are absent or in several places.
  explicit NumberedName(const std::filesystem::path& pattern);

  static bool is_one(const std::filesystem::path& file) { return file.string().find('#') != std::string::npos; }

  std::filesystem::path file(long number) const;
  /// The number in a file's name (without its folder); nothing in another name.
  std::optional<long> number(const std::string& name) const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  size_t digits_ = 0;
};

}  // namespace wale
