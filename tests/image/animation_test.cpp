// Cloth that moves: the pictures of its frames, and of a shutter that stays open.
#include <cmath>
#include <numbers>

#include "geom/base_mesh_generators.h"
#include "host/live_scene.h"
#include "tests/geom/remeshed.h"
#include "tests/geom/sequence_fixtures.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/temporary_folder.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

constexpr int kPixels = 20;
constexpr int kSpp = 512;  // of pictures that are compared by their noise

class Animation : public ::testing::Test {
 protected:
  // `mesh` is JSON, `keys` members of animation.keys, `more` of the scene.
  void write(const std::string& mesh, const std::string& keys = "", const std::string& camera = "[0, 0, 0.2]",
             const std::string& more = "") {
    file_ = folder_.write("scene.json", R"({"wale": 1, "film": {"size": [20, 20], "filter": "box"},
 "camera": {"position": )" + camera + R"(, "fov": 20}, "animation": {"keys": {)" +
                                            keys + R"(}}, "fabrics": [{"name": "cloth", "mesh": )" + mesh +
                                            R"(, "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 25}}],
 "lights": [{"type": "environment", "radiance": 1}])" +
                                            more + "}");
  }
  Scene at(double frame, const std::vector<std::string>& set = {}) const {
    std::vector<std::string> all = set;
    all.push_back(fmt::format("animation.frame={}", frame));
    return read_scene(file_, all);
  }
  Image picture(int spp = 32, unsigned seed = 0) const {
    IntegratorScene integrator = live_.scene().integrator;
    integrator.seed = seed;
    RenderOptions options;
    options.spp = spp;
    return render(live_.devices(), live_.world(), integrator, options).image;
  }
  // As a sequence of its own; `shape` takes the UV of a 6 cm swatch, in metres from its middle, and the frame.
  std::string sequence(int frames, const std::function<dvec3(dvec2, double)>& shape) {
    std::vector<BaseMesh> meshes;
    for (int n = 0; n < frames; ++n) {
      BaseMesh mesh = make_swatch(0.06, 0.06, 8, 8);
      for (dvec3& p : mesh.position) p = shape(dvec2(p), n);
      meshes.push_back(mesh);
    }
    folder_.write("c.bin", bin_file(meshes));
    return R"({"frames": "c.bin"})";
  }

  TemporaryFolder folder_;
  std::filesystem::path file_;
  Loaders loaders_{[](const auto& file) { return read_mesh(file); }, {}, {}};
  LiveScene live_{std::span(&device(), 1), loaders_, {}};
};

dvec3 wave(dvec2 p, double frame) { return {p.x * (1 + 0.05 * frame), p.y, 0.004 * std::sin(150 * p.x + frame)}; }

// Warped and refitted on the device, a frame is the picture that it is when it is the first.
TEST_F(Animation, AFrameIsTheSameWhateverCameBefore) {
  write(sequence(4, wave));
  for (const double frame : {0.0, 3.0, 1.0, 1.5}) {
    const Redone redone = live_.apply(at(frame));
    EXPECT_EQ(redone.knitted, frame == 0 ? 1u : 0u);
    EXPECT_EQ(redone.moved, frame != 0);
    EXPECT_EQ(redone.fabrics, frame == 0);
    EXPECT_EQ(different_pixels(picture(), take(at(frame), 32).image), 0u) << frame;
  }
  EXPECT_FALSE(live_.apply(at(1.5)).moved);
  EXPECT_GT(different_pixels(take(at(0), 32).image, take(at(3), 32).image), size_t(kPixels * kPixels / 2));
}

// What follows from the mesh is knitted anew.
TEST_F(Animation, WhatCannotFollowIsKnittedAnew) {
  write(sequence(3, wave));
  for (const char* other : {"fabrics.0.mesh.topology=changing", "fabrics.0.lattice=2"}) {
    live_.apply(at(0, {other}));
    const Redone redone = live_.apply(at(2, {other}));
    EXPECT_EQ(redone.knitted, 1u) << other;
    EXPECT_TRUE(redone.fabrics);
    EXPECT_EQ(different_pixels(picture(), take(at(2, {other}), 32).image), 0u) << other;
  }
}

