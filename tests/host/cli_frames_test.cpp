// Frames of an animation by the program itself: what is kept, what is refused, and what a stop leaves.
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "geom/base_mesh_generators.h"
#include "host/image.h"
#include "tests/geom/sequence_fixtures.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

class CliFrames : public Cli {
 protected:
  static BaseMesh waving(int frame, int n = 6) {
    BaseMesh mesh = make_swatch(0.02, 0.02, n, n);
    for (dvec3& p : mesh.position) p.z = 0.002 * std::sin(300 * p.x + frame);
    return mesh;
  }
  void write_frames(int count) {
    for (int n = 0; n < count; ++n) write_obj(waving(n), folder_ / fmt::format("c_{:02}.obj", n));
  }
  std::string moving_scene(const std::string& more = "", const std::string& animation = "{}") {
    return write_scene(R"({"frames": "c_##.obj")" + more + "}", R"({"builtin": "stockinette"})",
                       R"("gauge": {"wales": 60})", R"(, "animation": )" + animation);
  }
  std::vector<std::string> frames(const std::string& range, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"render", scene_, "-o", at("f_##.exr"), "--frames", range, "--spp", "8"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  // Pixels and what the header says of them.
  static bool same_picture(const std::filesystem::path& a, const std::filesystem::path& b) {
    const Image x = read_image(a), y = read_image(b);
    return x.pixels == y.pixels && x.attributes == y.attributes;
  }
};

TEST_F(CliFrames, AreMadeOnceAndKept) {
  write_frames(3);
  moving_scene();
  ASSERT_EQ(run_wale(frames("0..2", {"-o", at("f_##.png"), "--stats", at("s.json")})).status, 0);
  const auto rows = nlohmann::json::parse(file_text(folder_ / "s.json"))["frames"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["knitted"], 1);
  for (const int k : {1, 2}) {
    EXPECT_EQ(rows[k]["knitted"], 0);
    EXPECT_EQ(rows[k]["uploaded"], 0);
    EXPECT_EQ(rows[k]["moved"], 1);
    EXPECT_GT(rows[k]["warp_seconds"].get<double>(), 0);
    EXPECT_GT(rows[k]["refit_seconds"].get<double>(), 0);
  }
  const auto written = std::filesystem::last_write_time(folder_ / "f_01.exr");
  std::filesystem::remove(folder_ / "f_02.png");
  const Outcome again = run_wale(frames("0..2", {"-o", at("f_##.png")}));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(contains(again.err, "2 of 3 frames are finished and kept"));
  EXPECT_TRUE(contains(again.err, "check ")) << "of many frames that takes a while";
  EXPECT_EQ(std::filesystem::last_write_time(folder_ / "f_01.exr"), written);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f_02.png"));
  EXPECT_TRUE(contains(run_wale(frames("0..2")).err, "all 3 frames are finished"));
}

TEST_F(CliFrames, TakeSuffixesInCapitalsToo) {
  write_frames(1);
  moving_scene();
  ASSERT_EQ(run_wale({"render", scene_, "-o", at("f_##.EXR"), "--frames", "0", "--spp", "8"}).status, 0);
  ASSERT_EQ(run_wale(frames("0")).status, 0);
  EXPECT_EQ(read_image(folder_ / "f_00.EXR").channels, read_image(folder_ / "f_00.exr").channels);
}

// A frame is the same whichever frames were made before it.
TEST_F(CliFrames, DoNotDependOnTheirPast) {
  write_frames(3);
  moving_scene();
  ASSERT_EQ(run_wale(frames("0..2")).status, 0);
  std::filesystem::rename(folder_ / "f_02.exr", folder_ / "whole.exr");
  ASSERT_EQ(run_wale(frames("2")).status, 0);
  EXPECT_TRUE(same_picture(folder_ / "whole.exr", folder_ / "f_02.exr"));
}

TEST_F(CliFrames, OfOtherSettingsAreRefusedOrMadeAgain) {
  write_frames(2);
  moving_scene();
  ASSERT_EQ(run_wale(frames("0..1", {"-o", at("f_##.png")})).status, 0);
  const std::string text = file_text(folder_ / "f_00.exr");
  const std::string line =
      ": not this frame of this scene with these settings, and not written over; move it, choose another name, or give "
      "--redo";
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--spp", "9"},
                                                {"--set", "fabrics.0.yarn.plies=2"},
                                                {"--set", "integrator.seed=3"},
                                                {"--preset", "draft"},
                                                {"--size", "8x8"},
                                                {"--set", "camera.position=[0,0,61]"}}) {
    std::vector<std::string> words = frames("0..1");
    if (other[0] == "--spp") words.resize(words.size() - 2);
    words.insert(words.end(), other.begin(), other.end());
    EXPECT_EQ(refused(words), "wale: f_00.exr" + line) << other[1];
  }
  write_obj(waving(9), folder_ / "c_01.obj");  // the same name, another cloth
  EXPECT_EQ(refused(frames("0..1")), "wale: f_01.exr" + line);
  EXPECT_EQ(refused({"render", scene_, "-o", at("f_##.png"), "--frames", "1", "--spp", "8"}), "wale: f_01.png" + line);
  EXPECT_EQ(file_text(folder_ / "f_00.exr"), text);
  const Outcome redone = run_wale(frames("0..1", {"--redo"}));
  EXPECT_EQ(redone.status, 0) << redone.err;
  EXPECT_TRUE(contains(redone.err, "1 of 2 frames are finished and kept"));
  EXPECT_EQ(file_text(folder_ / "f_00.exr"), text);
  std::filesystem::copy(folder_ / "f_00.exr", folder_ / "g_01.exr");  // another frame under this one's name
  EXPECT_EQ(refused({"render", scene_, "-o", at("g_##.exr"), "--frames", "0..1", "--spp", "8"}),
            "wale: g_01.exr" + line);
  folder_.write("f_01.exr", "not a picture");
  EXPECT_EQ(refused(frames("0..1")), "wale: f_01.exr" + line);
}

