#include "host/image_coder.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "geom/error.h"

namespace wale {
namespace {

namespace fs = std::filesystem;

// Beside the program, wherever that was moved to; else where both were built.
fs::path library() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {program, fs::path(WALE_BUILT_IN)})
    if (fs::path file = folder / kImageCoderLibrary; fs::exists(file, error)) return file;
  user_error("{}: is missing; it belongs into {}, beside the program", kImageCoderLibrary, program.string());
}

const ImageCoder* load() {
  const fs::path file = library();
  void* loaded = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = loaded ? dlsym(loaded, kImageCoderFunction) : nullptr;
  if (!function) user_error("{}: cannot be loaded: {}", file.string(), one_line(dlerror()));
  return reinterpret_cast<const ImageCoder* (*)()>(function)();
}

}  // namespace

const ImageCoder& image_coder() {
  static const ImageCoder* coder = load();
  return *coder;
}

void require_image_coder() { library(); }

}  // namespace wale
