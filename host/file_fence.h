#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "host/json_document.h"
#include "host/scene.h"

namespace wale {

/// Which files a scene may name while others edit it: those below the scene's folder, symbolic links followed, and
/// those that it named when it was opened. Nothing is told of other files, not even whether they exist.
class FileFence {
 public:
  /// Open until closed: whatever is asked for is let in, and stays so.
  explicit FileFence(const std::filesystem::path& folder);
  void close() { closed_ = true; }

  bool admits(const std::filesystem::path& file);
  /// The same of a name with its number, "cloth_####.obj": true where all such files are let in.
  bool admits_all(const std::filesystem::path& pattern);
  /// Why a name is refused.
  std::string refusal(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::set<std::filesystem::path> named_;
  /// Names with a number among whose files no link was, and when their folder had changed last.
  std::map<std::filesystem::path, std::filesystem::file_time_type> without_links_;
  bool closed_ = false;
};

/// The scene of a document, as parse_scene(), which names such files only.
Scene fenced_scene(const JsonNode& document, const std::filesystem::path& file, FileFence& fence);

}  // namespace wale
