// The kernels under Oclgrind's checks: reads and writes outside buffers, values used before they are set, work-items
// that race for one address, and wrong calls of the API.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "host/image.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

struct Case {
  const char* name;
  std::string materials, fabric, objects, lights;  ///< parts of the scene, JSON
};

const std::string kSun = R"({"type": "sphere", "position": [-30, -20, 40], "radius": 5, "radiance": 40})";
const std::string kSky = R"({"type": "environment", "radiance": [0.5, 0.6, 0.8], "up": [0, 0, 1]})";
const std::string kWool = R"("yarn": {"type": "ply", "preset": "wool", "color": [0.8, 0.5, 0.3]})";
const std::string kFloor = R"("floor": {"type": "coated", "color": [0.4, 0.4, 0.5]})";
const std::string kGround = R"({"type": "ground", "up": [0, 0, 1], "height": -4, "extent": 30, "material": "floor"})";
const std::string kStriped =
    R"("yarn": {"type": "ply", "preset": "silk", "heather": {"yarn": 0.1, "ply": 0.1},
       "stripes": [{"color": [0.8, 0.1, 0.1], "length": 7}, {"color": "#ffffff", "length": 3}]})";

std::string scene_of(const Case& c, int size) {
  return fmt::format(R"({{"wale": 1, "units": "mm",
 "camera": {{"position": [10, -40, 45], "look_at": [0, 0, 1], "up": [0, 0, 1], "fov": 24}},
 "film": {{"size": [{0}, {0}]}}, "integrator": {{"max_depth": 3}}, "materials": {{{1}}},
 "fabrics": [{{"mesh": {{"generator": "swatch", "width": 24, "height": 24, "nu": 3, "nv": 3}},
   "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": 10}}, "tolerance": 0.3, "material": "yarn"{2}}}],
 "objects": [{3}], "lights": [{4}]}})",
                     size, c.materials, c.fabric, c.objects, c.lights);
}

/// One report of the log: its lines, and the kernel that it names.
struct Report {
  std::string text, kernel;
};

std::vector<Report> reports(const std::filesystem::path& log) {
  std::istringstream in(file_text(log));
  std::vector<Report> found(1);
  for (std::string line; std::getline(in, line);) {
    const size_t name = line.find("Kernel: ");
    if (name != std::string::npos) found.back().kernel = line.substr(name + 8);
    // A report starts at the margin and its details are indented.
    if (!line.empty() && line[0] != '\t' && !found.back().text.empty()) found.emplace_back();
    if (line.find_first_not_of(" \t") != std::string::npos) found.back().text += line + "\n";
  }
  if (found.back().text.empty()) found.pop_back();
  return found;
}

/// Oclgrind 21.10 does not see what clEnqueueFillBuffer sets, so it takes the films that start as zeros for
/// uninitialised where a sample is added to them.
bool added_to_a_filled_film(const Report& report) {
  return report.text.starts_with("Uninitialized value written to global memory") &&
         (report.kernel == "accumulate" || report.kernel == "accumulate_aov");
}

void check(const Case& c, int size, const std::string& lanes) {
  const auto driver = oclgrind();
  if (driver.empty()) GTEST_SKIP() << "Oclgrind is not installed (apt-get install oclgrind)";
  const TemporaryFolder folder, vendors;
  vendors.write("oclgrind.icd", driver.string() + "\n");
  folder.write("sky.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n") +
                              std::string("\x80\x80\x90\x81\x20\x40\x80\x80\x10\x10\x10\x80\xf0\xf0\xe0\x84"
                                          "\x40\x40\x20\x80\x30\x30\x30\x80\x20\x20\x20\x80\x10\x10\x10\x80",
                                          32));
  const auto scene = folder.write("scene.json", scene_of(c, size)), log = folder / "log.txt";
  const Outcome run = run_wale({"render", scene.string(), "-o", (folder / "p.exr").string(), "--spp", "1", "--quiet",
                                "--set", "integrator.lanes=" + lanes},
                               {"OCL_ICD_VENDORS=" + vendors.path().string() + "/", "OCLGRIND_LOG=" + log.string(),
                                "OCLGRIND_UNINITIALIZED=1", "OCLGRIND_DATA_RACES=1", "OCLGRIND_CHECK_API=1"},
                               600);
  ASSERT_EQ(run.status, 0) << run.err;
  size_t named = 0, unnamed = 0;
  for (const Report& report : reports(log)) {
    if (added_to_a_filled_film(report)) {
      ++named;
    } else if (++unnamed <= 5) {
      ADD_FAILURE() << c.name << ": " << report.text;
    }
  }
  EXPECT_EQ(unnamed, 0u);
  EXPECT_GT(named, 0u) << "the checks were not on";
}

