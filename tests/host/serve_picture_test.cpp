// What a picture of the editor shows depends on the scene, the seed and its samples: not on how long waves took, nor on
// when edits came.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "geom/base_mesh.h"
#include "host/display_picture.h"
#include "host/live_scene.h"
#include "host/serve/editor_session.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

constexpr int kSize = 28;           // 16 tiles, of which those at the border are partly outside
constexpr uint32_t kSmallest = 64;  // paths in flight: one tile a wave
constexpr uint32_t kSamples = 16;   // two of each scramble; a power of two, whose picture is always shown
const Loaders kLoaders{[](const auto& file) { return read_mesh(file); }, {}};

/// Which picture: its shrink, and its samples.
using Stage = std::pair<int, uint32_t>;

/// Every picture until there are so many samples, rendered without a pause, by waves of at most `pool` paths.
std::map<Stage, Image> pictures(const Scene& scene, uint32_t pool) {
  Scene mine = scene;
  mine.integrator.pool = pool;
  LiveScene live(std::span(&device(), 1), kLoaders, {ProgressiveRender::options({}), true});
  live.apply(mine);
  ProgressiveRender render(device(), {});
  render.restart(live.world(), mine.integrator, *live.devices()[0].scene);
  std::map<Stage, Image> out;
  while (render.state().samples < kSamples) {
    render.step();
    const Stage stage{render.state().shrink, render.state().samples};
    if (stage.first > 0 && !out.contains(stage)) out[stage] = render.picture();
  }
  return out;
}

class ServePicture : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("scene.json", everything_scene(kSize, 30));
  Scene scene_ = read_scene(file_);
};

TEST_F(ServePicture, IsTheSameWithWavesOfAnySize) {
  const auto expected = pictures(scene_, 65536);
  ASSERT_EQ(expected.size(), 3 + kSamples) << "three that are smaller";
  for (const uint32_t pool : {kSmallest, 300u, 1000u}) {
    const auto found = pictures(scene_, pool);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [stage, image] : expected)
      EXPECT_EQ(different_pixels(found.at(stage), image), 0u)
          << pool << " paths, shrunk by " << stage.first << ", samples " << stage.second;
  }
}

/// A picture as viewers get it.
struct Published {
  Stage stage;
  int revision = 0;
  std::string jpeg;
};

// The pictures among the parts of the stream that are new.
std::vector<Published> published(const HttpReply& stream) {
  std::string text;
  stream.stream([&](std::string_view part) {
    text += part;
    return true;
  });
  std::vector<Published> out;
  for (size_t at = 0; (at = text.find("X-Wale-Topic: picture.0\r\n", at)) != std::string::npos; ++at) {
    const auto number = [&](const char* name, size_t from) {
      const size_t place = text.find(name, from);
      return place == std::string::npos ? -1 : std::atoi(text.c_str() + place + std::strlen(name));
    };
    const size_t part = text.rfind("--wale-part", at), body = text.find("\r\n\r\n", at) + 4;
    out.push_back({{number("X-Wale-Shrink: ", at), uint32_t(number("X-Wale-Samples: ", at))},
                   number("X-Wale-Revision: ", at),
                   text.substr(body, size_t(number("Content-Length: ", part)))});
  }
  return out;
}

// The exposure is edited between waves of one pass, again and again, as run() asks before each wave whether to stop.
// The pictures that follow must be those that are made without a pause, of as many samples.
TEST_F(ServePicture, IsOfWholePassesWhenHowItIsShownIsEdited) {
  const auto expected = pictures(scene_, 65536);
  EditorOptions options;
  options.width = options.height = kSize;
  EditorSession session(EditedScene(file_, {fmt::format("integrator.pool={}", kSmallest)}), options);
  const HttpReply stream = session.handle({EditorRequest::Kind::stream});
  std::map<int, double> exposures{{1, scene_.film.exposure}};  // of revisions
  size_t asked = 0, whole = 0, again = 0;
  Stage last;
  session.run(std::span(&device(), 1), kLoaders, [&] {
    ++asked;
    if (asked % 4 == 1) {
      const int revision = int(exposures.size()) + 1;
      const double exposure = revision % 2;
      EditorRequest edit{EditorRequest::Kind::edit};
      edit.set = {fmt::format("film.exposure={}", exposure)};
      EXPECT_EQ(session.handle(edit).body, fmt::format("{{\"revision\": {}}}\n", revision));
      exposures[revision] = exposure;
    }
    if (asked % 4 != 0) return false;
    for (const Published& picture : published(stream)) {
      const auto& [stage, revision, jpeg] = picture;
      const auto image = expected.find(stage);
      if (image == expected.end()) return true;
      whole += stage.first == 1;
      again += stage == last;
      last = stage;
      const double exposure = exposures.at(revision);
      EXPECT_TRUE(jpeg == display_jpeg(image->second, exposure, scene_.film.view, EditorSession::kJpegQuality))
          << "shrunk by " << stage.first << ", samples " << stage.second << ", revision " << revision;
    }
    return last.second >= kSamples;
  });
  EXPECT_EQ(last.second, kSamples);
  EXPECT_GT(whole, kSamples);
  EXPECT_GT(again, kSamples);
  std::printf("%zu pictures, %zu of them again\n", whole, again);
}

}  // namespace
}  // namespace wale::test