// Killed when all of frame 2 is written but its name.
TEST_F(CliFrames, GoOnAfterAKill) {
  write_frames(4);
  moving_scene();
  ASSERT_EQ(run_wale(frames("0..3")).status, 0);
  for (int n = 0; n < 4; ++n)
    std::filesystem::rename(folder_ / fmt::format("f_{:02}.exr", n), folder_ / fmt::format("whole_{:02}.exr", n));
  const auto temporaries = [&] {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (const std::string name = entry.path().filename().string(); name[0] == '.') out.push_back(name);
    return out;
  };
  const Outcome killed = run_wale(frames("0..3"), {std::string("LD_PRELOAD=") + KILLED_WRITER, "KILL_AT=/f_02.exr",
                                                   "ASAN_OPTIONS=verify_asan_link_order=0"});
  EXPECT_EQ(killed.status, 128 + SIGKILL) << killed.err;
  for (int n = 0; n < 4; ++n) EXPECT_EQ(std::filesystem::exists(folder_ / fmt::format("f_{:02}.exr", n)), n < 2) << n;
  ASSERT_EQ(temporaries().size(), 1u);
  EXPECT_TRUE(temporaries()[0].starts_with(".f_02."));
  const Outcome rest = run_wale(frames("0..3"));
  EXPECT_EQ(rest.status, 0) << rest.err;
  EXPECT_TRUE(contains(rest.err, "2 of 4 frames are finished and kept"));
  for (int n = 0; n < 4; ++n)
    EXPECT_TRUE(same_picture(folder_ / fmt::format("f_{:02}.exr", n), folder_ / fmt::format("whole_{:02}.exr", n)))
        << n;
  EXPECT_TRUE(temporaries().empty()) << temporaries()[0];
}

TEST_F(CliFrames, AreWholeAfterAStop) {
  write_frames(2);
  moving_scene();
  TemporaryFolder printed;
  const size_t files = folder_.files();
  Process process(printed.path(),
                  {"render", scene_, "-o", at("f_##.exr"), "--frames", "0..1", "--size", "64x64", "--spp", "1000000"});
  ASSERT_TRUE(process.wait_for("frames ", 120)) << process.err();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(60), 0) << process.err();
  EXPECT_TRUE(contains(process.err(), "stopped: 0 of 2 frames are finished; the same command goes on from there"));
  EXPECT_EQ(folder_.files(), files);  // none that is half a frame
}

TEST_F(CliFrames, ThatAreWrongAreNamedBeforeAnythingIsMade) {
  write_frames(4);
  std::filesystem::remove(folder_ / "c_02.obj");
  moving_scene();
  EXPECT_EQ(refused(frames("0..3")), "wale: frame 2: c_02.obj is not there; there are 0 to 3 without 2");
  EXPECT_EQ(refused(frames("3..5")), "wale: frame 4: c_04.obj is not there; there are 0 to 3 without 2");
  moving_scene(R"(, "missing": "hold")");
  const Outcome held = run_wale(frames("2"));
  EXPECT_EQ(held.status, 0) << held.err;
  EXPECT_TRUE(contains(held.err, "c_02.obj is not there; there are 0 to 3 without 2; ")) << held.err;
  EXPECT_TRUE(contains(held.err, "c_01.obj is held"));
}

