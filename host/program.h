#pragma once
#include <filesystem>
#include <string>

#include "host/device.h"

namespace wale {

/// Source of a kernel file with its includes expanded once each and #line directives that keep real file names in logs.
/// Files come from `kernel_dir` when it is not empty, else from those built into the program.
std::string expand_kernel_source(const std::string& file, const std::filesystem::path& kernel_dir = {});

/// Compiles one kernel file (path below kernels/) for a device. Throws a device error with the build log.
/// `options` are -D definitions and the like; W_LANES is added from the device's traits unless given.
cl::Program build_program(const Device& device, const std::string& file, const std::string& options = "",
                          const std::filesystem::path& kernel_dir = {});

/// The same from source text that may include kernel files; for tests.
cl::Program build_program_text(const Device& device, const std::string& text, const std::string& options = "");

}  // namespace wale
