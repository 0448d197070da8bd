// Meshes of props and lights under edits: read again where their file, or what is named, has changed, and only then.
#include <gtest/gtest.h>

#include <map>

#include "geom/base_mesh_generators.h"
#include "host/scene_overrides.h"
#include "host/world.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

class KeptMeshesOfAScene : public testing::Test {
 protected:
  void SetUp() override {
    for (int n = 0; n < 3; ++n)
      for (const char* name : {"prop", "lamp"}) write(fmt::format("{}_{}.obj", name, n), 0.001 * n);
    write("still.obj", 0);
    file_ = folder_.write("scene.json", R"({"wale": 1, "camera": {"position": [0, 0, 1]},
      "objects": [{"type": "mesh", "mesh": "still.obj"}, {"type": "mesh", "mesh": {"frames": "prop_#.obj"}},
                  {"type": "sphere", "radius": 0.1}],
      "lights": [{"type": "mesh", "mesh": {"frames": "lamp_#.obj", "missing": "hold"}}]})");
    age(folder_.path());
    edited({});
  }
  void write(const std::string& name, double z) {
    BaseMesh mesh = make_swatch(0.01, 0.01, 2, 2);
    for (dvec3& p : mesh.position) p.z = z;
    write_obj(mesh, folder_ / name);
    ++written_;
    age(folder_ / name);
    age(folder_.path());
  }
  // Each a second after the one before, and long ago.
  void age(const std::filesystem::path& file) {
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(written_ - 1000));
  }
  /// Files that another version reads.
  std::string edited(const std::vector<std::string>& set) {
    read_.clear();
    World next = build_world(read_scene(file_, set), loaders_, {}, {true, true, &world_});
    world_ = std::move(next);
    std::string out;
    for (const auto& [file, times] : read_) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", times, file);
    return out;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_;
  int written_ = 0;
  std::map<std::string, int> read_;
  Loaders loaders_{[this](const auto& file) {
                     ++read_[file.filename().string()];
                     return read_mesh(file);
                   },
                   {}};
  World world_;
};

TEST_F(KeptMeshesOfAScene, AreNotReadAgainByEditsOfOtherThings) {
  const std::vector<float> triangles = world_.triangles;
  for (const char* set : {"camera.fov=30", "lights.0.intensity=3", "objects.2.radius=0.2"})
    EXPECT_EQ(edited({set}), "");
  EXPECT_EQ(world_.triangles, triangles);
  EXPECT_EQ(edited({"objects.0.transform.scale=2"}), "") << "the mesh is as it was, its place is not";
  EXPECT_NE(world_.triangles, triangles);
  EXPECT_EQ(edited({}), "");
  EXPECT_EQ(world_.triangles, triangles);
}

TEST_F(KeptMeshesOfAScene, AreReadWhereTheFrameIsAnother) {
  EXPECT_EQ(edited({"animation.frame=1"}), "1 lamp_0.obj, 1 lamp_1.obj, 1 prop_0.obj, 1 prop_1.obj");
}

TEST_F(KeptMeshesOfAScene, AreReadAgainWhereTheirFileHasChanged) {
  const std::vector<float> triangles = world_.triangles;
  write("still.obj", 0.005);
  EXPECT_EQ(edited({}), "1 still.obj");
  EXPECT_NE(world_.triangles, triangles);
  write("prop_0.obj", 0.005);
  EXPECT_TRUE(edited({}).starts_with("1 prop_0.obj"));
  write("prop_2.obj", 0.005);
  EXPECT_EQ(edited({}), "") << "not of this frame";
  folder_.write("still.obj", "no mesh");
  EXPECT_NE(user_message([&] { edited({}); }).find("still.obj"), std::string::npos);
}

// It is written over, and its time and its length are as they were: the clock of files goes in steps.
TEST_F(KeptMeshesOfAScene, AreReadAgainWhereTheirFileWasYoung) {
  const std::filesystem::path file = folder_ / "still.obj";
  write("still.obj", 0.001);
  const FileStamp first = stamp_of(file);
  const auto young = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(file, young);
  EXPECT_EQ(edited({}), "1 still.obj");
  const std::vector<float> triangles = world_.triangles;
  write("other.obj", 0.002);
  folder_.write("still.obj", file_text(folder_ / "other.obj"));
  std::filesystem::last_write_time(file, young);
  const FileStamp now = stamp_of(file);
  ASSERT_EQ(now.number, first.number) << "the same file";
  ASSERT_EQ(now.bytes, first.bytes);
  ASSERT_EQ(now.changed, young);
  EXPECT_EQ(edited({}), "1 still.obj");
  EXPECT_NE(world_.triangles, triangles);
}

TEST_F(KeptMeshesOfAScene, AreReadAgainWhereAnotherFileHasTheName) {
  const std::filesystem::path file = folder_ / "still.obj", other = folder_ / "other.obj";
  write("still.obj", 0.001);
  write("other.obj", 0.002);
  EXPECT_EQ(edited({"objects.2.radius=0.2"}).find("still.obj") != std::string::npos, true);
  ASSERT_EQ(std::filesystem::file_size(file), std::filesystem::file_size(other));
  const auto time = std::filesystem::last_write_time(file);
  std::filesystem::rename(other, file);
  std::filesystem::last_write_time(file, time);
  age(folder_.path());
  EXPECT_EQ(edited({}), "1 still.obj");
}

// A frame that was held may be there now; what is said of it is said again.
TEST_F(KeptMeshesOfAScene, AreReadAgainWhereAFrameHasComeUp) {
  EXPECT_NE(edited({"animation.frame=3", "objects=[]"}), "");
  ASSERT_EQ(world_.notes.size(), 1u);
  EXPECT_EQ(edited({"animation.frame=3", "objects=[]", "camera.fov=30"}), "");
  EXPECT_EQ(world_.notes.size(), 1u);
  write("lamp_3.obj", 0.003);
  EXPECT_NE(edited({"animation.frame=3", "objects=[]"}).find("lamp_3.obj"), std::string::npos);
  EXPECT_TRUE(world_.notes.empty());
}

}  // namespace
}  // namespace wale
