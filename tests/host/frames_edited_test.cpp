// Files of an animation that are edited while a frame of it is traced: the frame is told from one of the new files.
#include <gtest/gtest.h>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "host/command_frames.h"
#include "host/image.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

class FramesEdited : public testing::Test {
 protected:
  void SetUp() override {
    write_mesh(0.02);
    args_.scene = write_scene(60);
    args_.outputs = {folder_ / "f_#.exr"};
    args_.frames = "0..0";
    args_.spp = 1;
    args_.quiet = true;
  }
  void write_mesh(double width) { write_obj(make_swatch(width, 0.02, 4, 4), folder_ / "cloth.obj"); }
  std::filesystem::path write_scene(double distance) {
    return folder_.write("scene.json", fmt::format(R"({{"wale": 1, "film": {{"size": [8, 8]}},
      "camera": {{"position": [0, 0, {}], "look_at": [0, 0, 0]}}, "fabrics": [{{"mesh": "cloth.obj",
      "pattern": {{"builtin": "stockinette"}}, "gauge": {{"wales": 30}}}}]}})",
                                                   distance / 1000));
  }
  /// Renders; `edit` happens once, when the cloth has just been loaded.
  void render(const std::function<void()>& edit) {
    bool edited = false;
    run_frames(args_, {[&](const auto& file) {
                         BaseMesh mesh = read_mesh(file);
                         if (!std::exchange(edited, true)) edit();
                         return mesh;
                       },
                       {}});
    EXPECT_TRUE(edited);
  }

  TemporaryFolder folder_;
  RenderArgs args_;
};

TEST_F(FramesEdited, AMeshThatChangesMeanwhileMakesItAnotherFrame) {
  render([&] { write_mesh(0.03); });
  EXPECT_NE(user_message([&] {
              run_frames(args_, {read_mesh, {}});
            }).find("not this frame of this scene"),
            std::string::npos);
  write_mesh(0.02);
  EXPECT_EQ(run_frames(args_, {read_mesh, {}}), 0) << "it is the frame of the mesh that it shows";
}

TEST_F(FramesEdited, ASceneThatChangesMeanwhileMakesItAnotherFrame) {
  render([&] { write_scene(50); });
  EXPECT_NE(user_message([&] {
              run_frames(args_, {read_mesh, {}});
            }).find("not this frame of this scene"),
            std::string::npos);
  const auto scene = read_image(folder_ / "f_0.exr").attributes;
  write_scene(60);
  EXPECT_EQ(run_frames(args_, {read_mesh, {}}), 0);
  args_.redo = true;
  std::filesystem::remove(folder_ / "f_0.exr");
  run_frames(args_, {read_mesh, {}});
  EXPECT_EQ(read_image(folder_ / "f_0.exr").attributes, scene) << "and so says its header";
}

TEST_F(FramesEdited, AFileThatGoesMeanwhileLosesNoFrame) {
  render([&] { std::filesystem::remove(folder_ / "cloth.obj"); });
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f_0.exr"));
}

}  // namespace
}  // namespace wale
