#pragma once
#include <filesystem>
#include <string>

#include "host/device.h"

namespace wale {

/// Source of a kernel file with its includes expanded once each and #line directives that keep real file names in logs.
/// Files come from `kernel_dir` when it is not empty, else from those built into the program.
std::string expand_kernel_source(const std::string& file, const std::filesystem::path& kernel_dir = {});

/// What a driver is given: the whole source and the options.
struct ProgramText {
  std::string file, source, options;
  std::string key() const { return options + '\n' + source; }
};
ProgramText program_text(const DeviceTraits& traits, const std::string& file, const std::string& options = "",
                         const std::filesystem::path& kernel_dir = {});

/// Compiles a program, or takes it from the device's cache. Throws a device error of one line that names the kernel
/// file and the file in which the compiler's log is kept. Does not wait for a Rehearsal.
cl::Program build_now(const Device& device, const ProgramText& text);

/// Compiles one kernel file (path below kernels/) for a device. Throws as build_now().
/// `options` are -D definitions and the like; W_LANES is added from the device's traits unless given.
cl::Program build_program(const Device& device, const std::string& file, const std::string& options = "",
                          const std::filesystem::path& kernel_dir = {});

/// True while a Rehearsal compiles that program, so that build_program() would wait.
bool is_being_compiled(const Device& device, const std::string& file, const std::string& options = "",
                       const std::filesystem::path& kernel_dir = {});

/// The same from source text that may include kernel files; for tests.
cl::Program build_program_text(const Device& device, const std::string& text, const std::string& options = "");

}  // namespace wale
