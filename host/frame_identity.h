#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/commands.h"
#include "host/file_stamp.h"
#include "host/world.h"

namespace wale {

/// Sequences that stay open, so that frames are not looked for anew each time.
class OpenSequences {
 public:
  explicit OpenSequences(MeshReader read) : read_(std::move(read)) {}
  std::shared_ptr<const MeshSequence> open(const SequenceSource& source);

 private:
  MeshReader read_;
  std::vector<std::shared_ptr<const MeshSequence>> open_;
};

/// Which picture a frame is.
class FrameIdentity {
 public:
  FrameIdentity(const RenderArgs& args, OpenSequences& sequences) : args_(args), sequences_(sequences) {}

  /// Sixteen hexadecimal digits that are equal for frames which are the same picture: the scene at that frame, size,
  /// samples, seed and accuracy, and the bytes of all files that it reads.
  std::string of(const Scene& scene, const std::vector<std::string>& overrides);

  /// A file that has changed since it was hashed, if there is one: of all frames so far where it is hashed or read but
  /// once, of the last frame where each has its own. What frames show is no longer known from then on, as some of what
  /// is read stays and some is read anew; so there is one from then on, even if it changes back.
  const std::optional<std::filesystem::path>& changed();

 private:
  struct Hashed {
    FileStamp stamp;  ///< from before
    uint64_t hash = 0;
  };
  uint64_t file(const std::filesystem::path& file);
  uint64_t mesh(const MeshSource& mesh, double shutter);
  void stamp(const MeshSequence& sequence, double from, double to);
  bool same(Hashed& file) const;

  const RenderArgs& args_;
  OpenSequences& sequences_;
  std::map<std::filesystem::path, Hashed> files_;
  std::map<std::filesystem::path, FileStamp> sequence_files_;  ///< rests, and files of all frames
  std::vector<FileStamp> frame_files_;                         ///< of sequences, of the last frame
  std::optional<std::filesystem::path> changed_;
};

}  // namespace wale
