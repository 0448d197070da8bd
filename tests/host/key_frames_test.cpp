// Key frames: values between keys, and where in the scene they end.
#include "host/key_frames.h"

#include <gtest/gtest.h>

#include "host/frame_range.h"
#include "host/scene.h"
#include "host/scene_identity.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

KeyTrack track(const std::string& text, KeyWay way = KeyWay::linear) {
  return {parse_json(text, "keys.json"), "animation.keys.x", way};
}
double number(const std::string& text, double frame, KeyWay way = KeyWay::linear) {
  return track(text, way).at(frame).number;
}

TEST(KeyFrames, GoStraightFromKeyToKeyAndStayOutside) {
  const std::string keys = "[[0, 1], [10, 3], [20, 2]]";
  EXPECT_EQ(number(keys, -5), 1);
  EXPECT_EQ(number(keys, 0), 1);
  EXPECT_DOUBLE_EQ(number(keys, 2.5), 1.5);
  EXPECT_EQ(number(keys, 10), 3);
  EXPECT_DOUBLE_EQ(number(keys, 15), 2.5);
  EXPECT_EQ(number(keys, 99), 2);
}

TEST(KeyFrames, SmoothOnesStartAndEndAtRestAndNeverOvershoot) {
  const std::string keys = "[[0, 0], [10, 1], [12, 5], [30, 5.5], [40, 4]]";
  constexpr double h = 1e-6;
  const auto speed = [&](double at) {
    return (number(keys, at + h, KeyWay::smooth) - number(keys, at - h, KeyWay::smooth)) / (2 * h);
  };
  for (const double end : {0.0, 30.0, 40.0}) EXPECT_NEAR(speed(end), 0, 1e-5) << end;  // both ends and the summit
  for (const double key : {10.0, 12.0}) EXPECT_NEAR(speed(key - 2 * h), speed(key + 2 * h), 1e-4) << key;
  EXPECT_GT(speed(10), 0.05);
  double before = 0;
  for (double at = 0; at <= 30; at += 0.05) {
    const double now = number(keys, at, KeyWay::smooth);
    EXPECT_GE(now, before - 1e-12) << at;
    before = now;
  }
  EXPECT_LE(before, 5.5);
  EXPECT_NEAR(number("[[0, 0], [2, 1]]", 1, KeyWay::smooth), 0.5, 1e-12);
  EXPECT_LT(number("[[0, 0], [2, 1]]", 0.2, KeyWay::smooth), 0.04);
}

TEST(KeyFrames, EachKeySaysItsWay) {
  const std::string keys = R"([[0, 0, "hold"], [10, 1, "linear"], [20, 2]])";
  EXPECT_EQ(number(keys, 9.9), 0);
  EXPECT_DOUBLE_EQ(number(keys, 11), 1.1);
  EXPECT_EQ(track(R"([[0, "mitre"], [5, "capsule"]])").at(4).text, "mitre");
  EXPECT_TRUE(track("[[0, true], [5, false]]").at(4.9).boolean);
}

