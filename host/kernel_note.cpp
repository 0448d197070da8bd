#include "host/kernel_note.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

namespace wale {
namespace {

namespace fs = std::filesystem;

// As PoCL chooses it (lib/CL/pocl_cache.c, pocl_cache_init_topdir).
fs::path cache_folder() {
  const auto set = [](const char* name) -> const char* {
    const char* value = std::getenv(name);
    return value && *value ? value : nullptr;
  };
  if (const char* folder = set("POCL_CACHE_DIR")) return folder;
  if (const char* folder = set("XDG_CACHE_HOME")) return fs::path(folder) / "pocl" / "kcache";
  if (const char* folder = set("HOME")) return fs::path(folder) / ".cache" / "pocl" / "kcache";
  return "/tmp/pocl/kcache";
}

// A home folder may be shared by machines of different kinds; PoCL compiles for each.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  std::string name;
  for (std::string line; std::getline(in, line) && !line.empty();)
    if (line.starts_with("model name") || line.starts_with("flags")) name += line + '\n';
  return name;
}

// FNV-1a, 64 bits: the same in every build and run.
uint64_t hash(std::string_view text) {
  uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}

}  // namespace

KernelNote::KernelNote(const std::string& programs)
    : file_(cache_folder() / fmt::format("wale-{:016x}", hash(programs + processor()))) {}

bool KernelNote::cache_is_used() {
  const char* used = std::getenv("POCL_KERNEL_CACHE");
  return !used || *used == '1';
}

bool KernelNote::found() const {
  std::error_code error;
  return fs::exists(file_, error);
}

void KernelNote::leave() const { std::ofstream(file_, std::ios::binary); }

}  // namespace wale