// Camera and cloth move as one body, through a light that is the same everywhere.
TEST_F(Animation, ARigidlyMovingClothIsTheSameInItsOwnFrame) {
  constexpr double kTurn = 0.5, kFar = 3;
  const auto rigid = [&](const dvec3& p, double frame) {
    const double c = std::cos(kTurn * frame), s = std::sin(kTurn * frame);
    return dvec3(c * p.x + s * p.z + kFar * frame, p.y - frame, c * p.z - s * p.x);
  };
  const auto list = [](const dvec3& p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); };
  const std::string mesh = sequence(3, [&](dvec2 p, double frame) { return rigid(wave(p, 0), frame); });
  std::string position, look_at;
  for (int n = 0; n < 3; ++n) {
    position += fmt::format("{}[{}, {}]", n ? ", " : "", n, list(rigid({0.03, 0.02, 0.2}, n)));
    look_at += fmt::format("{}[{}, {}]", n ? ", " : "", n, list(rigid({0, 0, 0}, n)));
  }
  write(mesh, R"("camera.position": [)" + position + R"(], "camera.look_at": [)" + look_at + "]");
  live_.apply(at(0));
  const Image still = picture(kSpp, 1);
  for (const double frame : {1.0, 2.0}) {
    live_.apply(at(frame));
    const Image moved = picture(kSpp, 2);
    size_t tests = 0;
    const double p = smallest_p(still, moved, tests);
    EXPECT_GT(p, sidak(tolerance::kFamilyP, tests)) << frame;
    EXPECT_GT(smallest_p_of_means(still, moved), tolerance::kFamilyP) << frame;
  }
  // The test sees a cloth that does not come along.
  live_.apply(at(1, {"fabrics.0.transform.translate=[0.002, 0, 0]"}));
  size_t tests = 0;
  const double p = smallest_p(still, picture(kSpp, 2), tests);
  EXPECT_LT(p, sidak(tolerance::kFamilyP, tests));
}

// Each frame a mesh of its own: where the shape is affine, it is what a mesh that stays would show.
TEST_F(Animation, ARemeshedClothIsThatOfOneMesh) {
  const auto affine = [](dvec2 p, double frame) {
    return dvec3(p.x * (1 + 0.1 * frame) + 0.1 * frame * p.y, p.y, 0.2 * frame * p.x);
  };
  write(sequence(3, affine));
  live_.apply(at(2));
  const Image one = picture(kSpp, 1);
  for (int n = 0; n < 3; ++n)
    write_obj(remeshed_cloth({0.06, 0.06}, uint32_t(7 + n), [&](dvec2 uv) { return affine(uv - 0.03, n); }),
              folder_ / fmt::format("r_{:02}.obj", n));
  write(R"({"frames": "r_##.obj", "topology": "changing"})");
  live_.apply(at(0));
  EXPECT_EQ(live_.apply(at(2)).knitted, 1u);
  const Image other = picture(kSpp, 2);
  size_t tests = 0;
  double p = smallest_p(one, other, tests);
  EXPECT_GT(p, sidak(tolerance::kFamilyP, tests));
  // Knitted to the gauge of the stretched mesh it would be another cloth.
  write(R"({"frames": "r_##.obj", "topology": "changing", "rest": 2})");
  live_.apply(at(2));
  tests = 0;
  p = smallest_p(one, picture(kSpp, 2), tests);
  EXPECT_LT(p, sidak(tolerance::kFamilyP, tests));
}

// Samples at moments of the shutter, as the program makes them.
Rendered blurred(LiveScene& live, const std::function<Scene(double)>& at, double frame, double shutter,
                 uint32_t moments, int spp, unsigned seed = 0, bool aovs = false) {
  const auto time = [&](uint32_t k) { return frame + shutter * (k + 0.5) / moments; };
  live.apply(at(time(0)));
  RenderOptions options;
  options.spp = spp;
  options.moments = moments;
  options.aovs = aovs;
  options.at_moment = [&](uint32_t k) {
    live.apply(at(time(k)));
    return Moment{&live.world(), live.devices()};
  };
  IntegratorScene integrator = live.scene().integrator;
  integrator.seed = seed;
  return render(live.devices(), live.world(), integrator, options);
}

// A glowing square moves by half the picture while the shutter is open: each of its edges becomes a ramp, which is the
// edge averaged over a box as long as its way.
TEST_F(Animation, ABlurredEdgeIsTheEdgeUnderABox) {
  constexpr double kSize = 0.4, kWay = 0.5;  // in pictures
  file_ = folder_.write("scene.json", fmt::format(R"({{"wale": 1, "film": {{"size": [40, 8], "filter": "box"}},
 "camera": {{"type": "orthographic", "position": [0, 0, 1], "height": 0.2}},
 "animation": {{"keys": {{"lights.square.transform.translate": [[0, [-0.3, 0, 0]], [1, [0.2, 0, 0]]]}}}},
 "lights": [{{"type": "mesh", "name": "square", "mesh": {{"generator": "swatch", "width": {}, "height": 1}}}}]}})",
                                                  kSize));
  constexpr uint32_t kMoments = 32;
  const auto scene = [&](double frame) { return at(frame); };
  const Image image = blurred(live_, scene, 0, 1, kMoments, kSpp).image;
  // Share of the time in which x is inside the square, and its mean over a pixel by Simpson's rule on many parts.
  const auto inside = [&](double x) {
    const double from = (x - kSize / 2 + 0.3) / kWay, to = (x + kSize / 2 + 0.3) / kWay;
    return std::max(0.0, std::min(1.0, to) - std::max(0.0, from));
  };
  double sum = 0, wanted_sum = 0, worst = 0;
  for (int x = 0; x < 40; ++x) {
    double wanted = 0, found = 0;
    for (int i = 0; i < 100; ++i) wanted += inside((x + (i + 0.5) / 100) / 40 - 0.5) / 100;
    for (int y = 0; y < 8; ++y) found += image.at(x, y)[0] / 8;
    worst = std::max(worst, std::abs(found - wanted));
    sum += found, wanted_sum += wanted;
  }
  EXPECT_LT(worst, 0.2 / kMoments);  // of the staircase of the moments what pixels, wider than its steps, leave
  EXPECT_NEAR(sum, wanted_sum, 1e-3 * wanted_sum);
  live_.apply(at(0.5));
  EXPECT_NEAR(mean_rgb(picture(kSpp))[0], mean_rgb(image)[0], tolerance::kFurnaceMean);  // the same light, elsewhere
  EXPECT_GT(different_pixels(picture(kSpp), image), 100u);
}

