// Kernels built for what a scene calls for against kernels with everything built in (`--features all`): the same
// picture, time per vertex of a path, compile time, machine code and stack. Usage:
//   specialised_bench [-r REPEATS] SCENE...
// writes the tables of bench/results/specialised.md, the last one for the first scene. Times: CPU seconds of all
// threads, the two kinds of programs in turn, median of the ratios within each turn. Compiling: CPU seconds of a fresh
// process with an empty cache of PoCL until the first picture is done, less those of the picture once more. Code and
// stack: of the largest machine code that the cache then holds for a kernel; on devices that say so, the kernel's
// private memory.
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>

#include "bench/wale_bench/clock.h"
#include "geom/base_mesh.h"
#include "host/image.h"
#include "host/program.h"
#include "host/render.h"
#include "host/stage_profile.h"

namespace {

using namespace wale;
using bench::median;

constexpr int kSamples = 16;
const std::array<const char*, 2> kKinds = {"needed", "all"};
// Kernels whose time, code and stack are shown.
const std::vector<std::pair<const char*, const char*>> kKernels = {{"intersect", "stages/intersect.cl"},
                                                                   {"connect", "stages/connect.cl"},
                                                                   {"shade_ply", "stages/shade_ply.cl"},
                                                                   {"shade_fibre", "stages/shade_fibre.cl"},
                                                                   {"shade_surface", "stages/shade_surface.cl"}};

struct Loaded {
  Scene scene;
  World world;
  explicit Loaded(const std::string& file)
      : scene(read_scene(file)),
        world(build_world(
            scene, {[](const auto& f) { return read_mesh(f); }, [](const auto& f) { return read_image(f, true); }})) {}
};

RenderOptions options_of(const Features& also) {
  RenderOptions options;
  options.spp = kSamples;
  options.also = also;
  return options;
}

Features all_or_nothing(bool all) { return all ? Features::everything() : Features(); }

// In a process of its own: prints the CPU seconds that compiling took.
int compile_once(const std::string& file, bool all) {
  const Device device = Device::open();
  const Loaded loaded(file);
  const SceneDevice scene(device, loaded.world);
  double seconds[2];
  for (double& s : seconds) {
    const std::clock_t start = std::clock();
    render(device, loaded.world, scene, loaded.scene.integrator, options_of(all_or_nothing(all)));
    s = double(std::clock() - start) / CLOCKS_PER_SEC;
  }
  fmt::print("{}\n", seconds[0] - seconds[1]);
  return 0;
}

std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return out;
  char line[4096];
  while (fgets(line, sizeof(line), pipe)) out += line;
  pclose(pipe);
  return out;
}

struct Code {
  size_t bytes = 0, stack = 0;
};

// Size of the machine code, and the largest frame of its functions.
Code code_of(const std::filesystem::path& object) {
  Code code;
  const std::string sections = output_of("objdump -h -j .text '" + object.string() + "' 2>/dev/null");
  if (const auto at = sections.find(".text"); at != std::string::npos)
    code.bytes = std::stoul(sections.substr(at + 5), nullptr, 16);
  const std::string frames = output_of("objdump -d --no-show-raw-insn '" + object.string() +
                                       "' 2>/dev/null | grep -o 'sub *\\$0x[0-9a-f]*,%rsp'");
  for (size_t at = frames.find("$0x"); at != std::string::npos; at = frames.find("$0x", at + 1)) {
    const size_t frame = std::stoul(frames.substr(at + 3), nullptr, 16);
    if (frame < (1u << 24)) code.stack = std::max(code.stack, frame);  // a frame is given back by adding 2^64 - n
  }
  return code;
}

struct Compiled {
  double seconds = 0;
  std::map<std::string, Code> kernels;
};

Compiled compile(const std::string& program, const std::string& file, bool all) {
  std::string folder = (std::filesystem::temp_directory_path() / "wale_specialised_XXXXXX").string();
  if (!mkdtemp(folder.data())) return {};
  Compiled out;
  out.seconds = std::atof(
      output_of(fmt::format("POCL_CACHE_DIR='{}' '{}' --compile '{}' {}", folder, program, file, kKinds[all])).c_str());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".so") continue;
    const Code code = code_of(entry.path());
    for (const auto& [kernel, source] : kKernels) {
      if (entry.path().string().find(fmt::format("/{}/", kernel)) == std::string::npos) continue;
      Code& largest = out.kernels[kernel];
      if (code.bytes > largest.bytes) largest = code;
    }
  }
  std::filesystem::remove_all(folder);
  return out;
}

struct Times {
  std::array<std::vector<double>, 2> ns_per_vertex;
  std::map<std::string, std::vector<double>> ratio;  // of all over needed, per kernel and ""
  bool same = true;
};

size_t different_values(const Image& a, const Image& b) {
  size_t different = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int c = 0; c < 6; ++c) different += a.at(x, y)[c] != b.at(x, y)[c];
  return different;
}