TEST(KeyFrames, ColoursAreMixedAsLight) {
  const JsonNode half = track(R"([[0, "#ff0000"], [2, "#0000ff"]])").at(1);
  ASSERT_EQ(half.items.size(), 3u);
  EXPECT_DOUBLE_EQ(half.items[0].number, 0.5);
  EXPECT_DOUBLE_EQ(half.items[2].number, 0.5);
  EXPECT_DOUBLE_EQ(track(R"([[0, "#ff0000"], [2, [0, 1, 0]]])").at(1).items[1].number, 0.5);
}

TEST(KeyFrames, WrongKeysAreRefusedWithTheirPlace) {
  const std::pair<const char*, const char*> bad[] = {
      {"3", "keys.json:1:1: animation.keys.x: a list of keys is needed: [[frame, value], ...]"},
      {"[]", "keys.json:1:1: animation.keys.x: a list of keys is needed: [[frame, value], ...]"},
      {"[[0]]",
       "keys.json:1:2: animation.keys.x: a key is [frame, value] or [frame, value, \"smooth\"], not a list of 1"},
      {"[[\"a\", 1]]",
       "keys.json:1:2: animation.keys.x: a key is [frame, value] or [frame, value, \"smooth\"], not a list of 2"},
      {"[[5, 1], [5, 2]]",
       "keys.json:1:11: animation.keys.x: frame 5 does not come after frame 5; keys go forward in time"},
      {"[[0, 1], [5, [1, 2]]]",
       "keys.json:1:14: animation.keys.x: a list of 2 at frame 5 cannot follow the number 1 at frame 0; the values of "
       "one key are alike"},
      {"[[0, 1, \"smoth\"], [5, 2]]",
       "keys.json:1:9: animation.keys.x: \"smoth\" is no way from one key to the next; did you mean \"smooth\"?"}};
  for (const auto& [text, message] : bad) EXPECT_EQ(user_message([&] { track(text); }), message) << text;
}

std::string scene_text(const std::string& animation, const std::string& mesh = R"({"generator": "swatch"})") {
  return R"({"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60]}, "animation": )" + animation +
         R"(, "fabrics": [{"name": "cloth", "mesh": )" + mesh +
         R"(, "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}}],
 "lights": [{"type": "environment", "name": "sky", "intensity": 2}]})";
}
Scene scene(const std::string& animation, const std::vector<std::string>& set = {}) {
  return parse_scene(scene_text(animation), "scene.json", set);
}
std::string refusal(const std::string& animation) {
  return user_message([&] { scene(animation); });
}

TEST(AnimatedScene, AnyValueFollowsItsKeys) {
  const std::string keys = R"({"keys": {"camera.position": [[0, [0, 0, 60]], [10, [10, 0, 60]]],
    "lights.sky.intensity": [[0, 1], [10, 3]], "fabrics.*.yarn.twist_pitch": [[0, 8], [10, 10]],
    "materials.wool.color": [[0, "#000000"], [10, "#ffffff"]], "materials.wool.type": [[0, "ply"]]}})";
  const Scene at5 = scene(keys, {"animation.frame=5"});
  EXPECT_DOUBLE_EQ(at5.camera.position.x, 0.005);
  EXPECT_DOUBLE_EQ(at5.lights[0].radiance[0], 2);
  EXPECT_DOUBLE_EQ(at5.fabrics[0].spec.twist_pitch, 9);
  EXPECT_DOUBLE_EQ((*at5.materials[0].yarn.color)[1], 0.5);
  EXPECT_TRUE(at5.animation.moves);
  EXPECT_DOUBLE_EQ(scene(keys).lights[0].radiance[0], 1);  // frame 0
  EXPECT_DOUBLE_EQ(scene(keys, {"animation.frame=2.5"}).camera.position.x, 0.0025);
}

TEST(AnimatedScene, WholeNumbersBetweenKeysAreRounded) {
  const std::string keys = R"({"keys": {"fabrics.cloth.yarn.plies": [[0, 2], [10, 4]],
    "film.size": [[0, [100, 50]], [3, [101, 60], "smooth"], [6, [201, 61]]], "integrator.lanes": [[0, 1], [10, 8, "hold"]]}})";
  const std::vector<std::string> lanes = {"integrator.lanes=0"};
  const auto at = [&](double frame) { return scene(keys, {fmt::format("animation.frame={}", frame), lanes[0]}); };
  EXPECT_EQ(at(2.4).fabrics[0].spec.plies, 2);
  EXPECT_EQ(at(2.6).fabrics[0].spec.plies, 3);
  EXPECT_EQ(at(7.6).fabrics[0].spec.plies, 4);
  EXPECT_EQ(at(2).film.width, 101);
  EXPECT_EQ(at(2).film.height, 57);
  EXPECT_EQ(at(4.5).film.width, 151);
  EXPECT_EQ(user_message([&] { scene(keys, {"animation.frame=5"}); }),
            "scene.json:2:103: integrator.lanes: the number 4.5 is not valid; valid: 0, 1, 8, 16; nothing lies between "
            "them, write the keys with \"hold\"");
  // Halves go away from zero.
  EXPECT_EQ(at(2.5).fabrics[0].spec.plies, 3);
  const std::string seed = R"({"keys": {"fabrics.cloth.mesh": [[0, {"frames": "c_#.obj"}]],
    "fabrics.cloth.mesh.first": [[0, -2], [4, -4]]}})";
  EXPECT_EQ(scene(seed, {"animation.frame=1"}).fabrics[0].mesh.sequence->first, -3);
}