// A cloth's blurred picture is the mean of its moments, each by itself.
TEST_F(Animation, ABlurredClothIsTheMeanOfItsMoments) {
  write(sequence(2, [](dvec2 p, double frame) { return wave(p, frame) + dvec3(0.02 * frame, 0, 0.01 * frame); }),
        R"("camera.position": [[0, [0, 0, 0.2]], [1, [0.01, 0, 0.2]]], "lights.0.intensity": [[0, 1], [1, 2]])");
  const auto scene = [&](double frame) { return at(frame); };
  const Rendered rendered = blurred(live_, scene, 0, 1, 4, kSpp, 1);
  EXPECT_EQ(bad_events(rendered.counts), 0u);
  EXPECT_FALSE(rendered.stopped);
  EXPECT_EQ(rendered.reached.mean, kSpp);
  Image mean;
  for (int k = 0; k < 4; ++k) {
    const Image still = take(at((k + 0.5) / 4), kSpp, unsigned(2 + k)).image;
    if (k == 0) mean = still, std::fill(mean.pixels.begin(), mean.pixels.end(), 0.0f);
    const size_t n = still.channels.size();
    for (size_t i = 0; i < still.pixels.size(); ++i) mean.pixels[i] += still.pixels[i] / (i % n < 3 ? 4.0f : 16.0f);
  }
  size_t tests = 0;
  const double p = smallest_p(rendered.image, mean, tests);
  EXPECT_GT(p, sidak(tolerance::kFamilyP, tests));
  EXPECT_GT(smallest_p_of_means(rendered.image, mean), tolerance::kFamilyP);
  tests = 0;
  const double first = smallest_p(rendered.image, take(at(0.125), 64, 9).image, tests);
  EXPECT_LT(first, sidak(tolerance::kFamilyP, tests));
}

// A cloth that leaves the origin of the first moment behind: where it was seen is still the mean of its moments.
TEST_F(Animation, PositionsOfABlurredClothCountFromOnePlace) {
  constexpr double kWay = 3;
  write(sequence(2, [](dvec2 p, double frame) { return dvec3(p, 0) + dvec3(kWay * frame, 0, 0); }),
        R"("camera.position": [[0, [0, 0, 0.2]], [1, [3, 0, 0.2]]], "camera.look_at": [[0, [0, 0, 0]], [1, [3, 0, 0]]])");
  live_.apply(at(0.875));
  const dvec3 last = live_.world().origin;
  live_.apply(at(0.125));
  ASSERT_NE(live_.world().origin, last) << "the origin must move for this test";
  const Image image = blurred(live_, [&](double frame) { return at(frame); }, 0, 1, 4, 16, 0, true).image;
  const auto channel = [&](const char* name) {
    return size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin());
  };
  const size_t x_at = channel("position.X"), y_at = channel("position.Y"), met = channel("coverage");
  const double pixel = 2 * 0.2 * std::tan(0.5 * 20 * std::numbers::pi / 180) / kPixels;
  size_t seen = 0;
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) {
      const float* p = image.at(x, y);
      if (p[met] < 1) continue;  // moments that missed would weigh less
      ++seen;
      EXPECT_NEAR(p[x_at], kWay / 2 + (x + 0.5 - kPixels / 2) * pixel, pixel) << x << " " << y;
      EXPECT_NEAR(p[y_at], -(y + 0.5 - kPixels / 2) * pixel, pixel) << x << " " << y;
    }
  EXPECT_GT(seen, 8u);
}

// One moment is the picture without any.
TEST_F(Animation, AShutterThatIsClosedChangesNothing) {
  write(R"({"generator": "swatch", "width": 0.06, "height": 0.06})");
  const Image plain = take(at(0), 16).image;
  const auto scene = [&](double frame) { return at(frame); };
  EXPECT_EQ(different_pixels(blurred(live_, scene, 0, 0, 1, 16).image, plain), 0u);
  // Of a scene that stands still many moments are the same picture too: the same samples.
  EXPECT_EQ(different_pixels(blurred(live_, scene, 0, 1, 4, 16).image, plain), 0u);
}

}  // namespace
}  // namespace wale::test
