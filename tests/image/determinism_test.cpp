// A picture depends on the scene, the samples and the seed alone: bit for bit the same in every run, with any pool of
// paths and any number of threads.
#include <gtest/gtest.h>

#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/run_program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

constexpr int kSamples = 20;  // not a multiple of the eight scrambles: the last pass is a short one

// Fabric, ground, sphere light, environment and features: everything has its own queue, buffer or random numbers.
Scene everything() {
  const TemporaryFolder folder;
  return read_scene(folder.write("scene.json", everything_scene(36, 30)));
}

size_t coloured(const Image& image) {
  size_t n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += image.at(x, y)[0] != image.at(0, 0)[0];
  return n;
}

TEST(Determinism, TwoRunsGiveTheSameBytes) {
  const Scene scene = everything();
  const Picture a = take(scene, kSamples, 3, 0, true), b = take(scene, kSamples, 3, 0, true);
  EXPECT_EQ(different_pixels(a.image, b.image), 0u);
  EXPECT_EQ(a.counts.bounce, b.counts.bounce);
  EXPECT_EQ(a.counts.shadow, b.counts.shadow);
  // The comparison sees something: another seed is another picture nearly everywhere but in the sky.
  const Picture other = take(scene, kSamples, 4, 0, true);
  const size_t pixels = size_t(a.image.width) * a.image.height;
  EXPECT_GT(coloured(a.image), pixels / 2);
  EXPECT_GT(different_pixels(a.image, other.image), coloured(a.image) * 9 / 10);
  EXPECT_LT(coloured(a.image), pixels) << "some pixels meet nothing";
}

TEST(Determinism, EveryPoolGivesTheSameBytes) {
  const Scene scene = everything();
  const Picture expected = take(scene, kSamples, 3, 65536, true);
  // Fewer paths than pixels, not a multiple of the work-group, of the tiles or of the compaction's chunks, a prime, and
  // about the least that is allowed.
  for (const uint32_t pool : {1000u, 4099u, 257u, 65u}) {
    const Picture picture = take(scene, kSamples, 3, pool, true);
    EXPECT_EQ(different_pixels(expected.image, picture.image), 0u) << "pool " << pool;
    EXPECT_EQ(expected.counts.shadow, picture.counts.shadow) << "pool " << pool;
  }
}

TEST(Determinism, EveryNumberOfThreadsGivesTheSameBytes) {
  const TemporaryFolder folder;
  const auto scene = folder.write("scene.json", everything_scene(48, 30));
  std::vector<Image> images;
  std::vector<std::string> devices;
  for (const std::string threads : {"1", "2"}) {
    const std::vector<std::string> environment = {"POCL_MAX_PTHREAD_COUNT=" + threads};
    const Outcome listed = run_wale({"devices"}, environment);
    ASSERT_EQ(listed.status, 0) << listed.err;
    devices.push_back(listed.out);
    const auto picture = folder / ("threads" + threads + ".exr");
    const Outcome run =
        run_wale({"render", scene.string(), "-o", picture.string(), "--spp", "20", "--quiet"}, environment);
    ASSERT_EQ(run.status, 0) << run.err;
    images.push_back(read_image(picture));
  }
  ASSERT_GT(images[0].channels.size(), 15u) << "features are compared too";
  EXPECT_GT(coloured(images[0]), size_t(images[0].width) * images[0].height / 2);
  EXPECT_EQ(different_pixels(images[0], images[1]), 0u);
  if (devices[0].find("Portable Computing Language") == std::string::npos)
    GTEST_SKIP() << "the first device is not PoCL's: two runs compared, not two thread counts";
}

}  // namespace
}  // namespace wale::test
