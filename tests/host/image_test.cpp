// Image files, the view transform, atomic writing.
#include "host/image.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <limits>

#include "host/atomic_file.h"
#include "host/export_curves.h"
#include "host/schema.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

Image ramp(int width, int height, const std::vector<std::string>& channels) {
  Image image{width, height, channels, std::vector<float>(size_t(width) * height * channels.size())};
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i) * 0.37f - 1.0f;
  return image;
}

// Stands for a full disk: no file may grow past `bytes` while this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::fflush(nullptr);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(Image, ExrKeepsEveryChannelToTheBit) {
  TemporaryFolder folder;
  const Image image = ramp(7, 5, {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "variance.R", "depth.Z"});
  write_image(image, folder / "a.exr");
  const Image back = read_image(folder / "a.exr");
  ASSERT_EQ(back.width, 7);
  ASSERT_EQ(back.height, 5);
  ASSERT_EQ(back.channels.size(), image.channels.size());
  for (size_t c = 0; c < image.channels.size(); ++c) {
    // The format sorts channels by name.
    const auto found = std::find(back.channels.begin(), back.channels.end(), image.channels[c]);
    ASSERT_NE(found, back.channels.end()) << image.channels[c];
    const size_t at = found - back.channels.begin();
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) ASSERT_EQ(back.at(x, y)[at], image.at(x, y)[c]) << image.channels[c];
  }
}

TEST(Image, SameImageSameBytes) {
  TemporaryFolder folder;
  for (const char* suffix : {".exr", ".png"}) {
    const Image image = ramp(16, 9, {"R", "G", "B"});
    write_image(image, folder / (std::string("a") + suffix));
    write_image(image, folder / (std::string("b") + suffix));
    const std::string a = file_text(folder / (std::string("a") + suffix));
    EXPECT_GT(a.size(), 50u);
    EXPECT_EQ(a, file_text(folder / (std::string("b") + suffix)));
  }
}

TEST(Image, PngIsWithinOneStepOfTheViewTransform) {
  TemporaryFolder folder;
  Image image{64, 64, {"R", "G", "B"}, std::vector<float>(64 * 64 * 3)};
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i) / float(image.pixels.size());
  write_image(image, folder / "a.png", 0.5, "srgb");
  const Image back = read_image(folder / "a.png");
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      float display[3];
      view_transform(image.at(x, y), 0.5, "srgb", display);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(linear_to_srgb(back.at(x, y)[c]), display[c], 1.001 / 255) << x << ' ' << y << ' ' << c;
    }
}

TEST(Image, DitherKeepsTheMeanOfAFlatShade) {
  TemporaryFolder folder;
  const double wanted = 100.3 / 255;  // between two 8-bit values
  Image image{128, 128, {"R", "G", "B"}, std::vector<float>(128 * 128 * 3, float(srgb_to_linear(wanted)))};
  write_image(image, folder / "a.png", 0, "srgb");
  const Image back = read_image(folder / "a.png");
  double sum = 0;
  for (float v : back.pixels) sum += std::round(255 * linear_to_srgb(v));
  // 49152 independent Bernoulli(0.3): standard deviation of the mean 0.0021.
  EXPECT_NEAR(sum / back.pixels.size(), 100.3, 0.01);
}

TEST(Image, BlackAndWhiteStayPure) {
  TemporaryFolder folder;
  Image image{32, 32, {"R", "G", "B"}, std::vector<float>(32 * 32 * 3, 0.0f)};
  std::fill(image.pixels.begin(), image.pixels.begin() + 32 * 16 * 3, 1.0f);
  write_image(image, folder / "a.png", 0, "srgb");
  const Image back = read_image(folder / "a.png");
  EXPECT_EQ(*std::min_element(back.pixels.begin(), back.pixels.begin() + 32 * 16 * 3), 1.0f);
  EXPECT_EQ(*std::max_element(back.pixels.begin() + 32 * 16 * 3, back.pixels.end()), 0.0f);
}

