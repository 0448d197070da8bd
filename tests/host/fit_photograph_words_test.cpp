// What a command line says of its photographs: exposures compare the two, gains and a card set the light of both.
#include "host/fit/photograph_words.h"
#include "tests/host/fit_pictures.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

constexpr double kFront = 0.4, kBack = 0.3, kCard = 0.25;
constexpr double kSixteenBits = 1e-4;  // relative, of half a step of 16 bits

class FitPhotographWords : public testing::Test {
 protected:
  FitPhotographWords() {
    args_.transfer = "linear";
    args_.crop = "8,0,72,80";
    args_.front = flat("front.ppm", kFront);
    args_.back = flat("back.ppm", kBack);
  }
  // 80 x 80 pixels of one value; left 8 columns are a card.
  std::filesystem::path flat(const std::string& name, double value) const {
    return folder_.write(
        name, ppm(80, 80, 16, [=](int x, int, int) { return int(std::lround(65535 * (x < 8 ? kCard : value))); }));
  }
  void expect(const char* what, double front, double back) const {
    std::vector<std::string> warnings;
    const PicturePair pair = read_photographs(args_, warnings);
    const auto near = [&](const Picture& picture, double expected) {
      ASSERT_EQ(picture.count() > 0, expected > 0) << what;
      if (picture.count() == 0) return;
      EXPECT_NEAR(picture.at(30, 30)[1] / expected, 1, kSixteenBits) << what;
    };
    near(pair.front, front);
    near(pair.back, back);
  }

  FitArgs args_;
  TemporaryFolder folder_;
};

TEST_F(FitPhotographWords, ExposuresCompareTheTwo) {
  expect("without exposures", kFront, kBack);
  args_.front_exposure = 0.026;
  args_.back_exposure = 0.2;
  expect("exposures", kFront, kBack * 0.026 / 0.2);
  args_.gains = "3,2,1";
  expect("gains", 2 * kFront, 2 * kBack * 0.026 / 0.2);
  args_.gains = "";
  args_.grey = "0,0,8,80";
  expect("card", 0.18 * kFront / kCard, 0.18 * kBack / kCard * 0.026 / 0.2);
}

TEST_F(FitPhotographWords, OneExposureComparesNothing) {
  args_.gains = "3,2,1";
  args_.front_exposure = 0.026;
  args_.back_exposure = 0.2;
  const auto back = args_.back;
  args_.back.clear();
  expect("front alone", 2 * kFront, 0);
  args_.gains = "";
  expect("without gains", kFront, 0);
  args_.grey = "0,0,8,80";
  expect("card", 0.18 * kFront / kCard, 0);
  args_.front.clear();
  args_.grey = "";
  args_.back = back;
  expect("back alone", 0, kBack);
  args_.gains = "3,2,1";
  expect("with gains", 0, 2 * kBack);
}

TEST_F(FitPhotographWords, AGainIsRefusedAsItWasGiven) {
  args_.front_exposure = 0.026;
  args_.gains = "1,-2,1";
  std::vector<std::string> warnings;
  EXPECT_EQ(user_message([&] { read_photographs(args_, warnings); }), "--gains: -2 is not above 0");
  args_.gains = "1,2,1";
  args_.grey = "0,0,8,80";
  EXPECT_EQ(user_message([&] { read_photographs(args_, warnings); }),
            args_.front.string() + ": grey and gains: give one of them");
}

}  // namespace
}  // namespace wale::fit
