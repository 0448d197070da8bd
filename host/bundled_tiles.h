#pragma once
#include <map>
#include <string>
#include <vector>

namespace wale {

/// The tiles of scenes/patterns by the names of their files.
const std::map<std::string, std::string>& embedded_tiles();

/// Names of the tiles that a scene may call for as {"builtin": name}: the closed-form stockinette, then the relaxed
/// ones (docs/patterns.md).
std::vector<std::string> bundled_tiles();

}  // namespace wale
