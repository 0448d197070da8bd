// Photographs become linear light in known units, or are refused with a line that says why.
#include <zlib.h>

#include "host/fit/photograph.h"
#include "host/schema.h"
#include "tests/host/fit_pictures.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

class FitPhotograph : public testing::Test {
 protected:
  // 64 x 64 pixels of one stored value, 8 bits; left 8 columns are the reference.
  std::filesystem::path flat(const std::string& name, int cloth, int grey = 100) const {
    return folder_.write(name, ppm(64, 64, 8, [&](int x, int, int) { return x < 8 ? grey : cloth; }));
  }
  // Stitches of 80 x 80 pixels, 16 bits, sRGB encoded.
  std::filesystem::path cloth(const std::string& name, double shade, double shift = 0) const {
    const Picture picture = stitches(80, 80, shift, shade);
    return folder_.write(name, ppm(80, 80, 16, [&](int x, int y, int c) {
                           return int(std::lround(65535 * linear_to_srgb(picture.at(x, y)[c])));
                         }));
  }
  std::filesystem::path exr(const std::string& name, const Picture& picture) const {
    const auto file = folder_ / name;
    write_image({picture.width, picture.height, {"R", "G", "B"}, picture.pixels}, file);
    return file;
  }
  std::string refusal(const std::filesystem::path& file, const PhotographOptions& options) const {
    return user_message([&] { read_photograph(file, options); }).substr(folder_.path().string().size() + 1);
  }
  TemporaryFolder folder_;
};

// A PNG of one grey and one alpha.
std::string grey_png(uint32_t width, uint32_t height, int grey, int alpha) {
  const auto number = [](uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += char(value >> shift);
    return text;
  };
  const auto chunk = [&](const std::string& content) {
    const auto* bytes = reinterpret_cast<const Bytef*>(content.data());
    return number(uint32_t(content.size() - 4)) + content + number(uint32_t(crc32(0, bytes, uInt(content.size()))));
  };
  std::string rows;
  for (uint32_t y = 0; y < height; ++y) {
    rows += '\0';  // no filter
    for (uint32_t x = 0; x < width; ++x) rows += {char(grey), char(alpha)};
  }
  std::string packed(compressBound(uLong(rows.size())), '\0');
  uLongf size = uLongf(packed.size());
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           uLong(rows.size()));
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR" + number(width) + number(height) + std::string("\x08\x04\0\0\0", 5)) +
         chunk("IDAT" + packed.substr(0, size)) + chunk("IEND");
}

const Rectangle kCard{0, 0, 8, 64}, kCloth{8, 0, 56, 56};