// What most scenes use, in one small picture each; the rest in the long tests.
const std::vector<Case>& short_cases() {
  static const std::vector<Case> cases = {
      {"PliesWithMapsAndStripes", kStriped + ", " + kFloor, R"(, "detail": "maps", "yarn": {"plies": 2})", kGround,
       kSun + ", " + kSky},
      {"Fibres", R"("yarn": {"type": "ply", "preset": "silk", "fibres": {"count": 4}})", R"(, "detail": "fibres")", "",
       R"({"type": "quad", "position": [0, -20, 40], "look_at": [0, 0, 0], "width": 20, "height": 20, "radiance": 9})"},
  };
  return cases;
}

const std::vector<Case>& long_cases() {
  static const std::vector<Case> cases = {
      {"Plies", kWool, "", "", kSun},
      {"PaperDetail", kWool, R"(, "detail": "paper")", "", kSun},
      {"Maps", kWool, R"(, "detail": "maps", "yarn": {"plies": 4})", "", kSun + ", " + kSky},
      {"Flyaways", kWool, R"(, "flyaways": {"hairs": 0.5, "loops": 0.5})", "", kSun},
      {"ManyFibres", R"("yarn": {"type": "ply", "preset": "mohair", "fibres": {"count": 12}})",
       R"(, "detail": "fibres")", "", kSun + ", " + kSky},
      {"PlyColours", R"("yarn": {"type": "ply", "plies": [[0.8, 0.1, 0.1], "#20c040"]})", "", "", kSun},
      {"MeshLight", kWool, "", "",
       R"({"type": "mesh", "mesh": {"generator": "swatch", "width": 9, "height": 9, "nu": 3, "nv": 3}, "radiance": 5,
           "transform": {"translate": [0, 0, 30]}})"},
      {"EnvironmentImage", kWool, "", "", R"({"type": "environment", "file": "sky.hdr", "up": [0, 0, 1]})"},
      {"Surfaces", kWool + ", " + kFloor + R"(, "matt": {"type": "diffuse", "color": [0.9, 0.2, 0.2]})", "",
       kGround + R"(, {"type": "sphere", "center": [4, 4, 4], "radius": 3, "material": "matt"})", kSun + ", " + kSky},
  };
  return cases;
}

TEST(Oclgrind, FindsNothing) {
  for (const Case& c : short_cases()) {
    SCOPED_TRACE(c.name);
    check(c, 4, "0");
    if (IsSkipped()) return;
  }
}

class OclgrindLong : public testing::TestWithParam<size_t> {};

TEST_P(OclgrindLong, FindsNothing) {
  const char* is_long = std::getenv("WALE_LONG_TESTS");
  if (!is_long || std::string(is_long) != "1") GTEST_SKIP() << "long test: ./wale test --long";
  check(long_cases()[GetParam()], 16, GetParam() % 2 ? "8" : "1");
}

INSTANTIATE_TEST_SUITE_P(Scenes, OclgrindLong, testing::Range<size_t>(0, long_cases().size()),
                         [](const auto& c) { return std::string(long_cases()[c.param].name); });

}  // namespace
}  // namespace wale::test
