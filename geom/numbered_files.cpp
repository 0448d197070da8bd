#include <algorithm>

#include "geom/error.h"
#include "geom/frame_store.h"
#include "geom/numbered_name.h"

namespace wale {
namespace {

namespace fs = std::filesystem;

class NumberedFiles : public FrameStore {
 public:
  NumberedFiles(const fs::path& pattern, MeshReader read) : name_(pattern), read_(std::move(read)) {
    std::error_code failed;
    const fs::path folder = name_.folder().empty() ? fs::path(".") : name_.folder();
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
      if (const auto number = name_.number(at->path().filename().string())) numbers_.push_back(*number);
    if (failed) user_error("{}: the folder {} cannot be read: {}", pattern.string(), folder.string(), failed.message());
    if (numbers_.empty())
      user_error("{}: no such files; for example {} is not there", pattern.string(), name_.file(0).filename().string());
    std::sort(numbers_.begin(), numbers_.end());
  }

  const std::vector<long>& numbers() const override { return numbers_; }
  std::string name(long number) const override { return name_.file(number).string(); }
  BaseMesh read(long number) const override { return read_(name_.file(number)); }
  uint64_t hash(long number) const override {
    const ByteSource source = ByteSource::of_file(name_.file(number));
    return hash_bytes(source, 0, source.size());
  }

 private:
  NumberedName name_;
  MeshReader read_;
  std::vector<long> numbers_;
};

}  // namespace

std::unique_ptr<FrameStore> numbered_files(const fs::path& pattern, MeshReader read) {
  return std::make_unique<NumberedFiles>(pattern, std::move(read));
}

}  // namespace wale
