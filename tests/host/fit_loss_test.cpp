// Losses: 0 at the target, greater the farther away, and sums of the residuals' squares.
#include "host/fit/loss.h"
#include "tests/host/fit_pictures.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

// Two layers that can be worked out by hand: what is brighter than 0.3, and half-size means with their negatives.
class ToyNetwork : public FeatureNetwork {
 public:
  const std::vector<std::string>& layers() const override { return layers_; }
  std::vector<FeatureMap> features(const Picture& display, const std::vector<std::string>& wanted) const override {
    std::vector<FeatureMap> maps;
    for (const std::string& layer : wanted) {
      const int step = layer == "relu1_2" ? 1 : 2, channels = layer == "relu1_2" ? 3 : 2;
      FeatureMap map{channels, display.width / step, display.height / step, {}};
      for (int c = 0; c < channels; ++c)
        for (int y = 0; y < map.height; ++y)
          for (int x = 0; x < map.width; ++x) {
            const float value = display.at(step * x, step * y)[c];
            map.values.push_back(channels == 3 ? std::max(0.0f, value - 0.3f) : c == 0 ? value : 1 - value);
          }
      maps.push_back(std::move(map));
    }
    return maps;
  }

 private:
  std::vector<std::string> layers_{"relu1_2", "relu2_2"};
};

PicturePair pair_of(double shift = 0, double shade = 0.4, double contrast = 0.5) {
  return {stitches(48, 40, shift, shade, contrast), stitches(48, 40, shift, 0.05 * shade, 0.6 * contrast)};
}

// Every term in both modes.
std::vector<LossOptions> all_options() {
  std::vector<LossOptions> all;
  for (const Alignment alignment : {Alignment::aligned, Alignment::unaligned})
    for (int term = 0; term <= 5; ++term) {
      LossOptions options;
      options.descriptors.alignment = alignment;
      if (term < 5) {
        TermWeights weights;
        double* const one[] = {&weights.low_pass, &weights.color, &weights.gradient, &weights.spectrum,
                               &weights.feature};
        *one[term] = 1;
        options.weights = weights;
      }
      all.push_back(options);
    }
  return all;
}

Loss loss_to(const PicturePair& target, const LossOptions& options) {
  return Loss(target, options, std::make_shared<ToyNetwork>());
}

bool contrast_only(const LossOptions& options) {
  return options.weights && (options.weights->spectrum > 0 ||
                             (options.weights->gradient > 0 && options.descriptors.alignment == Alignment::unaligned));
}

std::string term_of(const Loss& loss, const PicturePair& pair) { return loss.contributions(pair).front().name; }

TEST(FitLoss, ZeroAtTheTargetAndAboveElsewhere) {
  for (const LossOptions& options : all_options()) {
    const Loss loss = loss_to(pair_of(), options);
    EXPECT_EQ(loss.loss(pair_of()), 0);
    EXPECT_GT(loss.loss(pair_of(0, 0.44, 0.45)), 1e-6) << term_of(loss, pair_of());
  }
}

TEST(FitLoss, ResidualsSquaredAddUpToTheLoss) {
  for (const LossOptions& options : all_options()) {
    const Loss loss = loss_to(pair_of(), options);
    const PicturePair other = pair_of(1.3, 0.5, 0.3);
    double squares = 0, parts = 0;
    for (const double residual : loss.residuals(other)) squares += residual * residual;
    for (const auto& part : loss.contributions(other)) parts += part.value;
    EXPECT_NEAR(squares / loss.loss(other), 1, 1e-12);
    EXPECT_NEAR(parts / loss.loss(other), 1, 1e-12);
    EXPECT_EQ(loss.residuals(other).size(), loss.residuals(pair_of()).size());
  }
}

