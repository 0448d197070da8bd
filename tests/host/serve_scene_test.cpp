// A scene under edits: what is taken, taken back, saved and refused.
#include <gtest/gtest.h>

#include <cmath>

#include "host/serve/camera_move.h"
#include "host/serve/control_values.h"
#include "host/serve/controls.h"
#include "host/serve/edited_scene.h"
#include "host/serve/light_sides.h"
#include "host/world.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

const std::string kScene = R"({"wale": 1, "units": "mm",
 "camera": {"position": [0, 0, 90], "look_at": [0, 0, 0]},
 "materials": {"yarn": {"type": "ply", "color": "#804020", "roughness": 20}},
 "fabrics": [{"name": "cloth", "mesh": {"generator": "swatch", "width": 20, "height": 20},
   "pattern": {"builtin": "rib_1x1"}, "uv_metres": true, "material": "yarn"}],
 "objects": [{"type": "ground", "up": [0, 0, 1], "height": -4}],
 "lights": [{"type": "quad", "position": [0, 50, 80], "width": 20, "height": 20, "radiance": 9}]})";

struct ServeScene : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path file = folder.write("scene.json", kScene);
  EditedScene scene{file, {}};
  EditorSettings settings;

  Control control(const std::string& id) {
    for (Control& c : controls_of(scene, settings))
      if (c.id == id) return c;
    ADD_FAILURE() << "no control " << id;
    return {};
  }
};

TEST_F(ServeScene, EditsAreOverridesThatTheSchemaChecks) {
  scene.edit({"materials.yarn.color=#102030", "film.exposure=1"}, "");
  EXPECT_EQ(scene.scene().film.exposure, 1);
  EXPECT_EQ(hex_color(*scene.scene().materials[0].yarn.color), "#102030");
  const std::vector<std::string> taken = scene.edits();
  const std::string line = user_message([&] { scene.edit({"film.exposure=99"}, ""); });
  EXPECT_EQ(line, "--set film.exposure=99: film.exposure: 99 is out of range; valid: -30 to 30");
  EXPECT_NE(user_message([&] { scene.edit({"materials.yarn.glos=1"}, ""); }).find("did you mean \"gloss\"?"),
            std::string::npos);
  EXPECT_NE(user_message([&] { scene.edit({"units=m"}, ""); }).find("not edited"), std::string::npos);
  EXPECT_EQ(scene.edits(), taken) << "a refused edit changes nothing";
  EXPECT_EQ(scene.scene().film.exposure, 1);
  scene.edit({"film.exposure=2"}, "");
  EXPECT_EQ(scene.edits(), (std::vector<std::string>{"materials.yarn.color=#102030", "film.exposure=2"}));
}

TEST_F(ServeScene, UndoRedoAndReset) {
  EXPECT_FALSE(scene.undo());
  scene.edit({"film.exposure=1"}, "a");
  scene.edit({"film.exposure=2"}, "a");
  scene.edit({"film.exposure=3"}, "b");
  EXPECT_TRUE(scene.undo());
  EXPECT_EQ(scene.scene().film.exposure, 2) << "b is a step of its own";
  EXPECT_TRUE(scene.undo());
  EXPECT_EQ(scene.scene().film.exposure, 0) << "both edits of a are one";
  EXPECT_TRUE(scene.redo());
  EXPECT_TRUE(scene.redo());
  EXPECT_FALSE(scene.redo());
  EXPECT_EQ(scene.scene().film.exposure, 3);
  EXPECT_TRUE(scene.reset());
  EXPECT_TRUE(scene.edits().empty());
  EXPECT_TRUE(scene.undo());
  EXPECT_EQ(scene.scene().film.exposure, 3);
}

TEST_F(ServeScene, NoFileOutsideOfTheFolderIsNamed) {
  TemporaryFolder other;
  const auto secret = other.write("secret.obj", "v 0 0 0\n");
  folder.write("own.obj", "v 0 0 0\n");
  std::filesystem::create_symlink(secret, folder / "link.obj");
  scene.edit({"fabrics.0.mesh=own.obj"}, "");
  for (const std::string& name :
       {secret.string(), std::string("link.obj"), "../" + other.path().filename().string() + "/secret.obj",
        std::string("/etc/passwd"), std::string("/nonexistent/x"), std::string("..")})
    for (const char* key : {"fabrics.0.mesh=", "fabrics.0.pattern=", "materials.yarn.file=",
                            "lights.0={\"type\":\"environment\",\"file\":"}) {
      const std::string set = key[0] == 'l' ? key + ("\"" + name + "\"}") : key + name;
      EXPECT_NE(user_message([&] { scene.edit({set}, ""); }).find("lies outside of the scene's folder"),
                std::string::npos)
          << set;
    }
  EXPECT_NE(
      user_message([&] { scene.edit({"fabrics.0.mesh={\"frames\": \"/etc/####.obj\"}"}, ""); }).find("lies outside"),
      std::string::npos);
}

