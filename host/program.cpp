#include "host/program.h"

#include <cctype>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "geom/error.h"
#include "host/build_log.h"
#include "host/device_fault.h"
#include "host/driver_crash.h"
#include "host/kernel_sources.h"

namespace wale {
namespace {

std::string kernel_text(const std::string& file, const std::filesystem::path& kernel_dir) {
  if (!kernel_dir.empty()) {
    std::ifstream in(kernel_dir / file, std::ios::binary);
    if (!in) user_error("{}: cannot read this kernel file", (kernel_dir / file).string());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  const auto& all = embedded_kernels();
  const auto found = all.find(file);
  if (found == all.end()) bug("kernels/{}: not built into the program", file);
  return found->second;
}

// Every include is expanded at its first mention: NVIDIA's binary cache looks at the top-level source only, and the
// embedded files have no folder to search.
void expand(const std::string& text, const std::string& file, const std::filesystem::path& kernel_dir,
            std::set<std::string>& done, std::string& out) {
  out += fmt::format("#line 1 \"{}\"\n", file);
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto hash = line.find_first_not_of(" \t");
    if (hash != std::string::npos && line.compare(hash, 10, "#include \"") == 0) {
      const auto from = hash + 10, to = line.find('"', from);
      const std::string name = line.substr(from, to - from);
      if (done.insert(name).second) {
        expand(kernel_text(name, kernel_dir), name, kernel_dir, done, out);
        out += fmt::format("#line {} \"{}\"\n", number + 1, file);
      } else {
        out += '\n';
      }
    } else {
      out += line;
      out += '\n';
    }
  }
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

bool mentions(const std::string& source, const std::string& name) {
  for (size_t at = source.find(name); at != std::string::npos; at = source.find(name, at + 1))
    if ((at == 0 || !is_word(source[at - 1])) && !is_word(source[at + name.size()])) return true;
  return false;
}

// Without the definitions that the source says nothing of: scenes that differ elsewhere then share its program.
std::string definitions_in(const std::string& source, const std::string& options) {
  std::istringstream words(options);
  std::string out;
  for (std::string word; words >> word;) {
    const std::string name = word.starts_with("-D") ? word.substr(2, word.find('=') - 2) : "";
    if (name.empty() || mentions(source, name)) out += (out.empty() ? "" : " ") + word;
  }
  return out;
}

ProgramText with_options(const DeviceTraits& traits, const std::string& file, std::string source, std::string options) {
  options += " -cl-std=CL1.2" + traits.build_options;
  if (traits.compiles_at_launch) options += " -cl-kernel-arg-info";  // a Rehearsal asks for it
  if (options.find("W_LANES") == std::string::npos) options += fmt::format(" -DW_LANES={}", traits.lanes);
  options = definitions_in(source, options);
  return {file, std::move(source), std::move(options)};
}

// What a Rehearsal promises; not valid where it promises nothing.
std::shared_future<void> ahead_of(const Device& device, const ProgramText& text) {
  const std::lock_guard lock(device.programs().mutex);
  const auto found = device.programs().ahead.find(text.key());
  return found != device.programs().ahead.end() ? found->second : std::shared_future<void>();
}

cl::Program compile(const Device& device, const ProgramText& text) {
  if (const auto ahead = ahead_of(device, text); ahead.valid()) ahead.wait();
  return build_now(device, text);
}

}  // namespace

std::string expand_kernel_source(const std::string& file, const std::filesystem::path& kernel_dir) {
  std::set<std::string> done{file};
  std::string out;
  expand(kernel_text(file, kernel_dir), file, kernel_dir, done, out);
  return out;
}

ProgramText program_text(const DeviceTraits& traits, const std::string& file, const std::string& options,
                         const std::filesystem::path& kernel_dir) {
  return with_options(traits, file, expand_kernel_source(file, kernel_dir), options);
}

cl::Program build_now(const Device& device, const ProgramText& text) {
  const std::string key = text.key();
  {
    const std::lock_guard lock(device.programs().mutex);
    const auto found = device.programs().programs.find(key);
    if (found != device.programs().programs.end()) return found->second;
  }
  const DriverCall guard;
  cl::Program program(device.context(), text.source);
  try {
    program.build({device.id()}, text.options.c_str());
  } catch (const cl::Error& e) {
    const std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.id());
    const std::string& name = device.traits().name;
    const std::string file = keep_build_log(text.file + " " + name, log + "\noptions: " + text.options + "\n");
    device_error("kernels/{}: does not compile for {}{}: {}; {}{}", text.file, name,
                 std::getenv("WALE_KERNEL_OPTIONS") ? " with the environment's WALE_KERNEL_OPTIONS" : "",
                 one_line(log.empty() ? opencl_fault(e) : first_error(log)),
                 file.empty() ? "the log could not be kept" : "the whole log is in ", file);
  }
  const std::lock_guard lock(device.programs().mutex);
  return device.programs().programs.emplace(key, program).first->second;
}

cl::Program build_program(const Device& device, const std::string& file, const std::string& options,
                          const std::filesystem::path& kernel_dir) {
  return compile(device, program_text(device.traits(), file, options, kernel_dir));
}

bool is_being_compiled(const Device& device, const std::string& file, const std::string& options,
                       const std::filesystem::path& kernel_dir) {
  const auto ahead = ahead_of(device, program_text(device.traits(), file, options, kernel_dir));
  return ahead.valid() && ahead.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

cl::Program build_program_text(const Device& device, const std::string& text, const std::string& options) {
  std::set<std::string> done;
  std::string out;
  expand(text, "test.cl", {}, done, out);
  return compile(device, with_options(device.traits(), "test.cl", out, options));
}

}  // namespace wale
