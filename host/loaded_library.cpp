#include "host/loaded_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "geom/error.h"

namespace wale {
namespace {

namespace fs = std::filesystem;

fs::path find_library(const char* name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {program, fs::path(WALE_BUILT_IN)})
    if (fs::path file = folder / name; fs::exists(file, error)) return file;
  user_error("{}: is missing; it belongs into {}, beside the program", name, program.string());
}

}  // namespace

const void* load_table(const char* name, const char* table) {
  const fs::path file = find_library(name);
  void* loaded = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = loaded ? dlsym(loaded, table) : nullptr;
  if (!function) user_error("{}: cannot be loaded: {}", file.string(), one_line(dlerror()));
  return reinterpret_cast<const void* (*)()>(function)();
}

void require_library(const char* name) { find_library(name); }

}  // namespace wale
