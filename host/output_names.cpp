#include "host/output_names.h"

#include "geom/error.h"

namespace wale {
namespace fs = std::filesystem;

void OutputNames::add(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  auto known = folders_.find(folder);
  if (known == folders_.end()) {
    std::error_code failed;
    const fs::path real = fs::weakly_canonical(folder, failed);
    known = folders_.emplace(folder, failed ? folder : real).first;
  }
  if (!names_.insert(known->second / file.filename()).second)
    user_error("{}: would be written twice; give each output a name of its own", file.string());
}

}  // namespace wale