TEST(Image, NanIsRefusedWithItsPixel) {
  TemporaryFolder folder;
  Image image = ramp(4, 3, {"R", "G", "B"});
  image.at(2, 1)[1] = std::numeric_limits<float>::quiet_NaN();
  write_image(image, folder / "a.exr");
  EXPECT_EQ(read_image(folder / "a.exr").width, 4) << "accepted where finite values are not asked for";
  EXPECT_EQ(user_message([&] { read_image(folder / "a.exr", true); }),
            (folder / "a.exr").string() + ": pixel (2, 1), channel G: nan is not a finite number");
}

TEST(Image, MissingFileIsRefused) {
  EXPECT_EQ(user_message([] { read_image("/no/such.exr"); }), "/no/such.exr: no such image file");
}

TEST(Image, BrokenFilesAreRefused) {
  TemporaryFolder folder;
  write_image(ramp(64, 64, {"R", "G", "B"}), folder / "a.exr");
  const std::string whole = file_text(folder / "a.exr");
  folder.write("cut.exr", whole.substr(0, whole.size() / 2));
  folder.write("text.png", "this is no image");
  folder.write("empty.hdr", "");
  for (const char* name : {"cut.exr", "text.png", "empty.hdr"}) {
    const std::string message = user_message([&] { read_image(folder / name); });
    EXPECT_NE(message.find("cannot be read as an image"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

// The header's promise alone must not make the program reserve gigabytes.
TEST(Image, HeaderThatPromisesMoreThanTheFileHoldsIsRefused) {
  std::string tga(18, '\0');
  tga[2] = 2, tga[16] = 24;
  for (const size_t at : {12, 14}) tga[at] = '\0', tga[at + 1] = '\x60';  // 24576 pixels
  const TemporaryFolder folder;
  const std::string message = user_message([&] { read_image(folder.write("a.tga", tga)); });
  EXPECT_NE(message.find("24576 x 24576 pixels do not fit into its 18 bytes"), std::string::npos) << message;
}

TEST(Image, ExrHeaderThatPromisesMoreThanTheFileHoldsIsRefused) {
  const TemporaryFolder folder;
  write_image(ramp(6, 5, {"R", "G", "B"}), folder / "a.exr");
  const std::string whole = file_text(folder / "a.exr");
  // The header with the 32-bit number `at` bytes behind the start of the attribute `name` changed.
  const auto refused = [&](std::string_view name, size_t at, std::string_view number) {
    std::string bytes = whole;
    bytes.replace(bytes.find(name) + at, 4, number);
    return user_message([&] { parse_image(bytes, "a.exr"); });
  };
  const std::string_view window{"dataWindow\0box2i\0", 17}, lines{"lineOrder\0lineOrder\0", 20};
  const std::string_view billion{"\0\0\0\x40", 4};
  const std::string bytes = std::to_string(whole.size());
  EXPECT_EQ(refused(window, 17 + 16, billion),
            "a.exr: 6 x 1073741825 pixels do not fit into its " + bytes + " bytes; is the file cut off?");
  EXPECT_EQ(
      refused(window, 17 + 12, billion),
      "a.exr: 1073741825 x 16 pixels of 3 channels in one piece are too many; write it in smaller tiles or lines");
  const size_t left = whole.size() - whole.find(lines) - 24;
  EXPECT_EQ(refused(lines, 20, billion), "a.exr: attribute \"lineOrder\" has 1073741824 bytes, but the file has only " +
                                             std::to_string(left) + " more; is the file cut off?");
  for (size_t end = 4; end < whole.find(lines) + 24; ++end)
    EXPECT_NE(user_message([&] { parse_image(whole.substr(0, end), "a.exr"); }).find("is the file cut off?"),
              std::string::npos)
        << end;
}

TEST(Image, ExrAttributeOfAnotherSizeThanItSaysIsRefused) {
  const TemporaryFolder folder;
  write_image(ramp(6, 5, {"R", "G", "B"}), folder / "a.exr");
  const std::string whole = file_text(folder / "a.exr");
  const std::string_view channels{"channels\0chlist\0", 16}, lines{"lineOrder\0lineOrder\0", 20};
  // One letter more in a channel's name: OpenEXR would take what follows for sizes, gigabytes among them.
  std::string longer = whole;
  longer.insert(longer.find(channels) + 20, "x");
  EXPECT_EQ(user_message([&] { parse_image(longer, "a.exr"); }),
            "a.exr: attribute \"channels\" of type chlist says 55 bytes and has 56; is the file damaged?");
  std::string texts = whole;
  texts.insert(texts.find(lines), std::string("names\0stringvector\0\x08\0\0\0\xff\xff\xff\x7fwool", 31));
  EXPECT_EQ(user_message([&] { parse_image(texts, "a.exr"); }),
            "a.exr: attribute \"names\" of type stringvector says 8 bytes and has 2147483651; is the file damaged?");
}

TEST(Image, PngChunkLongerThanTheFileIsRefused) {
  const TemporaryFolder folder;
  write_image(ramp(6, 5, {"R", "G", "B"}), folder / "a.png");
  std::string bytes = file_text(folder / "a.png");
  const size_t at = bytes.find("IDAT");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at - 4, 8, "\x5e\x01\x01\x01tEXt");  // a text of 1.6e9 bytes before the pixels
  EXPECT_EQ(user_message([&] { parse_image(bytes, "a.png"); }),
            "a.png: chunk \"tEXt\" has 1577124097 bytes, but the file has only " +
                std::to_string(bytes.size() - at - 4) + " more; is the file cut off?");
}

TEST(Image, OtherFormatsAreRefused) {
  const TemporaryFolder folder;
  const std::string message = user_message([&] { read_image(folder.write("a.psd", "8BPS")); });
  EXPECT_NE(message.find("cannot be read as an image; formats are EXR, HDR, PNG, JPEG, TIFF, BMP, TGA, PNM"),
            std::string::npos)
      << message;
}

TEST(Image, RealEnvironmentMapsAreReadWhole) {
  const char* data = std::getenv("WALE_REAL_DATA");
  if (!data) GTEST_SKIP() << "real data not present";
  struct Known {
    const char* name;
    int width, height;
    float luminance;  ///< of the brightest pixel
  };
  // Run-length RGBE and DWA-compressed half EXR.
  for (const Known& known :
       {Known{"blender-studiolights-hdr/studio.hdr", 1024, 512, 111}, {"pmndrs/city.exr", 512, 256, 10}}) {
    const Image image = read_image(std::filesystem::path(data) / "envmaps" / known.name, true);
    EXPECT_EQ(image.width, known.width) << known.name;
    EXPECT_EQ(image.height, known.height) << known.name;
    float largest = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float* p = image.at(x, y);
        largest = std::max(largest, 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]);
      }
    EXPECT_NEAR(largest, known.luminance, 0.55) << known.name;
  }
}

TEST(Image, UnwritablePlacesAreRefusedBeforeRendering) {
  TemporaryFolder folder;
  EXPECT_EQ(user_message([] { require_writable("/no/such/folder/a.png"); }),
            "/no/such/folder/a.png: the folder /no/such/folder does not exist; make it first");
  EXPECT_EQ(user_message([] { require_writable("out/"); }),
            "out/: this names a folder; give the name of a picture, .exr or .png");
  EXPECT_EQ(user_message([] { require_writable("a.jpg"); }), "a.jpg: images are written as .exr or .png, not \".jpg\"");
  std::filesystem::create_directory(folder / "dir.exr");
  EXPECT_TRUE(user_message([&] { require_writable(folder / "dir.exr"); }).find("this is a folder") !=
              std::string::npos);
  EXPECT_TRUE(user_message([] { require_writable("/proc/a.png"); }).find("cannot be written") != std::string::npos);
  require_writable(folder / "good.PNG");
  EXPECT_EQ(folder.files(), 1u) << "the check leaves nothing behind";
}

TEST(AtomicFile, NothingIsLeftWithoutCommit) {
  TemporaryFolder folder;
  folder.write("a.txt", "old");
  {
    AtomicFile file(folder / "a.txt");
    EXPECT_EQ(file.temporary().extension(), ".txt");
    EXPECT_EQ(file.temporary().parent_path(), folder.path());
    std::ofstream(file.temporary()) << "half";
    EXPECT_EQ(folder.files(), 2u);
  }
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_EQ(file_text(folder / "a.txt"), "old");
  write_text_file(folder / "a.txt", "new");
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_EQ(file_text(folder / "a.txt"), "new");
}

TEST(AtomicFile, AWorkingFolderThatHasGoneIsTheUsersError) {
  const auto before = std::filesystem::current_path();
  {
    TemporaryFolder folder;
    std::filesystem::current_path(folder.path());
  }
  const std::string line = user_message([] { AtomicFile("a.txt"); });
  std::filesystem::current_path(before);
  EXPECT_EQ(line, "a.txt: the folder . cannot be written");
}

// What a writer that was killed has left goes with the next writing of the same file; all else stays.
TEST(AtomicFile, WhatAKilledWriterLeftIsRemovedByTheNext) {
  TemporaryFolder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    new AtomicFile(folder / "a.txt");
    new AtomicFile(folder / "b.txt");
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(folder.files(), 2u) << "both of the killed writer";
  const auto left = [&](const char* begin) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      if (entry.path().filename().string().starts_with(begin)) return entry.path().filename().string();
    return std::string();
  };
  // Of a writer that lives, of one on another machine, and what only looks like one.
  const std::string dead = left(".a."), number = fmt::format(".{}.", child);
  const size_t at = dead.find(number);
  ASSERT_NE(at, std::string::npos) << dead;
  const std::string rest = dead.substr(at + number.size());
  const std::string alive = fmt::format("{}.{}.{}", dead.substr(0, at), ::getppid(), rest);
  const std::string other_end = dead.substr(0, dead.size() - 4) + ".json",
                    more = dead.substr(0, at) + ".x" + dead.substr(at);
  std::string elsewhere = dead;
  elsewhere[3] = elsewhere[3] == '0' ? '1' : '0';
  for (const std::string& name : {alive, elsewhere, other_end, more}) folder.write(name, "kept");
  write_text_file(folder / "a.txt", "new");
  EXPECT_FALSE(std::filesystem::exists(folder / dead));
  EXPECT_EQ(folder.files(), 1 + 1 + 4u) << "a.txt, what was left of b.txt, and the four";
  write_text_file(folder / "b.txt", "new");
  EXPECT_EQ(left(".b."), "");
}