Times time_both(const Device& device, const Loaded& loaded, const Features& also, int repeats) {
  const SceneDevice scene(device, loaded.world);
  Times out;
  for (int k = 0; k < repeats + 1; ++k) {
    std::array<Rendered, 2> r;
    for (int turn = 0; turn < 2; ++turn) {
      const int all = (turn + k) % 2;
      RenderOptions options = options_of(all ? also : Features());
      options.count_cpu_time = device.traits().cpu;
      r[all] = render(device, loaded.world, scene, loaded.scene.integrator, options);
    }
    out.same &= different_values(r[0].image, r[1].image) == 0;
    if (k == 0) continue;  // compiles
    for (int all = 0; all < 2; ++all) out.ns_per_vertex[all].push_back(ns_per_vertex(r[all].counts));
    out.ratio[""].push_back(out.ns_per_vertex[1].back() / out.ns_per_vertex[0].back());
    for (const auto& [kernel, source] : kKernels)
      if (r[0].counts.stages.contains(kernel) && r[0].counts.stages.at(kernel).items)
        out.ratio[kernel].push_back(r[1].counts.stages.at(kernel).seconds / r[0].counts.stages.at(kernel).seconds);
  }
  return out;
}

void print_header() {
  fmt::print("| scene | picture | ns per vertex, needed | all | all / needed | compiling, CPU s, needed | all |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
}

std::string kernel_rows(const std::string& scene, const Times& times, const std::array<Compiled, 2>& compiled) {
  std::string rows;
  for (const auto& [kernel, source] : kKernels) {
    const auto ratio = times.ratio.find(kernel);
    if (ratio == times.ratio.end()) continue;
    rows += fmt::format("| {} | {} | {:.2f} |", scene, kernel, median(ratio->second));
    for (const Compiled& c : compiled) {
      const auto code = c.kernels.find(kernel);
      rows += code == c.kernels.end()
                  ? std::string(" - | - |")
                  : fmt::format(" {:.1f} | {} |", double(code->second.bytes) / 1024, code->second.stack);
    }
    rows += '\n';
  }
  return rows;
}

// What the driver says that a kernel's work-item keeps outside of registers, bytes.
uint64_t private_bytes(const Device& device, const Loaded& loaded, bool all, const char* kernel, const char* file) {
  const Features features =
      features_of(device.traits(), loaded.world, loaded.scene.integrator, options_of(all_or_nothing(all)));
  const cl::Kernel built(build_program(device, file, features.options()), kernel);
  return built.getWorkGroupInfo<CL_KERNEL_PRIVATE_MEM_SIZE>(device.id());
}

// What each structure costs a scene that has none of it.
void print_alone(const Device& device, const std::string& file, int repeats) {
  const std::vector<std::pair<const char*, bool Features::*>> members = {
      {"single fibres", &Features::fibres},
      {"procedural leaves", &Features::procedural},
      {"triangles", &Features::triangles},
      {"spheres", &Features::spheres},
      {"fibre maps", &Features::detail},
      {"colours that vary", &Features::ply_colors},
      {"features of the first hit", &Features::aovs}};
  const Loaded loaded(file);
  fmt::print("\nBuilt in beside what {} calls for, time with it over time without:\n\n", file);
  fmt::print("| structure | per vertex | intersect | connect | shade_ply |\n|---|---|---|---|---|\n");
  for (const auto& [name, member] : members) {
    Features also;
    also.*member = true;
    const Times times = time_both(device, loaded, also, repeats);
    fmt::print("| {} | {:.3f} |", name, median(times.ratio.at("")));
    for (const char* kernel : {"intersect", "connect", "shade_ply"})
      fmt::print(" {:.3f} |", times.ratio.contains(kernel) ? median(times.ratio.at(kernel)) : 0.0);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "--compile") return compile_once(words[1], words[2] == kKinds[1]);
  int repeats = 9;
  if (words.size() > 1 && words[0] == "-r") {
    repeats = std::max(1, std::atoi(words[1].c_str()));
    words.erase(words.begin(), words.begin() + 2);
  }
  const std::string program = std::filesystem::canonical("/proc/self/exe").string();
  const Device device = Device::open();
  fmt::print("Device: {}; {} samples a pixel, {} repeats.\n\n", device.traits().name, kSamples, repeats);
  print_header();
  std::string rows;
  bool same = true;
  for (const std::string& file : words) {
    const std::string name = std::filesystem::path(file).stem().string();
    std::array<Compiled, 2> compiled;
    if (device.traits().compiles_at_launch)
      for (int all = 0; all < 2; ++all) compiled[all] = compile(program, file, all);
    const Loaded loaded(file);
    const Times times = time_both(device, loaded, Features::everything(), repeats);
    same &= times.same;
    fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.2f} | {:.1f} | {:.1f} |\n", name, times.same ? "same" : "DIFFERENT",
               median(times.ns_per_vertex[0]), median(times.ns_per_vertex[1]), median(times.ratio.at("")),
               compiled[0].seconds, compiled[1].seconds);
    std::fflush(stdout);
    rows += kernel_rows(name, times, compiled);
    if (device.traits().compiles_at_launch) continue;
    for (const auto& [kernel, source] : kKernels)
      if (times.ratio.contains(kernel))
        rows += fmt::format("| {} | {} | private bytes | {} | | {} | |\n", name, kernel,
                            private_bytes(device, loaded, false, kernel, source),
                            private_bytes(device, loaded, true, kernel, source));
  }
  fmt::print(
      "\n| scene | kernel | time, all / needed | code, KiB, needed | stack, bytes, needed | code, all | stack, all "
      "|\n");
  fmt::print("|---|---|---|---|---|---|---|\n{}", rows);
  if (!words.empty()) print_alone(device, words.front(), repeats);
  return same ? 0 : 1;
}