TEST_F(ServeScene, NoFrameOutsideOfTheFolderIsNamed) {
  TemporaryFolder other;
  const auto secret = other.write("s_1.obj", "v 0 0 0\n");
  folder.write("own_1.obj", "v 0 0 0\n");
  folder.write("half_1.obj", "v 0 0 0\n");
  std::filesystem::create_symlink(secret, folder / "half_2.obj");
  std::filesystem::create_symlink(secret, folder / "link.bin");
  std::filesystem::create_directory_symlink(other.path(), folder / "away");
  scene.edit({R"(fabrics.0.mesh={"frames": "own_#.obj"})"}, "");
  for (const std::string& name :
       {(other.path() / "s_#.obj").string(), std::string("half_#.obj"), std::string("link.bin"),
        std::string("away/s_#.obj"), std::string("/etc/host#"), std::string("/nonexistent/#")}) {
    const std::string set = R"(fabrics.0.mesh={"frames": ")" + name + "\"}";
    EXPECT_NE(user_message([&] { scene.edit({set}, ""); }).find("lies outside of the scene's folder"),
              std::string::npos)
        << set;
  }
}

// A folder is looked through again when it has changed, and only then.
TEST_F(ServeScene, AFolderOfFramesIsLookedThroughWhenItChanges) {
  TemporaryFolder other;
  const auto secret = other.write("s_1.obj", "v 0 0 0\n");
  std::filesystem::create_directory(folder / "frames");
  folder.write("frames/c_1.obj", "v 0 0 0\n");
  const auto frames = folder / "frames";
  const auto long_ago = std::filesystem::last_write_time(frames) - std::chrono::hours(1);
  std::filesystem::last_write_time(frames, long_ago);
  FileFence fence(folder.path());
  fence.close();
  const auto admitted = [&] { return fence.admits_all(frames / "c_#.obj"); };
  EXPECT_TRUE(admitted());
  std::filesystem::create_symlink(secret, frames / "c_2.obj");
  EXPECT_FALSE(admitted());
  std::filesystem::last_write_time(frames, long_ago);
  EXPECT_TRUE(admitted()) << "not looked through again";
  // A link that leads inside may lead outside tomorrow, without a change of this folder.
  std::filesystem::remove(frames / "c_2.obj");
  std::filesystem::create_symlink(folder / "frames/c_1.obj", folder / "inside.obj");
  std::filesystem::create_symlink(folder / "inside.obj", frames / "c_3.obj");
  std::filesystem::last_write_time(frames, long_ago - std::chrono::hours(1));
  EXPECT_TRUE(admitted());
  std::filesystem::remove(folder / "inside.obj");
  std::filesystem::create_symlink(secret, folder / "inside.obj");
  EXPECT_FALSE(admitted());
}

TEST_F(ServeScene, SavesIntoItsFolderOnlyAndAsks) {
  scene.edit({"film.exposure=1", "fabrics.0.uv_metres=null", "fabrics.0.gauge={\"wales\": 30}"}, "");
  for (const char* name :
       {"", "a", ".json", "../a.json", "/tmp/a.json", "a/b.json", "..json", "a.exr", "a\n.json", "-a.json", "a b.json"})
    EXPECT_NE(user_message([&] { scene.save(name, true); }).find("no plain name"), std::string::npos) << name;
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_EQ(scene.save("edited.json", false), folder / "edited.json");
  const Scene saved = read_scene(folder / "edited.json");
  EXPECT_EQ(saved.film.exposure, 1);
  EXPECT_EQ(saved.fabrics, scene.scene().fabrics);
  EXPECT_EQ(saved.lights, scene.scene().lights);
  EXPECT_EQ(scene.save("scene.json", false), "") << "it exists";
  EXPECT_EQ(file_text(file), kScene);
  TemporaryFolder other;
  const auto target = other.write("target.json", "old");
  std::filesystem::create_symlink(target, folder / "link.json");
  EXPECT_EQ(scene.save("link.json", false), "");
  EXPECT_EQ(scene.save("link.json", true), folder / "link.json");
  EXPECT_EQ(file_text(target), "old") << "a link is replaced, not followed";
}

TEST_F(ServeScene, TheCommandLineRendersTheSame) {
  scene.edit({"materials.yarn.color=#102030"}, "");
  EXPECT_EQ(scene.command({}, " --error 0.05"),
            "wale render " + file.string() + " -o picture.png --set 'materials.yarn.color=#102030' --error 0.05");
}

// Each control, set to each of its ends or words, is valid and shows in the scene; its value is then what it was set
// to.
TEST_F(ServeScene, EveryControlSetsWhatItSays) {
  const std::vector<Control> controls = controls_of(scene, settings);
  ASSERT_GT(controls.size(), 15u);
  for (const Control& c : controls) {
    SCOPED_TRACE(c.id);
    std::vector<JsonNode> values;
    const auto text = [&](const std::string& t) {
      JsonNode node;
      node.kind = JsonNode::Kind::string;
      node.text = t;
      values.push_back(node);
    };
    if (c.kind == Control::Kind::number)
      for (const double v : {c.low, c.high}) {
        JsonNode node;
        node.kind = JsonNode::Kind::number;
        node.number = v;
        values.push_back(node);
      }
    if (c.kind == Control::Kind::color) text("#0a141e");
    for (const auto& [word, shown] : c.words) text(word);
    for (const JsonNode& value : values) {
      EditedScene fresh(file, {});
      EditorSettings other = settings;
      if (!c.set) {
        set_setting(other, c, value);
      } else if (const auto set = overrides_of(c, value); !set.empty()) {
        ASSERT_NO_THROW(fresh.edit(set, "")) << set.back();
        if (value.text != c.text || value.number != c.number) {
          EXPECT_NE(fresh.scene(), scene.scene()) << set.back();
        }
      }
      for (const Control& now : controls_of(fresh, other))
        if (now.id == c.id) {
          EXPECT_EQ(now.text, value.text);
          EXPECT_NEAR(now.number, value.number, 1e-4 * std::abs(c.high - c.low));
        }
    }
    JsonNode wrong;
    EXPECT_NE(user_message([&] { overrides_of(c, wrong); }), "");
    wrong.kind = JsonNode::Kind::number;
    wrong.number = c.high + 1e6;
    EXPECT_NE(user_message([&] { overrides_of(c, wrong); }), "");
    wrong.number = NAN;
    EXPECT_NE(user_message([&] { overrides_of(c, wrong); }), "");
  }
}

TEST_F(ServeScene, WhatASceneLeavesOutIsLaidOut) {
  const auto bare = folder.write("bare.json", R"({"wale": 1, "fabrics": [{"mesh": {"generator": "swatch"},
    "pattern": {"builtin": "stockinette"}, "repeats": [8, 8]}]})");
  EditedScene one(bare, {});
  const Scene plain = read_scene(bare);
  ASSERT_EQ(one.scene().materials.size(), plain.materials.size());
  EXPECT_EQ(one.scene().materials[0].yarn, plain.materials[0].yarn);
  EXPECT_EQ(one.scene().lights[0].radiance, plain.lights[0].radiance);
  EXPECT_EQ(one.command({}, ""), "wale render " + bare.string() + " -o picture.png");
  one.edit({"materials.wool.gloss=0.9"}, "");
}

