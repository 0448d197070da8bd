#include "host/file_fence.h"

#include <algorithm>
#include <chrono>

#include "geom/error.h"
#include "geom/numbered_name.h"

namespace wale {
namespace fs = std::filesystem;
namespace {

fs::path resolved(const fs::path& file) {
  std::error_code failed;
  const fs::path full = fs::weakly_canonical(file, failed);
  return failed ? fs::path() : full;
}

}  // namespace

FileFence::FileFence(const fs::path& folder) : folder_(resolved(folder.empty() ? fs::path(".") : folder)) {}

bool FileFence::admits(const fs::path& file) {
  const fs::path full = resolved(file);
  if (full.empty()) return false;
  if (!closed_) named_.insert(full);
  if (named_.contains(full)) return true;
  return std::mismatch(folder_.begin(), folder_.end(), full.begin(), full.end()).first == folder_.end();
}

bool FileFence::admits_all(const fs::path& pattern) {
  if (!admits(pattern)) return false;  // before a folder is looked into
  if (!NumberedName::is_one(pattern)) return true;
  const NumberedName name(pattern);
  std::error_code failed;
  const fs::path folder = name.folder().empty() ? fs::path(".") : name.folder();
  const auto changed = fs::last_write_time(folder, failed);
  if (failed) return true;  // nothing to be read there
  const auto known = without_links_.find(pattern);
  if (known != without_links_.end() && known->second == changed) return true;
  bool links = false;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (std::error_code none; at->is_symlink(none) && name.number(at->path().filename().string())) {
      links = true;
      if (!admits(at->path())) return false;
    }
  // Where links lead may change elsewhere; and a folder may change again within one tick of its clock.
  constexpr std::chrono::seconds kTick{2};
  if (!failed && !links && fs::file_time_type::clock::now() - changed > kTick) without_links_[pattern] = changed;
  return true;
}

std::string FileFence::refusal(const std::string& name) const {
  return fmt::format("\"{}\" lies outside of the scene's folder; give a file in {}", name, folder_.string());
}

}  // namespace wale
