#include <algorithm>
#include <charconv>
#include <optional>

#include "geom/error.h"
#include "geom/frame_store.h"

namespace wale {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostDigits = 9;

/// A file's name with its number.
class NumberedName {
 public:
  explicit NumberedName(const fs::path& pattern) : folder_(pattern.parent_path()) {
    const std::string name = pattern.filename().string();
    const size_t begin = name.find('#'), end = name.find_first_not_of('#', begin);
    if (begin == std::string::npos)
      user_error("{}: names no frames; write # for each digit of the number, for example cloth_####.obj",
                 pattern.string());
    if (folder_.string().find('#') != std::string::npos ||
        (end != std::string::npos && name.find('#', end) < name.size()))
      user_error("{}: # stands in several places; the number can stand in one only", pattern.string());
    before_ = name.substr(0, begin);
    after_ = end == std::string::npos ? "" : name.substr(end);
    digits_ = (end == std::string::npos ? name.size() : end) - begin;
    if (digits_ > kMostDigits)
      user_error("{}: numbers of {} digits; at most {}", pattern.string(), digits_, kMostDigits);
  }

  fs::path file(long number) const { return folder_ / fmt::format("{}{:0{}}{}", before_, number, digits_, after_); }

  std::optional<long> number(const std::string& name) const {
    if (name.size() < before_.size() + digits_ + after_.size() || !name.starts_with(before_) || !name.ends_with(after_))
      return {};
    const size_t length = name.size() - before_.size() - after_.size();
    const std::string_view digits = std::string_view(name).substr(before_.size(), length);
    if (length > kMostDigits || (length > digits_ && digits[0] == '0')) return {};
    long value = 0;
    const auto [stop, failed] = std::from_chars(digits.data(), digits.data() + length, value);
    if (failed != std::errc() || stop != digits.data() + length || digits[0] == '-') return {};
    return value;
  }

  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
  std::string before_, after_;
  size_t digits_ = 0;
};

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