// What an open shutter sees counts: the gap behind frame 1, and behind the end.
TEST_F(CliFrames, ThatAShutterNeedsAreNamedBeforeAnythingIsMade) {
  write_frames(4);
  std::filesystem::remove(folder_ / "c_02.obj");
  moving_scene("", R"({"shutter": 0.5})");
  EXPECT_EQ(refused(frames("0..1")), "wale: frame 2: c_02.obj is not there; there are 0 to 3 without 2");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f_00.exr"));
}

// A shutter that is open for several frames sees those in the middle.
TEST_F(CliFrames, AreOtherOnesWhenAnythingThatTheShutterSawChanges) {
  write_frames(5);
  moving_scene("", R"({"shutter": 3, "shutter_steps": 3})");
  ASSERT_EQ(run_wale(frames("1")).status, 0);
  for (const int seen : {2, 3}) {
    write_obj(waving(7), folder_ / fmt::format("c_{:02}.obj", seen));
    EXPECT_TRUE(contains(refused(frames("1")), "not this frame of this scene")) << seen;
    write_obj(waving(seen), folder_ / fmt::format("c_{:02}.obj", seen));
  }
  const Outcome kept = run_wale(frames("1"));
  EXPECT_EQ(kept.status, 0) << kept.err;
  EXPECT_TRUE(contains(kept.err, "finished")) << kept.err;
}

