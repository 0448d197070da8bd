// What the program says about options that cannot be used.
#include "cli_fixture.h"
#include "host/image.h"

namespace wale::test {
namespace {

class CliOptions : public Cli {
 protected:
  std::string render_refused_with(std::vector<std::string> options, int status = 1) {
    std::vector<std::string> args = {"render", scene_, "-o", at("old.png")};
    args.insert(args.end(), options.begin(), options.end());
    return refused(args, status);
  }
};

TEST_F(CliOptions, UnknownCommandIsAnsweredWithTheNearest) {
  EXPECT_TRUE(contains(refused({"rendr", scene_}), "rendr: no such command; did you mean \"render\"?"));
}

TEST_F(CliOptions, NoCommandIsAnsweredWithTheList) {
  EXPECT_TRUE(contains(refused({}), "a command is needed; valid: \"render\", \"build\","));
}

TEST_F(CliOptions, UnknownOptionIsAnsweredWithTheNearest) {
  EXPECT_TRUE(contains(render_refused_with({"--sppp", "3"}),
                       "--sppp: no such option of `wale render`; did you mean \"--spp\"?"));
}

TEST_F(CliOptions, OneWordTooMany) {
  EXPECT_TRUE(
      contains(refused({"render", scene_, "other.json", "-o", at("old.png")}), "other.json: one word too many"));
}

TEST_F(CliOptions, OptionsMayStandBeforeTheScene) {
  const Outcome run = run_wale({"build", "--set", "fabrics.0.yarn.plies=2", scene_}, {kNoDevice});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "yarn       2 plies"));
}

TEST_F(CliOptions, MissingOutput) { EXPECT_TRUE(contains(refused({"render", scene_}), "--output is required")); }

TEST_F(CliOptions, SizeThatIsNone) {
  for (const char* size : {"12", "12x", "x12", "0x12", "12x-1", "12x12x12", "99999999999x1", "wide"})
    EXPECT_TRUE(contains(render_refused_with({"--size", size}), "expected WIDTHxHEIGHT, each 1 to 65536")) << size;
}

// A script whose variable is not set.
TEST_F(CliOptions, ValuesThatAreEmpty) {
  const std::vector<std::vector<std::string>> all = {{"render", scene_, "-o", at("a.png"), "--kernel-dir"},
                                                     {"render", scene_, "-o", at("a.png"), "--size"},
                                                     {"render", scene_, "-o", at("a.png"), "--device"},
                                                     {"render", scene_, "-o", at("a.png"), "--set"},
                                                     {"render", scene_, "-o"},
                                                     {"build", scene_, "--json"},
                                                     {"plan", scene_, "--json"},
                                                     {"plan", scene_, "--kernel-dir"},
                                                     {"cost", scene_, "-o", at("cost"), "--size"},
                                                     {"cost", scene_, "-o", at("cost"), "--reference"},
                                                     {"cost", scene_, "-o", at("cost"), "--options"},
                                                     {"serve", scene_, "--size"},
                                                     {"serve", scene_, "--host"},
                                                     {"serve", scene_, "--kernel-dir"},
                                                     {"knit", at("c.chart"), "-o", at("t.json"), "--json"},
                                                     {"bench", "--json"}};
  for (std::vector<std::string> words : all) {
    const std::string option = words.back() == "-o" ? "--output" : words.back();
    words.push_back("");
    EXPECT_TRUE(contains(refused(words), option + ": the value is empty; ")) << words[0] << " " << option;
  }
}

TEST_F(CliOptions, FilmLargerThanTheDevice) {
  EXPECT_TRUE(contains(render_refused_with({"--size", "65536x65536"}), ", the scene needs 549.8 GB: film 549.8 GB, "));
}

TEST_F(CliOptions, NumbersOutOfRange) {
  EXPECT_TRUE(contains(render_refused_with({"--spp", "0"}), "--spp: Value 0 not in range 1 to 16777216"));
  EXPECT_TRUE(contains(render_refused_with({"--seconds", "-3"}), "--seconds: -3: a number above 0 is needed"));
  EXPECT_TRUE(contains(render_refused_with({"--seconds", "nan"}), "--seconds: nan: a number above 0 is needed"));
}

TEST_F(CliOptions, FeaturesThatAreNeitherNeededNorAll) {
  EXPECT_TRUE(contains(render_refused_with({"--features", "some"}), "--features: some not in {needed,all}"));
}

TEST_F(CliOptions, OutputInAMissingFolder) {
  EXPECT_EQ(refused({"render", scene_, "-o", at("none/a.png")}),
            "wale: none/a.png: the folder none does not exist; make it first");
}

