// Files of an animation that are edited while frames of it are traced: no later run takes a frame for one of a file
// that it does not show.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "host/command_frames.h"
#include "host/file_stamp.h"
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

  bool refused(const char* picture) {
    return user_message([&] {
             run_frames(args_, {read_mesh, {}});
           }).find(std::string(picture) + ": not this frame of this scene") != std::string::npos;
  }

  TemporaryFolder folder_;
  RenderArgs args_;
};

TEST_F(FramesEdited, AMeshThatChangesMeanwhileMakesItAnotherFrame) {
  render([&] { write_mesh(0.03); });
  EXPECT_TRUE(refused("f_0.exr"));
  write_mesh(0.02);
  EXPECT_TRUE(refused("f_0.exr")) << "when it changed is not known, nor what the frame shows";
}

TEST_F(FramesEdited, ASceneThatChangesMeanwhileMakesItAnotherFrame) {
  render([&] { write_scene(50); });
  EXPECT_TRUE(refused("f_0.exr"));
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

/// Three frames of a cloth, of a prop that stays and of one that has a file a frame.
class FramesEditedInARow : public FramesEdited {
 protected:
  void SetUp() override {
    FramesEdited::SetUp();
    for (int n = 0; n < 3; ++n) write_piece(fmt::format("clock_{}.obj", n), -0.006 + 0.002 * n);
    write_piece("prop.obj", 0.006);
    args_.scene = folder_.write("scene.json", R"({"wale": 1, "film": {"size": [16, 16]},
      "camera": {"position": [0, 0, 0.06], "look_at": [0, 0, 0]},
      "fabrics": [{"mesh": "cloth.obj", "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}}],
      "objects": [{"type": "mesh", "mesh": {"frames": "clock_#.obj"}}, {"type": "mesh", "mesh": "prop.obj"}],
      "lights": [{"type": "environment", "radiance": [1, 1, 1]}]})");
    args_.frames = "0..2";
  }
  void write_piece(const std::string& name, double x) {
    BaseMesh mesh = make_swatch(0.004, 0.004, 1, 1);
    for (dvec3& p : mesh.position) p += dvec3(x, 0, 0.01);
    write_obj(mesh, folder_ / name);
  }
  void move_cloth() {
    for (int n = 0; n < 3; ++n)
      write_obj(make_swatch(0.02 + 0.001 * n, 0.02, 4, 4), folder_ / fmt::format("cloth_{}.obj", n));
    args_.set = {R"(fabrics.0.mesh={"frames": "cloth_#.obj"})"};
  }
  /// Renders; each edit happens once, when the file has just been read for the first time.
  void render(std::map<std::string, std::function<void()>> edits) {
    run_frames(args_, {[&](const auto& file) {
                         BaseMesh mesh = read_mesh(file);
                         if (const auto edit = edits.extract(file.filename().string())) edit.mapped()();
                         return mesh;
                       },
                       {}});
    EXPECT_TRUE(edits.empty());
  }
  Image frame(int n) const { return read_image(folder_ / fmt::format("f_{}.exr", n)); }
  /// Frames that a later run would keep, of the files as they are now, where they are what it would make.
  std::string kept() {
    std::string out;
    std::vector<Image> were;
    for (int n = 0; n < 3; ++n) were.push_back(frame(n));
    args_.redo = true;
    for (int n = 0; n < 3; ++n) {
      const auto file = folder_ / fmt::format("f_{}.exr", n);
      const FileStamp written = stamp_of(file);
      args_.frames = std::to_string(n);
      run_frames(args_, {read_mesh, {}});
      if (stamp_of(file) != written) continue;
      std::filesystem::remove(file);
      run_frames(args_, {read_mesh, {}});
      out += (out.empty() ? "" : " ") + std::to_string(n);
      EXPECT_EQ(frame(n).pixels, were[size_t(n)].pixels) << "frame " << n << " is kept and shows something else";
    }
    return out;
  }
};

TEST_F(FramesEditedInARow, AreAllKeptWhereNothingChanges) {
  render({});
  EXPECT_EQ(kept(), "0 1 2");
}

// Those in between show the other file, and which is not known once one has changed.
TEST_F(FramesEditedInARow, AFileThatChangesAndComesBackMarksNoneFromThenOn) {
  const std::string prop = file_text(folder_ / "prop.obj");
  args_.quiet = false;
  testing::internal::CaptureStderr();
  render({{"clock_1.obj", [&] { write_piece("prop.obj", 0); }},
          {"clock_2.obj", [&] { folder_.write("prop.obj", prop); }}});
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("warning: " + (folder_ / "prop.obj").string() + ": changed while frames were rendered"),
            std::string::npos)
      << told;
  args_.quiet = true;
  EXPECT_NE(frame(1).pixels, frame(2).pixels);
  EXPECT_EQ(kept(), "0");
}

// Written over within a step of the files' clock, at the same length; that clock is ahead, so that it stays young.
TEST_F(FramesEditedInARow, AYoungFileIsComparedByItsBytes) {
  const std::string prop = file_text(folder_ / "prop.obj");
  write_piece("other.obj", 0.005);
  const std::string other = file_text(folder_ / "other.obj");
  ASSERT_EQ(prop.size(), other.size());
  const auto young = std::filesystem::file_time_type::clock::now() + std::chrono::hours(1);
  std::filesystem::last_write_time(folder_ / "prop.obj", young);
  render({{"clock_1.obj", [&] {
             folder_.write("prop.obj", other);
             std::filesystem::last_write_time(folder_ / "prop.obj", young);
           }}});
  folder_.write("prop.obj", prop);
  EXPECT_EQ(kept(), "0");
}

// A cloth at rest stays what it was knitted on.
TEST_F(FramesEditedInARow, ARestThatChangesMarksNoneFromThenOn) {
  move_cloth();
  render({{"cloth_1.obj", [&] { write_obj(make_swatch(0.03, 0.02, 4, 4), folder_ / "cloth_0.obj"); }}});
  EXPECT_EQ(kept(), "");
}

// One of a frame alone, between its hash and its reading.
TEST_F(FramesEditedInARow, AFileOfAFrameThatChangesAndComesBackMarksNoneFromThenOn) {
  move_cloth();
  const std::string clock = file_text(folder_ / "clock_1.obj");
  render({{"cloth_1.obj", [&] { write_piece("clock_1.obj", 0); }},
          {"clock_1.obj", [&] { folder_.write("clock_1.obj", clock); }}});
  EXPECT_EQ(kept(), "0");
}

// With pictures of all frames there, which are looked at first.
TEST_F(FramesEditedInARow, AreMarkedByTheFilesThatTheyWereMadeOf) {
  render({});
  write_piece("prop.obj", 0);
  args_.redo = true;
  render({{"clock_0.obj", [&] { write_piece("clock_1.obj", -0.008); }}});
  EXPECT_EQ(kept(), "0 1 2");
}

}  // namespace
}  // namespace wale