// A folder of frames may hold thousands of files: it is looked through by the first writing into it, not by each.
TEST(AtomicFile, AFolderIsLookedThroughOnce) {
  TemporaryFolder folder;
  for (const char* name : {"a.txt", "b.txt"}) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      new AtomicFile(folder / name);
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    write_text_file(folder / "a.txt", "new");
  }
  EXPECT_EQ(folder.files(), 2u) << "what was left of a.txt has gone";
  write_text_file(folder / "b.txt", "new");
  EXPECT_EQ(folder.files(), 3u) << "what was left of b.txt since then waits for the next run";
}

TEST(AtomicFile, FullDiskIsReportedAndLeavesNothing) {
  TemporaryFolder folder;
  const std::string text(100000, 'x');
  Image noise = ramp(200, 200, {"R", "G", "B"});
  for (size_t i = 0; i < noise.pixels.size(); ++i) noise.pixels[i] = float(i * 2654435761u % 1000003u) * 1e-6f;
  const std::pair<const char*, std::function<void()>> writers[] = {
      {"text", [&] { write_text_file(folder / "a.txt", text); }},
      {"exr", [&] { write_image(noise, folder / "a.exr"); }},
      {"png", [&] { write_image(noise, folder / "a.png"); }},
      {"curves",
       [&] {
         export_curves({{std::vector<std::array<float, 3>>(5000), 1}}, folder / "a.obj");
       }},
  };
  for (const auto& [name, write] : writers) {
    std::string message;
    {
      const FileSizeLimit limit(4096);
      message = user_message(write);
    }
    EXPECT_NE(message.find("cannot be written"), std::string::npos) << name << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << name << ": " << message;
    EXPECT_EQ(folder.files(), 0u) << name;
  }
}