// Whichever frame is looked at, also where what is between would be whole.
TEST(AnimatedScene, AKeyOfAWholeNumberHasNoFraction) {
  for (const char* frame : {"animation.frame=0", "animation.frame=5", "animation.frame=7.5", "animation.frame=99"}) {
    const std::vector<std::string> set = {frame};
    const auto line = [&](const std::string& keys) {
      return user_message([&] { scene(R"({"keys": {)" + keys + "}}", set); });
    };
    EXPECT_EQ(line(R"("fabrics.cloth.yarn.plies": [[0, 2], [5, 2.5], [10, 3.5], [20, 4]])"),
              "scene.json:1:128: fabrics.0.yarn.plies: a whole number is needed here, not the number 2.5");
    EXPECT_EQ(line(R"("film.size": [[0, [8, 8]], [5, [8, 8.5], "hold"], [10, [9, 9]]])"),
              "scene.json:1:122: film.size.1: a whole number is needed here, not the number 8.5");
    EXPECT_EQ(line(R"("integrator.lanes": [[0, 1, "hold"], [50, 8.5]])"),
              "scene.json:1:129: integrator.lanes: the number 8.5 is not valid; valid: 0, 1, 8, 16");
    EXPECT_NE(line(R"("fabrics.cloth.yarn": [[0, {"plies": 2}], [5, {"plies": 3}], [200, {"plies": 2.5}]])")
                  .find("fabrics.0.yarn.plies: a whole number is needed here, not the number 2.5"),
              std::string::npos)
        << frame;
    EXPECT_NO_THROW(scene(R"({"keys": {"camera.fov": [[0, 20], [5, 20.5], [10, 21]]}})", set));
  }
}

TEST(AnimatedScene, WhatIsSetGoesBeforeKeys) {
  const std::string keys = R"({"keys": {"lights.sky.intensity": [[0, 1], [10, 3]]}})";
  EXPECT_DOUBLE_EQ(scene(keys, {"animation.frame=10", "lights.sky.intensity=7"}).lights[0].radiance[0], 7);
}

TEST(AnimatedScene, AStillSceneDoesNotMove) {
  EXPECT_FALSE(scene("{}").animation.moves);
  EXPECT_FALSE(scene(R"({"fps": 30, "shutter": 0})").animation.moves);
}

TEST(AnimatedScene, ErrorsNameTheKeyAndItsNearestChoice) {
  const std::pair<const char*, const char*> bad[] = {
      {R"({"keys": {"camera.positoin": [[0, [0, 0, 1]]]}})",
       "camera.positoin: unknown key; did you mean \"position\"?"},
      {R"({"keys": {"lights.sum.intensity": [[0, 1]]}})",
       "animation.keys.lights.sum.intensity: lights: no element is named \"sum\"; "},
      {R"({"keys": {"lights.sky.intensity": [[0, -1]]}})", "lights.0.intensity: -1 is out of range; valid: 0 to 1e+06"},
      {R"({"keys": {"units": [[0, "mm"]]}})", "animation.keys.units: cannot change from frame to frame"},
      {R"({"keys": {"animation.frame": [[0, 1]]}})",
       "animation.keys.animation.frame: cannot change from frame to frame"},
      {R"({"keyes": {}})", "animation.keyes: unknown key; did you mean \"keys\"?"},
      {R"({"shutter": -1})", "animation.shutter: -1 is out of range; valid: 0 to 10"},
      {R"({"interpolation": "cubic"})", "animation.interpolation: \"cubic\" is not known; "},
      {R"({"keys": {"camera.fov": 3}})", "animation.keys.camera.fov: a list of keys is needed"}};
  for (const auto& [text, part] : bad) {
    const std::string line = refusal(text);
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_TRUE(line.starts_with("scene.json:1:")) << line;
  }
}

