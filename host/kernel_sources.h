#pragma once
#include <map>
#include <string>

namespace wale {
/// Kernel sources compiled into the program, by path below kernels/ (for example "shared/wale_types.h").
const std::map<std::string, std::string>& embedded_kernels();
}  // namespace wale
