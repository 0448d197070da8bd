// Convolutions with known answers, and the features of VGG16 against those of NumPy and ONNX Runtime.
#include <cstdlib>
#include <fstream>

#include "host/fit/loss.h"
#include "host/fit/vgg16.h"
#include "tests/host/fit_pictures.h"
#include "tests/host/fit_weight_files.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

#include "tests/host/fit_vgg_figures.inc"

// Of a layer's root mean square: sums of up to 4608 floats, one layer after another.
constexpr double kFeatures = 1e-4;

// The same display values as in bench/peers/vgg_features.py.
Picture peer_picture() {
  return painted(38, 34, [](int x, int y, int c) { return float((7 * x + 13 * y + 29 * c + x * y) % 97) / 96.0f; });
}

FeatureMap map_of(int channels, int width, int height, unsigned seed) {
  FeatureMap map{channels, width, height, {}};
  for (int i = 0; i < channels * width * height; ++i) map.values.push_back(scrambled(seed + unsigned(i)));
  return map;
}

// The sum that a convolution is, written down, in double.
double convolution_at(const FeatureMap& map, const Convolution& layer, int o, int x, int y) {
  double sum = layer.bias[size_t(o)];
  for (int i = 0; i < layer.in; ++i)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (x + dx >= 0 && x + dx < map.width && y + dy >= 0 && y + dy < map.height)
          sum += double(layer.weights[size_t(((o * layer.in + i) * 3 + dy + 1) * 3 + dx + 1)]) *
                 double(map.values[size_t((i * map.height + y + dy) * map.width + x + dx)]);
  return std::max(0.0, sum);
}

TEST(FitVgg, ConvolutionsAreTheirSums) {
  for (const auto& [width, height] : {std::pair{7, 5}, {1, 1}, {1, 9}, {200, 40}, {2, 2}}) {
    const FeatureMap map = map_of(70, width, height, 11);
    Convolution layer{70, 3, std::vector<float>(70 * 3 * 9), {0.1f, -0.2f, 0.3f}};
    for (size_t i = 0; i < layer.weights.size(); ++i) layer.weights[i] = scrambled(99 + i);
    const FeatureMap out = convolved(map, layer);
    ASSERT_EQ(out.channels, 3);
    ASSERT_EQ(out.values.size(), size_t(3 * width * height));
    for (int o = 0; o < 3; ++o)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_NEAR(out.values[size_t((o * height + y) * width + x)], convolution_at(map, layer, o, x, y), 1e-5)
              << o << " " << x << " " << y << " of " << width << " x " << height;
  }
}

TEST(FitVgg, PoolsAreTheGreatest) {
  const FeatureMap map{1,
                       5,
                       3,
                       {1, 2, 3, 4, 9,  //
                        5, 0, 1, 8, 9,  //
                        9, 9, 9, 9, 9}};
  const FeatureMap out = max_pooled(map);
  EXPECT_EQ(out.width, 2);
  EXPECT_EQ(out.height, 1);
  EXPECT_EQ(out.values, (std::vector<float>{5, 8}));
}

template <size_t Layers>
void expect_figures(const Vgg16& network, const double (&figures)[Layers][4]) {
  ASSERT_EQ(network.layers().size(), Layers);
  const auto maps = network.features(peer_picture(), network.layers());
  for (size_t i = 0; i < Layers; ++i) {
    const FeatureMap& map = maps[i];
    double squares = 0, sum = 0, greatest = 0, weighted = 0;
    size_t at = 0;
    for (int c = 0; c < map.channels; ++c)
      for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
          const double value = map.values[at++];
          squares += value * value;
          sum += value;
          greatest = std::max(greatest, value);
          weighted += value * ((31 * c + 17 * y + 7 * x) % 11 - 5);
        }
    const double count = double(map.values.size()), size = figures[i][0];
    const double ours[] = {std::sqrt(squares / count), sum / count, greatest, weighted / count};
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(ours[k] / size, figures[i][k] / size, kFeatures) << network.layers()[i] << ", figure " << k;
  }
}

TEST(FitVgg, ThirteenLayersAsNumPyHasThem) { expect_figures(Vgg16(made_up_layers(13), Normalisation::torch), kMadeUp); }

TEST(FitVgg, TheOxfordWeightsAsNumPyHasThem) {
  const char* folder = std::getenv("WALE_REAL_DATA");
  if (!folder) GTEST_SKIP() << "WALE_REAL_DATA is not set";
  const auto network = read_vgg16(std::filesystem::path(folder) / "vgg16/vgg16_imagenet_block1_block2.npz");
  EXPECT_EQ(network->text(), "relu1_1 to relu2_2 of VGG16, 4 of 13 layers");
  expect_figures(*network, kOxford);
}

TEST(FitVgg, OnlyTheLayersAskedForInTheirOrder) {
  const Vgg16 network(made_up_layers(4), Normalisation::torch);
  const auto all = network.features(peer_picture(), network.layers());
  const auto some = network.features(peer_picture(), {"relu2_1", "relu1_2"});
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(some[0].values, all[2].values);
  EXPECT_EQ(some[1].values, all[1].values);
  EXPECT_EQ(some[0].width, 19);
  EXPECT_TRUE(network.features(peer_picture(), {}).empty());
}

TEST(FitVgg, TooSmallAPictureIsRefused) {
  const Vgg16 network(made_up_layers(5), Normalisation::torch);
  EXPECT_EQ(user_message([&] { network.features(Picture(3, 9), {"relu3_1"}); }),
            "3 x 9 pixels are too few for relu3_1; it needs 4 x 4");
  EXPECT_EQ(network.features(Picture(4, 9), {"relu3_1"})[0].values.size(), 256u * 2);
}

// The loss looks at the last layer of each block there is, and sees a softer cloth that has the same mean.
TEST(FitVgg, TheLossTakesTheLayersThatAreThere) {
  const auto network = std::make_shared<Vgg16>(made_up_layers(5), Normalisation::torch);
  const auto pair = [](double contrast) {
    return PicturePair{stitches(40, 32, 0, 0.4, contrast), stitches(40, 32, 0, 0.02, contrast)};
  };
  for (const Alignment alignment : {Alignment::aligned, Alignment::unaligned}) {
    LossOptions options;
    options.descriptors.alignment = alignment;
    options.weights = TermWeights{.feature = 1};
    const Loss loss(pair(0.5), options, network);
    const auto parts = loss.contributions(pair(0.4));
    ASSERT_EQ(parts.size(), 4u);
    EXPECT_EQ(parts[0].name, "front, feature, relu1_2");
    EXPECT_EQ(parts[3].name, "back, feature, relu2_2");
    // Each is exposed by its own light, so front and back of one shape count alike.
    EXPECT_NEAR(parts[2].value / parts[0].value, 1, 1e-3);
    EXPECT_EQ(loss.loss(pair(0.5)), 0);
    EXPECT_LT(loss.loss(pair(0.4)), loss.loss(pair(0.2)));
  }
}

TEST(FitVgg, WeightsThatOverflowAreRefused) {
  auto layers = made_up_layers(2);
  for (float& weight : layers[1].weights) weight *= 1e38f;
  const auto network = std::make_shared<Vgg16>(layers, Normalisation::torch);
  EXPECT_EQ(user_message([&] {
              Loss({stitches(40, 32), stitches(40, 32, 1)}, {}, network);
            }),
            "loss: feature, relu1_2: values of the front picture are not finite; are the network's weights sound?");
}

}  // namespace
}  // namespace wale::fit