TEST(AtomicFile, RefusedRenameLeavesNothing) {
  TemporaryFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    std::filesystem::create_directory(folder / "a.txt");  // appears in the meantime: rename must fail
    const std::string message = user_message([&] { file.commit(); });
    EXPECT_NE(message.find("a.txt: cannot be written"), std::string::npos) << message;
  }
  EXPECT_EQ(folder.files(), 1u);
}

TEST(ViewTransform, IsMonotoneAndStaysInRange) {
  for (const char* view : {"neutral", "srgb"}) {
    float before = -1;
    for (float v = 0; v < 1e6f; v = v * 1.07f + 1e-4f) {
      const float linear[3] = {v, v, v};
      float display[3];
      view_transform(linear, 0, view, display);
      ASSERT_GE(display[0], before) << view << ' ' << v;
      ASSERT_LE(display[0], 1.0f) << view << ' ' << v;
      ASSERT_EQ(display[0], display[1]);
      ASSERT_EQ(display[0], display[2]);
      before = display[0];
    }
    EXPECT_GT(before, 0.99f) << view;
  }
}

TEST(ViewTransform, NeutralKeepsMidtonesButForTheOffset) {
  // Below the shoulder and above 0.08: c - 0.04, hue and saturation kept (Khronos PBR Neutral).
  const float linear[3] = {0.5f, 0.3f, 0.1f};
  float display[3];
  view_transform(linear, 0, "neutral", display);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(srgb_to_linear(display[c]), linear[c] - 0.04, 1e-6);
}