TEST(ServeCamera, GoesAroundWhatItSees) {
  CameraScene camera;
  camera.position = {0, 0, 2};
  const CameraScene right = moved_camera(camera, {std::numbers::pi / 2, 0, 0, 0, 1});
  EXPECT_LT(glm::length(right.position - dvec3(2, 0, 0)), 1e-12);
  const CameraScene above = moved_camera(camera, {0, 10, 0, 0, 1});
  EXPECT_GT(above.position.y, 1.99);
  EXPECT_LT(above.position.y, 2) << "not over the pole";
  EXPECT_NEAR(glm::length(moved_camera(camera, {0.3, 0.2, 0, 0, 0.5}).position), 1, 1e-12);
  const CameraScene panned = moved_camera(camera, {0, 0, 1, 0, 1});
  EXPECT_NEAR(panned.look_at.x, 2 * 2 * std::tan(0.5 * camera.fov), 1e-12) << "one picture height";
  EXPECT_EQ(panned.position - panned.look_at, camera.position);
  camera.orthographic = true;
  EXPECT_EQ(moved_camera(camera, {0, 0, 0, 0, 2}).height, 2);
}

TEST(ServeLights, AnglesAndDirectionsAgree) {
  for (const dvec3& up : {dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(1, 2, 3)})
    for (const double around : {-170.0, -20.0, 0.0, 90.0})
      for (const double above : {-80.0, 0.0, 45.0}) {
        const LightAngles back = light_angles(light_direction({around, above}, up), up);
        EXPECT_NEAR(back.around, around, 1e-9);
        EXPECT_NEAR(back.above, above, 1e-9);
      }
  EXPECT_LT(glm::length(light_direction({0, 0}, {0, 1, 0}) - dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(light_direction({90, 0}, {0, 1, 0}) - dvec3(1, 0, 0)), 1e-12);
}

TEST_F(ServeScene, LampsChangeSides) {
  EXPECT_TRUE(light_sides(scene, scene.scene().camera, LitSide::front).empty());
  const auto back = light_sides(scene, scene.scene().camera, LitSide::back);
  ASSERT_EQ(back.size(), 2u);
  const Scene behind = scene.scene_with(back);
  EXPECT_LT(glm::length(behind.lights[0].position - dvec3(0, 0.05, -0.08)), 1e-9);
  EXPECT_TRUE(behind.objects.empty()) << "the ground is in the way";
}

}  // namespace
}  // namespace wale
