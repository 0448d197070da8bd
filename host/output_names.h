#pragma once
#include <filesystem>
#include <map>
#include <set>

namespace wale {

/// Names that one command writes to, each its own.
class OutputNames {
 public:
  /// Throws a user error where an earlier name is the same one in the same folder.
  void add(const std::filesystem::path& file);

 private:
  std::map<std::filesystem::path, std::filesystem::path> folders_;  ///< as named, and links followed
  std::set<std::filesystem::path> names_;
};

}  // namespace wale
