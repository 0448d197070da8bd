// A render shared by devices that have nothing in common: PoCL's vectors beside Oclgrind's interpreter, whose compiler
// and built-in functions are its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/wale_bench/picture_check.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr int kPixels = 64, kSamples = 8;
// One tile and its eight samples: all that Oclgrind, thousands of times slower, gets before PoCL has done the rest.
constexpr int kUnit = bench::kTilePixels * bench::kTilePixels * kSamples;

const std::string kScene = fmt::format(R"({{"wale": 1, "units": "mm",
 "camera": {{"position": [0, -15, 20], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 16}},
 "film": {{"size": [{0}, {0}]}}, "integrator": {{"max_depth": 1, "pool": {1}}},
 "materials": {{"yarn": {{"type": "ply", "preset": "wool", "color": [0.8, 0.5, 0.3]}}}},
 "fabrics": [{{"mesh": {{"generator": "swatch", "width": 12, "height": 12, "nu": 3, "nv": 3}},
   "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": 20}}, "tolerance": 0.3, "material": "yarn"}}],
 "lights": [{{"type": "environment", "radiance": [0.5, 0.6, 0.8], "up": [0, 0, 1]}}]}})",
                                       kPixels, kUnit);

/// Both drivers in one folder for the loader.
std::vector<std::string> both_drivers(const TemporaryFolder& vendors) {
  const char* given = std::getenv("OCL_ICD_VENDORS");
  const std::filesystem::path installed = given ? given : "/etc/OpenCL/vendors";
  if (std::filesystem::is_directory(installed))
    for (const auto& entry : std::filesystem::directory_iterator(installed))
      if (entry.path().extension() == ".icd") std::filesystem::copy(entry.path(), vendors.path());
  vendors.write("oclgrind.icd", oclgrind().string() + "\n");
  return {"OCL_ICD_VENDORS=" + vendors.path().string() + "/"};
}

/// Number of the device whose line or the one below it holds `name`, as `wale devices` lists them.
std::optional<int> number_of(const std::string& name, const std::string& list) {
  const size_t at = list.find(name);
  if (at == std::string::npos) return {};
  int number = -1, found = 0;
  std::istringstream lines(list.substr(0, at + name.size()));
  for (std::string line; std::getline(lines, line);)
    if (std::sscanf(line.c_str(), "%d:", &found) == 1) number = found;
  return number;
}

TEST(UnlikeDevices, ShareOnePicture) {
  if (oclgrind().empty()) GTEST_SKIP() << "Oclgrind is not installed (apt-get install oclgrind)";
  const TemporaryFolder folder, vendors;
  const auto environment = both_drivers(vendors);
  const std::string list = run_wale({"devices"}, environment).out;
  const auto pocl = number_of("Portable Computing Language", list), other = number_of("Oclgrind Simulator", list);
  if (!pocl || !other) GTEST_SKIP() << "PoCL is needed beside Oclgrind";
  const auto scene = folder.write("scene.json", kScene), picture = folder / "p.exr", stats = folder / "s.json";
  const auto picture_of = [&](const std::string& devices, int seed) {
    const Outcome run =
        run_wale({"render", scene.string(), "-o", picture.string(), "--spp", std::to_string(kSamples), "--quiet",
                  "--device", devices, "--set", fmt::format("integrator.seed={}", seed), "--stats", stats.string()},
                 environment, 400);
    EXPECT_EQ(run.status, 0) << run.err;
    return means_and_variances(picture);
  };
  const Image shared = picture_of(fmt::format("{},{}", *pocl, *other), 1);
  const auto devices = nlohmann::json::parse(file_text(stats))["devices"];
  ASSERT_EQ(devices.size(), 2u);
  const int theirs = devices[1]["samples"].get<int>();
  ASSERT_GE(theirs, kUnit) << "Oclgrind took part";
  ASSERT_EQ(theirs + devices[0]["samples"].get<int>(), kPixels * kPixels * kSamples);

  // The same seed: PoCL's pixels to the bit, Oclgrind's to a small part of their noise.
  const Image alone = picture_of(std::to_string(*pocl), 1);
  const size_t differ = different_pixels(shared, alone);
  EXPECT_GT(differ, 0u) << "the devices are not unlike";
  EXPECT_LE(differ, size_t(theirs / kSamples));
  const bench::TileMeans a = bench::tile_means(shared), b = bench::tile_means(alone);
  for (size_t i = 0; i < a.mean.size(); ++i)
    EXPECT_LE(std::abs(a.mean[i] - b.mean[i]), tolerance::kShareOfNoise * b.error[i]) << "tile " << i / 3;

  // Another seed: the Z-test. The three colours are one light's and go together, so that the mean of z^2 has the
  // standard deviation of a mean of as many squares as there are tiles.
  const auto check = bench::compare_tiles(bench::tile_means(picture_of(std::to_string(*pocl), 2)), a);
  EXPECT_LT(check.largest_z, bench::kLargestZ);
  const double tiles = double(a.tiles_x) * a.tiles_y;
  EXPECT_NEAR(check.mean_z2, 1, tolerance::kStandardErrors * std::sqrt(2 / tiles));
}

}  // namespace
}  // namespace wale::test