TEST(FitLoss, FartherPicturesLoseMore) {
  for (const LossOptions& options : all_options()) {
    const Loss loss = loss_to(pair_of(), options);
    const std::string term = term_of(loss, pair_of());
    double last = 0;
    for (const double shade : {0.42, 0.46, 0.55, 0.7}) {
      if (contrast_only(options)) break;
      const double value = loss.loss(pair_of(0, shade));
      EXPECT_GT(value, last) << term << " shade " << shade;
      last = value;
    }
    // A mean does not see contrast.
    if (!options.weights || options.weights->low_pass == 0 || options.descriptors.alignment == Alignment::aligned) {
      last = 0;
      for (const double contrast : {0.45, 0.35, 0.2, 0.0}) {
        const double value = loss.loss(pair_of(0, 0.4, contrast));
        EXPECT_GT(value, last) << term << " contrast " << contrast;
        last = value;
      }
    }
  }
}

// A black render has the relative difference 1 in every value but those of contrast.
TEST(FitLoss, BlackLosesTheSumOfTheWeights) {
  for (const Alignment alignment : {Alignment::aligned, Alignment::unaligned}) {
    LossOptions options;
    options.descriptors.alignment = alignment;
    const bool aligned = alignment == Alignment::aligned;
    options.weights = TermWeights{.low_pass = 1, .gradient = aligned ? 0.3 : 0};
    EXPECT_NEAR(Loss(pair_of(), options).loss({Picture(48, 40), Picture(48, 40)}), aligned ? 1.3 : 1, 1e-6);
  }
}

// 10 % more light is a squared relative difference of 0.01.
TEST(FitLoss, OnlyTheRelativeDifferenceCounts) {
  LossOptions options;
  options.weights = TermWeights{.low_pass = 1};
  const PicturePair flat{painted(40, 40, [](int, int, int) { return 0.5; }),
                         painted(40, 40, [](int, int, int) { return 0.001; })};
  const auto scaled = [&](double front, double back) {
    return PicturePair{painted(40, 40, [&](int, int, int) { return 0.5 * front; }),
                       painted(40, 40, [&](int, int, int) { return 0.001 * back; })};
  };
  const Loss loss(flat, options);
  EXPECT_NEAR(loss.loss(scaled(1.1, 1)), 0.005, 1e-6);
  EXPECT_NEAR(loss.loss(scaled(1, 1.1)), 0.005, 1e-6);
  options.back = 0;
  EXPECT_NEAR(Loss(flat, options).loss(scaled(1.1, 7)), 0.01, 1e-6);
}

TEST(FitLoss, KnownValuesOfTheFeatures) {
  LossOptions options;
  options.weights = TermWeights{.feature = 1};
  options.layers = {{"relu2_2", 1}};
  options.descriptors.alignment = Alignment::unaligned;
  const auto flat = [](double shade) { return painted(40, 40, [&](int, int, int) { return shade; }); };
  const auto network = std::make_shared<ToyNetwork>();
  const Blocks blocks = feature_descriptor(network, options.layers, 1, options.descriptors)(flat(1));
  ASSERT_EQ(blocks.size(), 1u);
  ASSERT_EQ(blocks[0].values.size(), 9u * 3);  // nine windows, halves of 2 x 2
  EXPECT_NEAR(blocks[0].values[0], 1, 1e-5);   // channels 1 and 0
  EXPECT_NEAR(blocks[0].values[1], 0, 1e-5);
  const float v = float((1.055 * std::pow(0.2, 1 / 2.4) - 0.055));
  const Blocks dim = feature_descriptor(network, options.layers, 1, options.descriptors)(flat(0.2));
  EXPECT_NEAR(dim[0].values[3], v * v, 1e-5);
  EXPECT_NEAR(dim[0].values[4], std::sqrt(2.0) * v * (1 - v), 1e-5);
  EXPECT_NEAR(dim[0].values[5], (1 - v) * (1 - v), 1e-5);
  EXPECT_NEAR(display_exposure(flat(0.2)), 4, 1e-6);
  // Each picture is exposed by the target's light: scaled alike, both lose nothing, however dim.
  const Blocks exposed = feature_descriptor(network, options.layers, 4, options.descriptors)(flat(0.05));
  EXPECT_NEAR(exposed[0].values[3], v * v, 1e-5);
  const Loss bright({flat(0.2), flat(0.2)}, options, network), dark({flat(0.002), flat(0.002)}, options, network);
  EXPECT_NEAR(dark.loss({flat(0.001), flat(0.001)}) / bright.loss({flat(0.1), flat(0.1)}), 1, 1e-4);
}