TEST_F(CliOptions, OutputThatIsAFolder) {
  std::filesystem::create_directory(folder_ / "folder.png");
  EXPECT_EQ(refused({"render", scene_, "-o", at("folder.png")}),
            "wale: folder.png: this is a folder; give the name of a file in it");
}

TEST_F(CliOptions, OutputInAFolderThatCannotBeWritten) {
  EXPECT_TRUE(contains(refused({"render", scene_, "-o", "/proc/wale.png"}), "the folder /proc cannot be written"));
}

TEST_F(CliOptions, UnknownSuffixes) {
  EXPECT_TRUE(
      contains(refused({"render", scene_, "-o", at("a.jpg")}), "images are written as .exr or .png, not \".jpg\""));
  EXPECT_TRUE(contains(refused({"export", scene_, "-o", at("a.abc")}),
                       "no export format has the suffix \".abc\"; valid: .obj"));
}

TEST_F(CliOptions, StatisticsAndReportsAreCheckedBeforeTheWork) {
  // The scene would be refused too, later: the path is what is named.
  const std::string scene = mesh_scene("m.obj", "no mesh");
  const std::string line = "wale: none/s.json: the folder none does not exist; make it first";
  EXPECT_EQ(refused({"render", scene, "-o", at("old.png"), "--stats", at("none/s.json")}), line);
  EXPECT_EQ(refused({"build", scene, "--json", at("none/s.json")}), line);
  EXPECT_EQ(refused({"plan", scene, "--json", at("none/s.json")}), line);
}

TEST_F(CliOptions, UnknownKeyIsAnsweredWithTheNearest) {
  EXPECT_EQ(render_refused_with({"--set", "film.sizee=[1,1]"}),
            "wale: --set film.sizee=[1,1]: film.sizee: unknown key; did you mean \"size\"?");
}

TEST_F(CliOptions, MessageIsOneLineWhateverTheNameHolds) {
  EXPECT_TRUE(contains(refused({"render", at("two\nlines.json"), "-o", at("old.png")}), "two lines.json: cannot read"));
}

TEST_F(CliOptions, TwistThatCannotBeSpun) {
  for (const char* pitch : {"1.5", "-1.9"})
    EXPECT_TRUE(contains(render_refused_with({"--set", std::string("fabrics.0.yarn.twist_pitch=") + pitch}),
                         "out of range; valid: 0, 2 to 1000 or -1000 to -2"));
}

TEST_F(CliOptions, NoTwistIsAllowed) {
  const Outcome run = run_wale({"build", scene_, "--set", "fabrics.0.yarn.twist_pitch=0"}, {kNoDevice});
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(CliOptions, PlyRadiusIsNegativeOrDoesNotFit) {
  EXPECT_TRUE(
      contains(render_refused_with({"--set", "fabrics.0.yarn.ply_radius=-0.1"}), "-0.1 is out of range; valid: 0 to"));
  EXPECT_TRUE(contains(render_refused_with({"--set", "fabrics.0.yarn.ply_radius=50"}),
                       "ply radius 0.05 m does not fit into a yarn of radius "));
}

TEST_F(CliOptions, NoDeviceNamesThePackage) {
  for (const auto& args : {std::vector<std::string>{"render", scene_, "-o", at("old.png")}, {"devices"}})
    EXPECT_TRUE(contains(refused(args, 2, {kNoDevice}),
                         "no device found; install a CPU device with `apt-get install pocl-opencl-icd`"));
}

TEST_F(CliOptions, DeviceThatIsNotThere) {
  EXPECT_TRUE(contains(render_refused_with({"--device", "99"}), "--device 99: there is no such device; valid: 0 to "));
}

TEST_F(CliOptions, KernelFolderWithoutKernels) {
  EXPECT_TRUE(contains(render_refused_with({"--kernel-dir", folder_.path().string()}), "cannot read this kernel file"));
}

TEST_F(CliOptions, DifferenceAboveTheLimit) {
  write_image({2, 2, {"R", "G", "B"}, std::vector<float>(12, 0.5f)}, folder_ / "a.exr");
  write_image({2, 2, {"R", "G", "B"}, std::vector<float>(12, 0.75f)}, folder_ / "b.exr");
  EXPECT_EQ(refused({"compare", at("a.exr"), at("b.exr"), "--max-rmse", "0.2"}),
            "wale: compare: RMSE 0.25 is above --max-rmse 0.2");
  const Outcome run = run_wale({"compare", at("a.exr"), at("b.exr"), "--max-rmse", "0.3"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "RMSE          0.25"));
  EXPECT_TRUE(contains(refused({"compare", at("a.exr"), at("b.exr"), "--max-rmse", "nan"}), "a number of at least 0"));
}

}  // namespace
}  // namespace wale::test
