#pragma once
#include <filesystem>
#include <string>

namespace wale {

/// A file in PoCL's cache that says: these programs were compiled into it. It goes when the cache is removed.
class KernelNote {
 public:
  /// `programs`: whatever decides what is compiled; the processor is added to it.
  explicit KernelNote(const std::string& programs);
  /// False where PoCL keeps nothing (POCL_KERNEL_CACHE=0).
  static bool cache_is_used();
  bool found() const;
  /// Where it cannot be written nothing happens: the next start compiles ahead once more.
  void leave() const;

 private:
  std::filesystem::path file_;
};

}  // namespace wale