TEST(FitLoss, KnownColors) {
  // Two halves: red 0 and 1, green 0.25, blue 1 and 0.
  const Picture halves = painted(32, 8, [](int x, int, int c) {
    return c == 1 ? 0.25 : (x < 16) == (c == 2) ? 1.0 : 0.0;
  });
  const Blocks blocks = color_descriptor({})(halves);
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0].values, (std::vector<float>{0.5f, 0.25f, 0.5f}));
  // Red and blue deviate by 1/2 about 1/2, and against each other. The least shade is a 50th of 5/12.
  const double most = std::log(0.02 + 0.5 / (0.5 + 0.02 * 5 / 12)), none = std::log(0.02);
  const double expected[] = {most, none, most, 0, 0, -1};
  ASSERT_EQ(blocks[1].values.size(), 6u);
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(blocks[1].values[i], expected[i], 1e-5) << i;
  ASSERT_EQ(blocks[2].values.size(), 48u);
  for (size_t q = 0; q < 16; ++q) {
    EXPECT_EQ(blocks[2].values[q], q < 8 ? 0 : 1);
    EXPECT_EQ(blocks[2].values[16 + q], 0.25f);
  }
  for (const Block& block : blocks) EXPECT_NEAR(block.weight, 1.0 / 3, 1e-12);
}