TEST(ViewTransform, NeutralIsContinuousAtItsShoulder) {
  float below[3], above[3];
  const float a[3] = {0.79999f, 0.4f, 0.4f}, b[3] = {0.80001f, 0.4f, 0.4f};
  view_transform(a, 0, "neutral", below);
  view_transform(b, 0, "neutral", above);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(below[c], above[c], 3e-5);
}

TEST(ViewTransform, ExposureIsInStops) {
  const float half[3] = {0.25f, 0.25f, 0.25f}, whole[3] = {0.5f, 0.5f, 0.5f};
  float a[3], b[3];
  view_transform(half, 1, "srgb", a);
  view_transform(whole, 0, "srgb", b);
  EXPECT_EQ(a[0], b[0]);
  EXPECT_NEAR(b[0], 0.735357, 1e-5);  // sRGB encoding of 0.5
}

TEST(ViewTransform, NothingBadComesOut) {
  const float bad = std::numeric_limits<float>::quiet_NaN(), big = std::numeric_limits<float>::infinity();
  const float inputs[][3] = {{bad, 1, 1}, {big, 0, 0}, {-1, -2, -3}, {3e38f, 3e38f, 0}};
  for (const auto& input : inputs)
    for (const char* view : {"neutral", "srgb"}) {
      float display[3];
      view_transform(input, 20, view, display);
      for (float v : display) EXPECT_TRUE(v >= 0 && v <= 1) << v;
    }
}

TEST(ViewTransform, UnknownViewIsRefused) {
  const float linear[3] = {0, 0, 0};
  float display[3];
  EXPECT_EQ(user_message([&] { view_transform(linear, 0, "filmic", display); }),
            "view \"filmic\": not known; valid: \"neutral\", \"srgb\"");
}

// Red of half coverage is red: colours are taken as they are stored.
TEST(ReadImage, AlphaDoesNotDarkenColours) {
  const TemporaryFolder folder;
  std::string tga(18, '\0');  // Truevision: uncompressed true colour, 1 x 1, 32 bits, 8 of them alpha
  tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 32, tga[17] = 8;
  tga += std::string("\x00\x00\xff\x80", 4);  // blue, green, red, alpha
  const Image image = read_image(folder.write("red.tga", tga));
  ASSERT_EQ(image.channels.size(), 4u);
  EXPECT_NEAR(image.pixels[0], 1, 1e-5);
  EXPECT_NEAR(image.pixels[1], 0, 1e-5);
}

}  // namespace
}  // namespace wale