// Files are read when their frame comes; those before it stay.
TEST_F(CliFrames, ThatAreDamagedEndTheRenderOrAreHeld) {
  write_frames(2);
  write_obj(waving(2, 8), folder_ / "c_02.obj");
  folder_.write("c_03.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
  moving_scene();
  const Outcome topology = run_wale(frames("1..2"));
  EXPECT_EQ(topology.status, 1);
  ASSERT_EQ(topology.complaints().size(), 1u) << topology.err;
  EXPECT_TRUE(
      contains(topology.complaints()[0], "c_02.obj has 81 vertices and 128 triangles, the rest frame 49 and 72"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f_01.exr"));
  const Outcome nan = run_wale(frames("3"));
  EXPECT_EQ(nan.status, 1);
  EXPECT_TRUE(contains(nan.err, "frame 3: ")) << nan.err;
  EXPECT_TRUE(contains(nan.err, "c_03.obj"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f_03.exr"));
  moving_scene(R"(, "missing": "hold")");
  std::filesystem::remove(folder_ / "f_01.exr");
  const Outcome held = run_wale(frames("1..3"));
  EXPECT_EQ(held.status, 0) << held.err;
  EXPECT_EQ(read_image(folder_ / "f_03.exr").pixels, read_image(folder_ / "f_01.exr").pixels);
}

// Props and lights that move by files of frames.
TEST_F(CliFrames, OfPropsAndLightsAreSeenHashedAndMissed) {
  const auto write_piece = [&](const char* name, int n, double x, double z) {
    BaseMesh mesh = make_swatch(0.008, 0.008, 3, 3);
    for (dvec3& p : mesh.position) p += dvec3(x, 0, z);
    write_obj(mesh, folder_ / fmt::format("{}_{}.obj", name, n));
  };
  for (int n = 0; n < 3; ++n) write_piece("prop", n, -0.01 + 0.01 * n, 0.005), write_piece("lamp", n, 0.004 * n, 0.05);
  write_scene(R"({"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4})",
              R"({"builtin": "stockinette"})", R"("gauge": {"wales": 30})",
              R"(, "objects": [{"type": "mesh", "name": "prop", "mesh": {"frames": "prop_#.obj"}}],
                  "lights": [{"type": "mesh", "name": "lamp", "mesh": {"frames": "lamp_#.obj"}, "intensity": 20}])");
  ASSERT_EQ(run_wale(frames("0..2")).status, 0);
  // Each frame is what the meshes of its number would show alone.
  for (const int n : {0, 2}) {
    const Outcome still = run_wale({"render", scene_, "-o", at("still.exr"), "--spp", "8", "--set",
                                    fmt::format("objects.prop.mesh=prop_{}.obj", n), "--set",
                                    fmt::format("lights.lamp.mesh=lamp_{}.obj", n)});
    ASSERT_EQ(still.status, 0) << still.err;
    EXPECT_EQ(read_image(folder_ / fmt::format("f_{:02}.exr", n)).pixels, read_image(folder_ / "still.exr").pixels)
        << n;
  }
  const std::string first = file_text(folder_ / "f_00.exr");
  for (const char* name : {"prop", "lamp"}) {
    write_piece(name, 1, 0.002, 0.006);
    EXPECT_TRUE(contains(refused(frames("0..2")), "wale: f_01.exr: not this frame of this scene")) << name;
    ASSERT_EQ(run_wale(frames("0..2", {"--redo"})).status, 0) << name;
    EXPECT_EQ(file_text(folder_ / "f_00.exr"), first) << "other frames are kept";
  }
  for (const char* name : {"prop", "lamp"}) {
    std::filesystem::rename(folder_ / fmt::format("{}_1.obj", name), folder_ / "away.obj");
    EXPECT_EQ(refused(frames("0..2")),
              fmt::format("wale: frame 1: {}_1.obj is not there; there are 0 to 2 without 1", name));
    std::filesystem::rename(folder_ / "away.obj", folder_ / fmt::format("{}_1.obj", name));
  }
}

// Samples that are not finite are counted by the scene on the device: those of frames and moments that have left it
// are told too.
TEST_F(CliFrames, ThatAreNotFiniteAreToldAtTheEnd) {
  std::filesystem::copy(std::filesystem::path(WALE_SOURCE_DIR) / "kernels", folder_ / "kernels",
                        std::filesystem::copy_options::recursive);
  std::string text = file_text(folder_ / "kernels/stages/accumulate.cl");
  const std::string place = "    value.w = 1.0f;\n";
  ASSERT_NE(text.find(place), std::string::npos);
  text.insert(text.find(place) + place.size(), "    if (camera.origin.z < 0.065f && x % 8 == 0) value.x = NAN;\n");
  folder_.write("kernels/stages/accumulate.cl", text);
  const auto scene = [&](const std::string& shutter) {
    write_scene(
        R"({"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4})", R"({"builtin": "stockinette"})",
        R"("gauge": {"wales": 30})",
        R"(, "animation": {)" + shutter + R"("keys": {"camera.position": [[0, [0, 0, 60]], [1, [0, 0, 70]]]}})");
  };
  const auto told = [&](const std::string& range, const std::string& count) {
    const Outcome run = run_wale(frames(range, {"--kernel-dir", at("kernels"), "--redo"}));
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_TRUE(contains(run.err, "wale: render: " + count + " samples were not finite; the pictures were written"));
    for (const float v : read_image(folder_ / "f_00.exr").pixels) ASSERT_TRUE(std::isfinite(v));
  };
  scene("");
  told("0..1", "256");  // two of 16 columns, 16 rows, 8 samples: of the first frame alone
  scene(R"("shutter": 1, "shutter_steps": 4, )");
  told("0", "128");  // the first two of four moments
}

TEST_F(CliFrames, AreSaidInOneWay) {
  write_frames(2);
  moving_scene();
  EXPECT_EQ(
      refused({"render", scene_, "-o", at("f.exr"), "--frames", "0..1"}),
      "wale: f.exr: 2 frames cannot share a name; write # for each digit of their number, for example f_####.exr");
  const std::string twice = ": would be written twice; give each output a name of its own";
  EXPECT_EQ(refused(frames("0..1", {"-o", at("f_##.exr")})), "wale: f_00.exr" + twice);
  EXPECT_EQ(refused(frames("0..12", {"-o", at("./f_#.exr")})), "wale: ./f_10.exr" + twice);
  EXPECT_EQ(refused(frames("1..11", {"-o", at("f_1#.exr")})), "wale: f_11.exr" + twice);
  EXPECT_EQ(refused({"render", scene_, "-o", at("f.exr"), "-o", at("f.exr")}), "wale: f.exr" + twice);
  EXPECT_EQ(refused({"render", scene_, "-o", at("f.exr"), "--frames", ""}),
            "wale: --frames: the value is empty; for example 0..47 (see `wale --help`)");
  EXPECT_EQ(refused({"render", scene_, "-o", at("f.exr"), "--redo"}),
            "wale: --redo: of an animation; give --frames too, for example --frames 0..47");
  EXPECT_EQ(refused({"render", scene_, "-o", at("nowhere/f_##.exr"), "--frames", "0..1"}),
            "wale: nowhere/f_00.exr: the folder nowhere does not exist; make it first");
  ASSERT_EQ(run_wale({"render", scene_, "-o", at("f.exr"), "--frames", "1", "--spp", "8"}).status, 0);
  moving_scene("", R"({"shutter": 0.5})");
  EXPECT_EQ(refused({"render", scene_, "-o", at("b.exr"), "--error", "0.1"}),
            "wale: --error: a goal would not give every moment of a blurred frame its samples; valid: --spp");
}

TEST_F(CliFrames, AreOfOneSizeWhileTheShutterIsOpen) {
  write_frames(2);
  moving_scene("", R"({"shutter": 1, "keys": {"film.size": [[0, [16, 16], "hold"], [0.5, [24, 24]]]}})");
  EXPECT_TRUE(
      contains(refused(frames("0")), "film.size is 16 x 16 at one moment of a frame and 24 x 24 at another one"));
}

TEST_F(CliFrames, BecomeAVideoWhereThereIsFfmpeg) {
  write_frames(3);
  moving_scene("", R"({"fps": 12})");
  EXPECT_EQ(
      refused(frames("0..2", {"--video", at("v.mp4")}), 1, {"PATH=/nonexistent"}),
      "wale: v.mp4: videos are made by ffmpeg, which is not installed (apt-get install ffmpeg); render the frames "
      "without --video");
  if (!std::filesystem::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "skipped: no ffmpeg";
  const size_t files = folder_.files();
  const Outcome run = run_wale(frames("0..2", {"--video", at("v.mp4"), "--size", "15x16"}));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(folder_.files(), files + 4);
  EXPECT_GT(file_text(folder_ / "v.mp4").size(), 500u);
  EXPECT_EQ(file_text(folder_ / "v.mp4").substr(4, 4), "ftyp");
  std::filesystem::remove(folder_ / "v.mp4");
  EXPECT_EQ(run_wale(frames("0..2", {"--video", at("v.mp4"), "--size", "15x16"})).status, 0);  // of frames kept
  EXPECT_TRUE(std::filesystem::exists(folder_ / "v.mp4"));
  EXPECT_EQ(refused(frames("0..2", {"--video", at("v.xyz"), "--size", "15x16"})),
            "wale: v.xyz: videos are written as .mp4, .mkv, .mov or .webm, not \".xyz\"");
}

TEST_F(CliFrames, TakeNoMoreMemoryTheMoreThereAre) {
  folder_.write("c.bin", bin_file({waving(0), waving(1), waving(2), waving(3)}));
  write_scene(R"({"frames": "c.bin", "missing": "hold"})", R"({"builtin": "stockinette"})", R"("gauge": {"wales": 30})",
              R"(, "animation": {"keys": {"camera.position": [[0, [0, 0, 60]], [199, [20, 0, 60]]],
                  "fabrics.cloth.transform.rotate": [[0, [0, 0, 0]], [199, [0, 0, 90]]]}})");
  ASSERT_EQ(run_wale({"render", scene_, "-o", at("f_###.exr"), "--frames", "0..199", "--spp", "1", "--stats",
                      at("s.json"), "--size", "8x8", "--quiet"})
                .status,
            0);
  const auto rows = nlohmann::json::parse(file_text(folder_ / "s.json"))["frames"];
  ASSERT_EQ(rows.size(), 200u);
  const auto bytes = [&](size_t from, size_t to) {
    uint64_t most = 0;
    for (size_t k = from; k < to; ++k) most = std::max(most, rows[k]["resident_bytes"].get<uint64_t>());
    return double(most);
  };
  EXPECT_LT(bytes(100, 200), bytes(20, 100) + 1e6 * tolerance::kMegabytesInHundredFrames);
}

// Every frame of shared data, at a stamp's size.
TEST_F(CliFrames, OfARealStretchAreRenderedWhole) {
  const char* data = std::getenv("WALE_REAL_DATA");
  if (!data) GTEST_SKIP() << "skipped: real data not present";
  const std::string mesh = fmt::format(R"({{"frames": "{}/cloth-anim/madypg/stock_stretchX.bin"}})", data);
  folder_.write(
      "real.json",
      R"({"wale": 1, "film": {"size": [16, 16]}, "camera": {"position": [0, 0, 0.6]}, "fabrics": [{"mesh": )" + mesh +
          R"(, "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 10}}]})");
  const Outcome run = run_wale({"render", at("real.json"), "-o", at("f_##.exr"), "--frames", "0..59", "--spp", "8",
                                "--stats", at("s.json"), "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = nlohmann::json::parse(file_text(folder_ / "s.json"))["frames"];
  ASSERT_EQ(rows.size(), 60u);
  for (size_t k = 1; k < rows.size(); ++k) EXPECT_EQ(rows[k]["moved"], 1) << k;
  EXPECT_NE(read_image(folder_ / "f_00.exr").pixels, read_image(folder_ / "f_59.exr").pixels);
}

}  // namespace
}  // namespace wale::test