TEST(AnimatedScene, SequencesAreChecked) {
  const std::pair<const char*, const char*> bad[] = {
      {R"({"frames": "c_##.obj", "frist": 3})", "fabrics.0.mesh.frist: unknown key; did you mean \"first\"?"},
      {R"({"frames": "c_##.obj", "missing": "skip"})", "fabrics.0.mesh.missing: \"skip\" is not known; "},
      {R"({"frames": "c_##.obj", "step": 0})", "0 shows one file only"},
      {R"({"frames": "c_##.obj", "first": 0.5})", "fabrics.0.mesh.first: a whole number is needed here"},
      {R"({"file": "none.obj", "cache": "none.pc2"})", "fabrics.0.mesh.file: no file \"none.obj\""},
      {R"({"cache": "none.pc2"})", "fabrics.0.mesh.cache: no file \"none.pc2\""}};
  for (const auto& [mesh, part] : bad) {
    const std::string line = user_message([&] { parse_scene(scene_text("{}", mesh), "scene.json"); });
    EXPECT_NE(line.find(part), std::string::npos) << line;
  }
  const Scene read = parse_scene(scene_text(R"({"frame": 4.5})", R"({"frames": "c_##.obj", "first": 7, "step": -2,
    "last": 1, "rest": 2, "missing": "hold", "topology": "changing"})"),
                                 "/folder/scene.json");
  const SequenceSource& s = *read.fabrics[0].mesh.sequence;
  EXPECT_EQ(s.frames, "/folder/c_##.obj");
  EXPECT_EQ(s.first, 7);
  EXPECT_EQ(s.step, -2);
  EXPECT_EQ(s.last, 1);
  EXPECT_EQ(s.rest, 2);
  EXPECT_TRUE(s.hold && s.changing && read.fabrics[0].moves);
  EXPECT_EQ(read.fabrics[0].mesh.frame, 4.5);
}

// A finished frame stays one when keys of other frames change.
TEST(AnimatedScene, IdentityIsWhatAFrameShows) {
  TemporaryFolder folder;
  const auto identity = [&](const std::string& animation, const std::vector<std::string>& set) {
    return scene_identity(folder.write("scene.json", scene_text(animation)), set);
  };
  const std::string a = R"({"keys": {"lights.sky.intensity": [[0, 1], [10, 3]]}})",
                    b = R"({"fps": 12, "keys": {"lights.sky.intensity": [[0, 1], [10, 3], [20, 9]]}})";
  EXPECT_EQ(identity(a, {"animation.frame=5"}), identity(b, {"animation.frame=5"}));
  EXPECT_NE(identity(a, {"animation.frame=5"}), identity(a, {"animation.frame=6"}));
  EXPECT_NE(identity(a, {"animation.frame=15"}), identity(b, {"animation.frame=15"}));
  EXPECT_EQ(identity(a, {}), identity("{}", {"lights.sky.intensity=1"}));
  const std::string open = R"({"shutter": 1, "keys": {"lights.sky.intensity": [[0, 1], [10, 3]]}})";
  EXPECT_NE(identity(open, {"animation.frame=5"}), identity(a, {"animation.frame=5"}));
}

TEST(FrameRange, IsOneOrManyAndNothingElse) {
  EXPECT_EQ(frame_range("7"), (std::vector<long>{7}));
  EXPECT_EQ(frame_range("-1..2"), (std::vector<long>{-1, 0, 1, 2}));
  EXPECT_EQ(frame_range("0..7:3"), (std::vector<long>{0, 3, 6}));
  for (const char* bad : {"", "..", "a", "1..", "1..2:", "1...2", "1..2:x", "1,2", "99999999", "1..99999999"})
    EXPECT_EQ(user_message([&] { frame_range(bad); }),
              fmt::format("--frames {}: valid: 7, 0..47 or 0..47:2, of frames -1000000 to 1000000", bad));
  EXPECT_EQ(user_message([] { frame_range("5..1"); }), "--frames 5..1: 1 comes before 5; write the first frame first");
  EXPECT_EQ(user_message([] { frame_range("1..5:0"); }), "--frames 1..5:0: a step of 0; valid: 1 or more");
}

}  // namespace
}  // namespace wale
