// The same picture from every width of the explicit vectors, and from another OpenCL driver.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

Scene everything(int size, double wales) {
  const TemporaryFolder folder;
  return read_scene(folder.write("scene.json", everything_scene(size, wales)));
}

void expect_same_mean(const Image& a, const Image& b, const std::string& what) {
  size_t tests = 0;
  const double p = smallest_p(a, b, tests);
  EXPECT_GT(p, sidak(0.01, tests)) << what;
}

TEST(Lanes, EveryWidthGivesTheSamePicture) {
  Scene scene = everything(24, 30);
  scene.integrator.lanes = 16;
  const Picture reference = take(scene, 32, 1), independent = take(scene, 32, 2);
  const size_t pixels = size_t(reference.image.width) * reference.image.height;
  for (const int lanes : {1, 8}) {
    scene.integrator.lanes = lanes;
    const Picture picture = take(scene, 32, 1);
    expect_same_mean(picture.image, independent.image, std::to_string(lanes) + " lanes");
    // Same seed, same paths: each lane does what one alone would.
    EXPECT_EQ(different_pixels(reference.image, picture.image), 0) << lanes << " lanes, of " << pixels;
    EXPECT_GT(picture.counts.bounce, picture.counts.primary / 4) << "the fabric was not hit";
  }
}

TEST(Drivers, OclgrindGivesTheSamePicture) {
  const auto driver = oclgrind();
  if (driver.empty()) GTEST_SKIP() << "Oclgrind is not installed (apt-get install oclgrind)";
  const TemporaryFolder folder, vendors;
  vendors.write("oclgrind.icd", driver.string() + "\n");
  // A simulated second is long: few pixels, a coarse cloth, two scattering events.
  const auto scene = folder.write("scene.json", everything_scene(10, 12)), picture = folder / "oclgrind.exr";
  const std::vector<std::string> environment = {"OCL_ICD_VENDORS=" + vendors.path().string() + "/"};
  const Outcome listed = run_wale({"devices"}, environment);
  ASSERT_EQ(listed.status, 0) << listed.err;
  ASSERT_NE(listed.out.find("Oclgrind"), std::string::npos) << listed.out;
  const std::string shorter = "integrator.max_depth=2", coarser = "fabrics.0.tolerance=0.3";
  const Outcome run = run_wale({"render", scene.string(), "-o", picture.string(), "--spp", "8", "--quiet", "--set",
                                shorter, "--set", coarser, "--set", "integrator.seed=1"},
                               environment, 300);
  ASSERT_EQ(run.status, 0) << run.err;
  const Image image = means_and_variances(picture);
  const Scene same_scene = read_scene(scene, {shorter, coarser});

  // The same seed, hence the same paths: what is left is the rounding of another compiler's code.
  const Image same = take(same_scene, 8, 1).image;
  ASSERT_EQ(image.width, same.width);
  int differ = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        differ += std::abs(image.at(x, y)[c] - same.at(x, y)[c]) > 1e-4f * (1 + same.at(x, y)[c]);
  EXPECT_LE(differ, 3) << "channels of " << image.width * image.height << " pixels";

  // Another seed: the same mean. Of the whole picture, since the spread of eight samples says little about the error of
  // one pixel at a silhouette.
  const Image other = take(same_scene, 256, 2).image;
  const auto mean = mean_rgb(image), expected = mean_rgb(other);
  for (size_t c = 0; c < 3; ++c) {
    double variance = 0;
    for (const Image* i : {&image, &other})
      for (int y = 0; y < i->height; ++y)
        for (int x = 0; x < i->width; ++x) variance += i->at(x, y)[3 + c] / std::pow(double(i->width) * i->height, 2);
    const double z = (mean[c] - expected[c]) / std::sqrt(variance);
    EXPECT_GT(std::erfc(std::abs(z) / std::sqrt(2.0)), sidak(0.01, 3)) << "channel " << c;
  }
}

}  // namespace
}  // namespace wale::test
