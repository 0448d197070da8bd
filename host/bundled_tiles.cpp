#include "host/bundled_tiles.h"

namespace wale {

std::vector<std::string> bundled_tiles() {
  std::vector<std::string> names{"stockinette"};
  for (const auto& [file, text] : embedded_tiles()) names.push_back(file.substr(0, file.rfind('.')));
  return names;
}

}  // namespace wale
