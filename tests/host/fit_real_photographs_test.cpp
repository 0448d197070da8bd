// Photographs of real cloth, lit from the front and from behind (Woven Fabric Capture with a Reflection-Transmission
// Photo Pair, SIGGRAPH 2024; in $WALE_REAL_DATA/photos/fabric-btdf).
#include <cstdlib>

#include "host/fit/loss.h"
#include "host/fit/photograph.h"
#include "host/fit/vgg16.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

class FitRealPhotographs : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("WALE_REAL_DATA");
    if (!folder) GTEST_SKIP() << "WALE_REAL_DATA is not set";
    folder_ = folder;
  }
  // Left half (0) or right half (1) of a sample, at a quarter of its resolution.
  PicturePair half(const std::string& sample, int which) const {
    PairOptions options;
    options.front.crop = options.back.crop = Rectangle{256 * which, 0, 256, 512};
    options.front.size = options.back.size = ivec2(64, 128);
    const auto file = [&](const char* side) { return folder_ / "photos/fabric-btdf" / (sample + side); };
    return read_pair(file("_R.png"), file("_T.png"), options).pictures;
  }
  std::filesystem::path folder_;
};

// The lamp's light is mirrored from one half to the other, and the threads do not lie on one another: only what the
// cloth looks like is the same.
TEST_F(FitRealPhotographs, HalvesOfOneClothAreNearerThanOtherCloths) {
  const std::string samples[] = {"satin1", "twill1", "twill4"};
  std::vector<PicturePair> left, right;
  for (const std::string& sample : samples) left.push_back(half(sample, 0)), right.push_back(half(sample, 1));
  LossOptions options;
  options.descriptors.alignment = Alignment::unaligned;
  options.descriptors.windows = 1;
  const auto network = read_vgg16(folder_ / "vgg16/vgg16_imagenet_block1_block2.npz");
  LossOptions features = options;
  features.weights = TermWeights{.feature = 1};
  for (size_t i = 0; i < 3; ++i) {
    const Loss plain(left[i], options), whole(left[i], options, network), alone(left[i], features, network);
    for (size_t j = 0; j < 3; ++j) {
      if (j == i) continue;
      EXPECT_LT(5 * plain.loss(right[i]), plain.loss(right[j])) << samples[i] << " and " << samples[j];
      EXPECT_LT(5 * whole.loss(right[i]), whole.loss(right[j])) << samples[i] << " and " << samples[j];
      EXPECT_LT(1.5 * alone.loss(right[i]), alone.loss(right[j])) << samples[i] << " and " << samples[j];
    }
  }
}

}  // namespace
}  // namespace wale::fit
