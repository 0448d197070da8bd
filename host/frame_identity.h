#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/commands.h"
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

 private:
  uint64_t file(const std::filesystem::path& file);
  uint64_t mesh(const MeshSource& mesh, double shutter);

  const RenderArgs& args_;
  OpenSequences& sequences_;
  std::map<std::filesystem::path, uint64_t> files_;
};

}  // namespace wale