TEST(FitLoss, KnownEdges) {
  const Picture ramp = painted(16, 12, [](int x, int y, int) { return 0.1 * x - 0.2 * y + 2.35; });
  DescriptorOptions options;
  options.levels = 1;
  const Blocks aligned = gradient_descriptor(options)(ramp);
  ASSERT_EQ(aligned[0].values.size(), 3u * (15 * 12 + 16 * 11));
  EXPECT_NEAR(aligned[0].values.front(), 0.1, 1e-6);
  EXPECT_NEAR(aligned[0].values.back(), -0.2, 1e-6);
  options.alignment = Alignment::unaligned;
  options.windows = 1;
  const Blocks sizes = gradient_descriptor(options)(ramp);
  ASSERT_EQ(sizes[0].values.size(), 12u);  // sizes across, root mean squares across, both down
  // Over the shade, 2 in the middle.
  for (size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(sizes[0].values[i], std::log(0.02 + (i < 6 ? 0.05 : 0.1) / 1.02), 1e-5) << i;
}

// A darker picture is no nearer to one of less contrast, nor one of another colour.
TEST(FitLoss, ContrastIsThatOfAnyBrightnessAndColor) {
  const PicturePair target{stitches(64, 64), stitches(64, 64)};
  PicturePair dark = target, green = target;
  for (Picture* side : {&dark.front, &dark.back})
    for (float& v : side->pixels) v *= 0.25f;
  for (Picture* side : {&green.front, &green.back})
    for (size_t i = 0; i < side->pixels.size(); ++i) side->pixels[i] *= i % 3 == 1 ? 1.0f : 0.5f;
  for (const TermWeights& weights : {TermWeights{.gradient = 1}, TermWeights{.spectrum = 1}}) {
    LossOptions options;
    options.descriptors.alignment = Alignment::unaligned;
    options.weights = weights;
    const Loss loss(target, options);
    EXPECT_NEAR(loss.loss(dark), 0, 1e-9);
    EXPECT_LT(loss.loss(green), 0.02);
  }
}

// Moved by half a stitch, a cloth looks the same: statistics see it far less than pixels do.
TEST(FitLoss, UnalignedForgivesAShift) {
  LossOptions aligned, unaligned;
  unaligned.descriptors.alignment = Alignment::unaligned;
  const PicturePair target{stitches(120, 120), stitches(120, 120, 0, 0.02)};
  const PicturePair moved{stitches(120, 120, 4.5), stitches(120, 120, 4.5, 0.02)};
  const PicturePair darker{stitches(120, 120, 0, 0.32), stitches(120, 120, 0, 0.016)};
  const Loss pixels(target, aligned), statistics(target, unaligned);
  EXPECT_GT(pixels.loss(moved), 3 * pixels.loss(darker));
  EXPECT_LT(statistics.loss(moved), 0.1 * statistics.loss(darker));
}

// A change of one part of a photograph changes residuals of that part's cells alone, of all terms.
TEST(FitLoss, CellsAreWhereResidualsComeFrom) {
  constexpr int kSide = 128;
  for (LossOptions options : all_options()) {
    options.descriptors.levels = 3;
    if (options.weights && options.weights->feature > 0) continue;  // the toy network's maps have another shape
    const bool windows = options.descriptors.alignment == Alignment::unaligned;
    const bool whole = options.weights && (options.weights->color > 0 || options.weights->spectrum > 0);
    const PicturePair target{stitches(kSide, kSide), stitches(kSide, kSide, 0, 0.02)};
    PicturePair other = target;
    // The lowest eighth of the back.
    for (int y = kSide * 7 / 8 + 8; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) other.back.pixels[3 * (size_t(y) * kSide + size_t(x))] += 0.2f;
    const Loss loss = loss_to(target, options);
    const std::vector<int> cells = loss.cells();
    const std::vector<double> residuals = loss.residuals(other);
    ASSERT_EQ(cells.size(), residuals.size());
    std::set<int> touched;
    for (size_t i = 0; i < cells.size(); ++i)
      if (std::abs(residuals[i]) > 1e-6) touched.insert(cells[i]);
    ASSERT_FALSE(touched.empty());
    const int last = *std::max_element(cells.begin(), cells.end());
    EXPECT_EQ(*touched.rbegin(), last);
    if (whole && !windows) continue;
    // The lowest strip, and where rows of differences are shorter than strips the one above; or the lowest windows.
    EXPECT_GE(*touched.begin(), windows ? last - 2 : last - 1) << term_of(loss, target);
  }
}

TEST(FitLoss, WhatCannotBeIsRefusedInOneLine) {
  const auto line = [](const auto& change, bool network = true, PicturePair target = pair_of()) {
    LossOptions options;
    change(options);
    return user_message([&] {
      Loss(target, options, network ? std::make_shared<ToyNetwork>() : std::shared_ptr<const FeatureNetwork>());
    });
  };
  EXPECT_EQ(line([](LossOptions& o) { o.front = -1; }), "loss: front: -1 is no weight; valid: 0 and above");
  EXPECT_EQ(line([](LossOptions& o) { o.front = o.back = 0; }),
            "loss: front and back are both 0; give one of them a weight");
  EXPECT_EQ(line([](LossOptions& o) { o.weights = TermWeights{}; }),
            "loss: all weights are 0; give one of low_pass, color, gradient, spectrum, feature");
  EXPECT_EQ(line([](LossOptions& o) { o.weights = TermWeights{.color = NAN}; }),
            "loss: color: nan is no weight; valid: 0 and above");
  EXPECT_EQ(line([](LossOptions& o) { o.weights = TermWeights{.feature = 1}; }, false),
            "loss: feature: needs the weights of a network; gradient needs none");
  EXPECT_EQ(line([](LossOptions& o) {
              o.layers = {{"relu1_3", 1}};
            }),
            "loss: layer \"relu1_3\": the network has none of this name; did you mean \"relu1_2\"?");
  EXPECT_EQ(line([](LossOptions& o) { o.layers = {{"relu1_2", 0}}; }), "loss: the weights of all layers are 0");
  EXPECT_EQ(line([](LossOptions& o) { o.descriptors.windows = 0; }), "loss: windows: 0; valid: 1 to 64");
  EXPECT_EQ(line([](LossOptions& o) { o.descriptors.levels = 0; }), "loss: levels: 0; valid: 1 to 16");
  EXPECT_EQ(line([](LossOptions& o) { o.descriptors.windows = 20; }),
            "loss: 48 x 40 pixels are too few for 20 windows; at least 42 x 42");
  EXPECT_EQ(line([](LossOptions&) {}, true, {stitches(48, 40), stitches(40, 48)}),
            "loss: the front picture has 48 x 40 pixels, the back one 40 x 48; both need one size");
  EXPECT_EQ(line([](LossOptions&) {}, true, {stitches(48, 40), Picture(48, 40)}), "loss: the back picture is black");
}

}  // namespace
}  // namespace wale::fit