TEST_F(FitPhotograph, SrgbAndLinearValues) {
  const auto file = flat("a.ppm", 188);
  const Photograph srgb = read_photograph(file, {.crop = kCloth});
  EXPECT_NEAR(srgb.picture.at(20, 20)[1], std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
  const Photograph linear = read_photograph(file, {.transfer = Transfer::linear, .crop = kCloth});
  EXPECT_NEAR(linear.picture.at(20, 20)[1], 188 / 255.0, 1e-6);
  const auto hdr = exr("a.exr", painted(64, 64, [](int, int, int c) { return 0.3 + c; }));
  EXPECT_FLOAT_EQ(read_photograph(hdr, {}).picture.at(5, 5)[2], 2.3f);  // more than 1 is not clipped there
  EXPECT_NEAR(read_photograph(hdr, {.transfer = Transfer::srgb}).picture.at(5, 5)[0], srgb_to_linear(0.3), 1e-6);
}

TEST_F(FitPhotograph, SixteenBits) {
  const auto file = folder_.write("deep.ppm", ppm(64, 64, 16, [](int x, int, int) { return 20000 + x; }));
  const Photograph linear = read_photograph(file, {.transfer = Transfer::linear});
  EXPECT_NEAR(linear.picture.at(63, 0)[0] - linear.picture.at(62, 0)[0], 1 / 65535.0, 1e-7);
}

// A red lamp and an exposure of anything: the card gets its reflectance, the cloth its own.
TEST_F(FitPhotograph, AReferenceSetsExposureAndWhiteBalance) {
  constexpr Rectangle part{8, 0, 72, 80};
  constexpr double kLamp[] = {0.9, 0.5, 0.3}, kCardReflectance = 0.2, kClothReflectance = 0.6;
  const auto file =
      folder_.write("lamp.ppm", ppm(80, 80, 16, [&](int x, int, int c) {
                      return int(std::lround(65535 * kLamp[c] * (x < 8 ? kCardReflectance : kClothReflectance)));
                    }));
  const Photograph photograph = read_photograph(
      file, {.transfer = Transfer::linear, .grey = kCard, .grey_reflectance = kCardReflectance, .crop = part});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(photograph.picture.at(3, 3)[c], kClothReflectance, 1e-4) << c;
  EXPECT_TRUE(photograph.warnings.empty());
  const Photograph again =
      read_photograph(file, {.transfer = Transfer::linear, .gains = photograph.gains, .crop = part});
  EXPECT_EQ(again.picture.pixels, photograph.picture.pixels);
}

TEST_F(FitPhotograph, CropCornersAndSize) {
  const auto file = cloth("c.ppm", 0.4);
  const Picture whole = read_photograph(file, {}).picture;
  const Picture cut = read_photograph(file, {.crop = Rectangle{4, 6, 70, 66}}).picture;
  EXPECT_EQ(cut.width, 70);
  EXPECT_EQ(cut.height, 66);
  EXPECT_EQ(cut.at(0, 0)[1], whole.at(4, 6)[1]);
  const Corners corners{dvec2(4, 6), dvec2(74, 6), dvec2(74, 72), dvec2(4, 72)};
  const Picture straight = read_photograph(file, {.corners = corners}).picture;
  ASSERT_EQ(straight.width, 70);
  ASSERT_EQ(straight.height, 66);
  EXPECT_NEAR(straight.at(10, 20)[0], cut.at(10, 20)[0], 1e-6);
  const Picture small = read_photograph(file, {.crop = Rectangle{4, 6, 70, 66}, .size = ivec2(35, 33)}).picture;
  EXPECT_EQ(small.pixels, at_resolution(cut, 35, 33).pixels);
}

TEST_F(FitPhotograph, WhatCannotBeIsRefusedInOneLine) {
  const auto file = flat("a.ppm", 188);
  const auto lines = [&](const PhotographOptions& options) { return refusal(file, options); };
  EXPECT_EQ(lines({.grey = kCard, .gains = std::array<double, 3>{1, 1, 1}}), "a.ppm: grey and gains: give one of them");
  EXPECT_EQ(lines({.crop = kCloth, .corners = Corners{}}), "a.ppm: crop and corners: give one of them");
  EXPECT_EQ(lines({.grey = kCard, .grey_reflectance = 18}),
            "a.ppm: grey_reflectance: 18 is not above 0 and up to 1; a photographer's card has 0.18");
  EXPECT_EQ(lines({.exposure = 0}), "a.ppm: exposure: 0 is not above 0");
  EXPECT_EQ(lines({.gains = std::array<double, 3>{1, -1, 1}}), "a.ppm: gains: -1 is not above 0");
  EXPECT_EQ(lines({.clip_level = NAN}), "a.ppm: clip_level: nan is not above 0");
  EXPECT_EQ(lines({.size = ivec2(0, 5)}), "a.ppm: size: 0 x 5; valid: 1 to 16384 pixels");
  EXPECT_EQ(lines({.crop = Rectangle{8, 0, 57, 64}}),
            "a.ppm: crop: 57 x 64 pixels at (8, 0) do not lie within its 64 x 64");
  EXPECT_EQ(lines({.grey = Rectangle{60, 60, 2147483647, 2}}),
            "a.ppm: grey: 2147483647 x 2 pixels at (60, 60) do not lie within its 64 x 64");
  EXPECT_EQ(lines({.corners = Corners{dvec2(0, 0), dvec2(64, 0), dvec2(64, 64), dvec2(0, 99)}}),
            "a.ppm: corners: the bottom left one, (0, 99), lies outside of the 64 x 64 pixels");
  EXPECT_EQ(refusal(flat("dark.ppm", 188, 1), {.grey = kCard}),
            "dark.ppm: grey: its R is 0.0003 of full scale, too dark to measure by; expose more");
  EXPECT_EQ(refusal(flat("card.ppm", 188, 255), {.grey = kCard, .crop = kCloth}),
            "card.ppm: grey: 100 % of it is clipped; expose less");
  EXPECT_EQ(refusal(flat("black.ppm", 0), {.crop = kCloth}), "black.ppm: it is black: its mean is 0.0e+00");
  EXPECT_EQ(refusal(folder_ / "none.jpg", {}), "none.jpg: no such image file");
}

TEST_F(FitPhotograph, ClippedPixelsAreCountedAndPlaced) {
  // Of 100 x 100 pixels `n` in the upper right corner.
  const auto file = [&](int n) {
    return folder_.write("clip.ppm", ppm(100, 100, 8, [&](int x, int y, int c) {
                           return c == 1 && y < 10 && x >= 90 && (x - 90) + 10 * y < n ? 255 : 120;
                         }));
  };
  EXPECT_TRUE(read_photograph(file(0), {}).warnings.empty());
  const auto few = read_photograph(file(90), {}).warnings;
  ASSERT_EQ(few.size(), 1u);
  EXPECT_NE(few[0].find("clip.ppm: 0.9 % of the cloth's pixels are clipped, most around (93, 6)"), std::string::npos)
      << few[0];
  folder_.write("clip.ppm", ppm(100, 100, 8, [](int x, int, int) { return x < 2 ? 255 : 120; }));
  EXPECT_EQ(refusal(folder_ / "clip.ppm", {}),
            "clip.ppm: 2 % of the cloth's pixels are clipped, most around (6, 6); expose less");
  // Beside the cloth it does not matter, and a camera may clip lower.
  EXPECT_TRUE(read_photograph(folder_ / "clip.ppm", {.crop = Rectangle{2, 0, 98, 100}}).warnings.empty());
  EXPECT_TRUE(read_photograph(folder_ / "clip.ppm",
                              {.corners = Corners{dvec2(2, 0), dvec2(100, 0), dvec2(100, 100), dvec2(2, 100)}})
                  .warnings.empty());
  EXPECT_NE(refusal(folder_ / "clip.ppm", {.clip_level = 0.4, .crop = Rectangle{2, 0, 98, 100}}).find("100 % of the"),
            std::string::npos);
}

TEST_F(FitPhotograph, NotFiniteAndTransparent) {
  Picture picture = stitches(64, 64);
  picture.at(7, 9)[2] = NAN;
  EXPECT_EQ(refusal(exr("nan.exr", picture), {}), "nan.exr: pixel (7, 9), channel B: nan is not a finite number");
  Image image{64, 64, {"R", "G", "B", "A"}, std::vector<float>(4 * 64 * 64, 0.5f)};
  write_image(image, folder_ / "alpha.exr");
  EXPECT_EQ(refusal(folder_ / "alpha.exr", {}),
            "alpha.exr: pixel (0, 0) is transparent; crop to the cloth, or save without alpha");
}

// A film's or a file's channels by their names; one of grey counts thrice, and alpha is no colour.
TEST_F(FitPhotograph, ChannelsAreFoundByName) {
  const Image layers{1, 1, {"variance.R", "B", "G", "R"}, {9, 3, 2, 1}};
  EXPECT_EQ(picture_of(layers, "layers").pixels, (std::vector<float>{1, 2, 3}));
  const Image grey{1, 1, {"Y", "A"}, {0.5f, 1}};
  EXPECT_EQ(picture_of(grey, "grey").pixels, (std::vector<float>{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(user_message([] { picture_of(Image{}, "none"); }), "none: an image without pixels");
  // 8-bit grey with alpha all 1 is not clipped.
  const Photograph photograph = read_photograph(folder_.write("grey.png", grey_png(70, 70, 128, 255)), {});
  EXPECT_NEAR(photograph.picture.at(3, 3)[2], srgb_to_linear(128 / 255.0), 1e-6);
  EXPECT_TRUE(photograph.warnings.empty());
  EXPECT_NE(refusal(folder_.write("clear.png", grey_png(70, 70, 128, 254)), {}).find("is transparent"),
            std::string::npos);
}

TEST_F(FitPhotograph, AnUnevenReferenceAndFewPixelsAreWarnings) {
  const auto file = folder_.write("u.ppm", ppm(64, 64, 8, [](int x, int, int) { return x < 4 ? 60 : 110; }));
  const auto warnings = read_photograph(file, {.grey = kCard, .crop = Rectangle{8, 0, 20, 20}}).warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("grey: varies by"), std::string::npos);
  EXPECT_NE(warnings[1].find("20 x 20 pixels of cloth"), std::string::npos);
}

constexpr double kSixteenBits = 2e-5;  // one step of 16 bits, by OpenImageIO's PNM reader

// With a card in the front picture, exposures say how much longer the back's was.
TEST_F(FitPhotograph, ACardAndTwoExposures) {
  const auto file = [&](const std::string& name, int card, int cloth) {
    return folder_.write(name, ppm(80, 80, 16, [=](int x, int, int) { return x < 8 ? card : cloth; }));
  };
  PairOptions options;
  for (PhotographOptions* one : {&options.front, &options.back}) {
    one->transfer = Transfer::linear;
    one->crop = Rectangle{8, 0, 72, 80};
  }
  options.front.grey = kCard;
  options.front.exposure = 2;
  options.back.exposure = 20;
  const auto pair = read_pair(file("f.ppm", 18000, 40000), file("b.ppm", 5, 30000), options).pictures;
  EXPECT_NEAR(pair.front.at(1, 1)[0], 0.18 * 40000 / 18000, kSixteenBits);
  EXPECT_NEAR(pair.back.at(1, 1)[0], 0.18 * 3000 / 18000, kSixteenBits);
}

TEST_F(FitPhotograph, DarkInEightBitsAndEnlargedAreWarnings) {
  const auto warnings_of = [&](int bits, int value, const PhotographOptions& options = {}) {
    return read_photograph(folder_.write("w.ppm", ppm(70, 70, bits, [=](int, int, int) { return value; })), options)
        .warnings;
  };
  const auto dark = warnings_of(8, 24);
  ASSERT_EQ(dark.size(), 1u);
  EXPECT_NE(dark[0].find("its mean is 0.0091 of full scale, where 8 bits have coarse steps"), std::string::npos)
      << dark[0];
  EXPECT_TRUE(warnings_of(8, 27).empty());
  EXPECT_TRUE(warnings_of(16, 24 * 257).empty());
  EXPECT_TRUE(warnings_of(8, 99, {.size = ivec2(70, 70)}).empty());
  const Corners corners{dvec2(0, 0), dvec2(66, 0), dvec2(66, 70), dvec2(0, 70)};
  for (const PhotographOptions& options : {PhotographOptions{.crop = Rectangle{0, 0, 66, 70}, .size = ivec2(67, 64)},
                                           PhotographOptions{.corners = corners, .size = ivec2(67, 64)}}) {
    const auto larger = warnings_of(8, 99, options);
    ASSERT_EQ(larger.size(), 1u);
    EXPECT_NE(larger[0].find("size 67 x 64 is more than the 66 x 70 pixels of its cloth"), std::string::npos);
  }
}

// The back is exposed eight times as long; the card was in the front's picture.
TEST_F(FitPhotograph, TheBackTakesTheFrontsGains) {
  PairOptions options;
  options.front.gains = {2, 3, 4};
  options.front.exposure = 0.01;
  options.back.exposure = 0.08;
  const auto pair = read_pair(cloth("front.ppm", 0.4), cloth("back.ppm", 0.3), options).pictures;
  const Picture front = stitches(80, 80, 0, 0.4), back = stitches(80, 80, 0, 0.3);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pair.front.at(11, 5)[c] / (front.at(11, 5)[c] * (2 + c) / 0.01f), 1, 2e-4);
    EXPECT_NEAR(pair.back.at(11, 5)[c] / (back.at(11, 5)[c] * (2 + c) / 0.08f), 1, 2e-4);
  }
}

TEST_F(FitPhotograph, PairsThatAreNone) {
  const auto front = cloth("front.ppm", 0.4);
  const auto refused = [&](const std::filesystem::path& back, const PairOptions& options = {}) {
    const std::string line = user_message([&] { read_pair(front, back, options); });
    std::string text = line;
    for (size_t at; (at = text.find(folder_.path().string() + "/")) != std::string::npos;)
      text.erase(at, folder_.path().string().size() + 1);
    return text;
  };
  EXPECT_EQ(refused(flat("other.ppm", 90)),
            "other.ppm: 64 x 64 pixels, but front.ppm has 80 x 80; crop both alike, or give a size");
  const std::string same = "front.ppm: the same picture as front.ppm; one lit from behind is needed";
  EXPECT_EQ(refused(front), same);
  PairOptions scaled;  // which makes its numbers others
  scaled.front.exposure = 0.026;
  scaled.back.exposure = 0.2;
  EXPECT_EQ(refused(front, scaled), same);
  scaled.front.gains = {3, 1.7, 0.9};
  EXPECT_EQ(refused(front, scaled), same);
  scaled.back.gains = {0.7, 0.9, 1.1};
  EXPECT_EQ(refused(front, scaled), same);
  EXPECT_NO_THROW(read_pair(front, cloth("nearly.ppm", 0.4001), scaled));
  PairOptions options;
  options.back.exposure = 1e5;
  EXPECT_EQ(refused(cloth("back.ppm", 0.3), options),
            "back.ppm: no light comes through: its mean is 7.5e-06 of the front's; was the lamp behind on?");
  options.back.exposure = 100;
  const auto warnings = read_pair(front, folder_ / "back.ppm", options).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("its mean is 0.0075 of the front's"), std::string::npos);
  EXPECT_TRUE(read_pair(front, folder_ / "back.ppm", {}).warnings.empty());
}

}  // namespace
}  // namespace wale::fit
