// `wale fit` and `wale measure`: what they write, what they refuse, going on after a stop.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace wale::test {
namespace {

class CliFit : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    scene_ = write_scene(R"({"generator": "swatch", "width": 60, "height": 60, "nu": 4, "nv": 4})",
                         R"({"builtin": "stockinette"})", R"("gauge": {"wales": 40}, "material": "yarn")",
                         R"(, "materials": {"yarn": {"type": "ply", "preset": "wool", "color": [0.5, 0.5, 0.5]}},
 "lights": [{"name": "front", "type": "sphere", "position": [0, 40, 60], "radius": 8, "radiance": 60},
            {"name": "back lamp", "type": "sphere", "position": [0, 30, -60], "radius": 8, "radiance": 60}])");
  }

  // Photographs of another material, 32 x 32.
  void photograph() {
    for (const auto& [side, other] : {std::pair{"front", "1"}, std::pair{"back", "0"}}) {
      const Outcome run =
          run_wale({"render", scene_, "-o", at(std::string(side) + ".exr"), "--spp", "64", "--size", "32x32", "--quiet",
                    "--set", std::string("lights.") + other + ".radiance=0", "--set",
                    R"(materials.yarn={"type":"ply","preset":"wool","reflect":[0.7,0.4,0.2],"transmit":[0.8,0.5,0.3]})",
                    "--set", "integrator.seed=9"});
      ASSERT_EQ(run.status, 0) << run.err;
    }
  }
  std::vector<std::string> fit(const std::vector<std::string>& more) const {
    std::vector<std::string> args = {"fit",    scene_,         "--front", at("front.exr"),
                                     "--back", at("back.exr"), "-o",      at("material.json")};
    args.insert(args.end(), more.begin(), more.end());
    return args;
  }
  const std::vector<std::string> quick_ = {
      "--resolution", "1", "--parameters", "transmit,reflect", "--starts", "1", "--spp", "8", "--final-spp", "16"};
  std::vector<std::string> quick(const std::vector<std::string>& more) const {
    std::vector<std::string> args = fit(quick_);
    args.insert(args.end(), more.begin(), more.end());
    return args;
  }
};

TEST_F(CliFit, WritesAMaterialThatSceneTakes) {
  photograph();
  // What 16 samples tell is chance.
  std::vector<std::string> args = quick({"--report", at("fit.html"), "--progress", at("now.png")});
  *(std::find(args.begin(), args.end(), "--final-spp") + 1) = "384";
  const Outcome run = run_wale(args);
  ASSERT_EQ(run.status, 0) << run.err;
  const auto material = nlohmann::json::parse(file_text(folder_ / "material.json"));
  EXPECT_EQ(material["preset"], "wool");
  EXPECT_FALSE(material.contains("color"));
  const double hidden[2][3] = {{0.8, 0.5, 0.3}, {0.7, 0.4, 0.2}};
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(material["transmit"][c].get<double>(), hidden[0][c], 0.1);
    EXPECT_NEAR(material["reflect"][c].get<double>(), hidden[1][c], 0.15);
  }
  EXPECT_TRUE(contains(run.out, "transmit.r 0."));
  EXPECT_TRUE(contains(run.out, "pairs of renders"));
  const std::string page = file_text(folder_ / "fit.html");
  for (const char* part : {"<svg", "data:image/png;base64,", "transmit.b", "gradients stand in for its features"})
    EXPECT_TRUE(contains(page, part)) << part;
  EXPECT_EQ(page.find("http"), std::string::npos);  // it needs nothing else
  EXPECT_TRUE(std::filesystem::exists(folder_ / "now.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "material.json.fit"));
  // And a scene renders with it.
  const Outcome look = run_wale({"render", scene_, "-o", at("look.png"), "--spp", "1", "--quiet", "--set",
                                 R"(materials.yarn={"type":"ply","file":"material.json"})"});
  EXPECT_EQ(look.status, 0) << look.err;
}

TEST_F(CliFit, GoesOnFromWhereItWas) {
  photograph();
  const Outcome first = run_wale(quick({"--evaluations", "3", "--quiet"}));
  EXPECT_EQ(first.status, 1);
  EXPECT_TRUE(contains(first.err, "had not converged")) << first.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "material.json"));
  ASSERT_TRUE(std::filesystem::exists(folder_ / "material.json.fit"));
  const Outcome second = run_wale(quick({}));
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_TRUE(contains(second.err, "goes on after")) << second.err;
  // Another fit's journal is not gone on with; nor is a damaged one.
  EXPECT_EQ(run_wale(quick({"--evaluations", "3", "--quiet"})).status, 1);
  const Outcome other = run_wale(quick({"--set", "fabrics.0.yarn.plies=2"}));
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(contains(other.err, "--redo begins anew")) << other.err;
  const auto refusal = [&](const std::string& journal) {
    folder_.write("material.json.fit", journal);
    const Outcome run = run_wale(quick({}));
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_TRUE(contains(run.err, "--redo begins anew")) << run.err;
    return run.err;
  };
  auto journal = nlohmann::json::parse(file_text(folder_ / "material.json.fit"));
  journal["steps"][0]["places"][0] = 7;
  EXPECT_TRUE(contains(refusal(journal.dump()), "places in the box are missing"));
  journal["steps"] = 5;
  EXPECT_TRUE(contains(refusal(journal.dump()), "\"steps\" is not a list"));
  journal["wale_fit"] = 1;
  EXPECT_TRUE(contains(refusal(journal.dump()), "another version"));
  EXPECT_TRUE(contains(refusal("{}"), "no journal of a fit"));
  EXPECT_EQ(run_wale(quick({"--redo", "--quiet"})).status, 0);
}

// Descents were through; polishing was not.
TEST_F(CliFit, APolishThatIsOutOfTimeIsSaidSo) {
  photograph();
  EXPECT_EQ(run_wale(quick({"--evaluations", "12", "--quiet"})).status, 1);
  auto journal = nlohmann::json::parse(file_text(folder_ / "material.json.fit"));
  journal["finished"][0]["converged"] = true;
  folder_.write("material.json.fit", journal.dump());
  const Outcome late = run_wale(quick({"--minutes", "1e-6"}));
  EXPECT_EQ(late.status, 0) << late.err;
  EXPECT_TRUE(contains(late.err, "were over before the fit had converged")) << late.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "material.json"));
  // Time that was enough is not complained of.
  const Outcome enough = run_wale(quick({"--minutes", "60", "--redo"}));
  EXPECT_EQ(enough.status, 0) << enough.err;
  EXPECT_FALSE(contains(enough.err, "were over")) << enough.err;
}

// A search that has no time left keeps what it had, or looks once.
TEST_F(CliFit, BobyqaThatIsOutOfTimeKeepsWhatItHad) {
  photograph();
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--method", "bobyqa", "--report", at("fit.html")});
    return run_wale(quick(more));
  };
  EXPECT_EQ(run({"--evaluations", "12", "--quiet"}).status, 1);
  auto journal = nlohmann::json::parse(file_text(folder_ / "material.json.fit"));
  const auto done = journal["finished"][0];
  ASSERT_LT(done["loss"].get<double>(), 0.98 * done["first_loss"].get<double>());
  const std::string row = "<td>" + fmt::format("{:.3g}", done["first_loss"].get<double>()) + "</td><td>" +
                          fmt::format("{:.3g}", done["loss"].get<double>()) + "</td><td>12</td>";
  for (const bool between_descents : {true, false}) {
    if (!between_descents) journal["finished"].clear();
    folder_.write("material.json.fit", journal.dump());
    const Outcome late = run({"--minutes", "1e-6"});
    EXPECT_EQ(late.status, 0) << late.err;
    EXPECT_TRUE(contains(late.err, "goes on after")) << late.err;
    EXPECT_TRUE(contains(file_text(folder_ / "fit.html"), row)) << row;
  }
  const Outcome none = run({"--minutes", "1e-6"});
  EXPECT_EQ(none.status, 0) << none.err;
  EXPECT_FALSE(contains(none.err, "goes on after"));
  const std::string page = file_text(folder_ / "fit.html");
  EXPECT_TRUE(contains(page, "</td><td>1</td>")) << page.substr(page.find("loss at the end"));
  EXPECT_FALSE(contains(page, "<td>inf</td>"));
}

TEST_F(CliFit, OnePhotographIsFittedWithAWarning) {
  photograph();
  const Outcome run = run_wale({"fit", scene_, "--front", at("front.exr"), "-o", at("material.json"), "--resolution",
                                "1", "--parameters", "reflect", "--starts", "1", "--spp", "8", "--final-spp", "8"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "only the photograph lit from the front is given")) << run.err;
}

// One mean colour has no spread that ranges could come from.
TEST_F(CliFit, ColourAloneIsFittedWithoutRanges) {
  photograph();
  const Outcome run = run_wale({"fit",          scene_,
                                "--front",      at("front.exr"),
                                "-o",           at("material.json"),
                                "--resolution", "1",
                                "--parameters", "reflect",
                                "--starts",     "1",
                                "--spp",        "8",
                                "--final-spp",  "64",
                                "--loss",       "color=1",
                                "--report",     at("fit.html")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "no ranges")) << run.err;
  EXPECT_TRUE(contains(run.err, "3 parameters, at least 4")) << run.err;
  EXPECT_FALSE(contains(run.err + run.out, "not determine")) << run.err;
  EXPECT_FALSE(contains(run.out, " to ")) << run.out;
  EXPECT_TRUE(contains(file_text(folder_ / "fit.html"), "<td>not known</td>"));
  const auto material = nlohmann::json::parse(file_text(folder_ / "material.json"));
  for (const auto& v : material["reflect"]) EXPECT_TRUE(v.get<double>() > 0 && v.get<double>() < 1) << run.out;
}

TEST_F(CliFit, RefusesInOneLine) {
  photograph();
  const auto line = [&](const std::vector<std::string>& more) { return refused(fit(more)); };
  EXPECT_TRUE(contains(line({"--parameters", "glos"}), "no parameter is called 'glos'"));
  EXPECT_TRUE(contains(line({"--parameters", "roughness=50..60"}), "valid: two numbers in rising order within 2..40"));
  EXPECT_TRUE(contains(line({"--parameters", "roughness=5-60"}), "roughness=2..40"));
  EXPECT_TRUE(contains(line({"--parameters", "roughness,roughness"}), "named twice"));
  EXPECT_TRUE(contains(line({"--material", "yam"}), "\"yarn\""));
  EXPECT_TRUE(contains(line({"--crop", "0,0,16"}), "4 numbers with commas"));
  EXPECT_TRUE(contains(line({"--crop", "0,12,32,8"}), "of another shape"));
  EXPECT_TRUE(contains(refused(quick({"--loss", "colour=1"})), "\"color\""));
  EXPECT_TRUE(contains(refused(quick({"--layers", "relu1_2"})), "--weights"));
  EXPECT_TRUE(contains(refused(quick({"--weights", at("old.png")})), "old.png"));
  EXPECT_TRUE(contains(line({}), "16 are needed; valid: 0.5 and above"));
  EXPECT_TRUE(contains(line({"--report", at("front.exr")}), "is that of --front too"));
  EXPECT_TRUE(contains(line({"--report", at("material.json")}), "is that of -o too"));
  EXPECT_TRUE(contains(refused({"fit", scene_, "--back", at("back.exr"), "-o", at("m.json"), "--grey", "0,0,4,4"}),
                       "a card lets no light through"));
  EXPECT_TRUE(contains(line({"--set", "lights.1.name=lamp"}), "none is the back light"));
  EXPECT_TRUE(contains(line({"--set", "materials.yarn.heather={\"yarn\":0.1}"}), "a fit has one colour"));
  EXPECT_TRUE(
      contains(refused({"fit", scene_, "--front", at("front.exr"), "--back", at("front.exr"), "-o", at("m.json")}),
               "front.exr"));
  EXPECT_TRUE(contains(refused({"fit", scene_, "-o", at("m.json")}), "--front"));
  folder_.write("empty.json", "{\"wale\": 1}");
  EXPECT_TRUE(contains(refused({"fit", at("empty.json"), "--front", at("front.exr"), "-o", at("m.json")}),
                       "there is nothing to fit"));
}

TEST_F(CliFit, MeasuresBecomeOptions) {
  const Outcome run =
      run_wale({"measure", scene_, "--scale", "20", "--wale", "50", "--yarn", "20", "--angle", "25", "--plies", "2"},
               {kNoDevice});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "--set 'fabrics.0.gauge={\"wales\":40}'")) << run.out;
  EXPECT_TRUE(contains(run.out, "--set fabrics.0.yarn.plies=2"));
  EXPECT_TRUE(contains(run.out, "--set fabrics.0.yarn.twist_pitch=6.737")) << run.out;  // 2 pi 0.5 / tan 25
  // What it prints makes the yarn that was measured.
  const size_t at_thickness = run.out.find("yarn.thickness=");
  ASSERT_NE(at_thickness, std::string::npos);
  const std::string thickness = run.out.substr(at_thickness, run.out.find('\n', at_thickness) - at_thickness);
  const Outcome built = run_wale(
      {"build", scene_, "--quiet", "--set", "fabrics.0." + thickness, "--set", "fabrics.0.yarn.plies=2"}, {kNoDevice});
  EXPECT_TRUE(contains(built.out, "yarn radius 0.5000 mm") || contains(built.out, "yarn radius 0.4999 mm") ||
              contains(built.out, "yarn radius 0.5001 mm"))
      << built.out;
  const auto line = [&](const std::vector<std::string>& more) {
    std::vector<std::string> args = {"measure", scene_};
    args.insert(args.end(), more.begin(), more.end());
    return refused(args, 1, {kNoDevice});
  };
  EXPECT_TRUE(contains(line({}), "nothing was measured"));
  EXPECT_TRUE(contains(line({"--course", "2"}), "without --wale"));
  EXPECT_TRUE(contains(line({"--yarn", "1", "--ply", "2"}), "thicker than its yarn"));
  EXPECT_TRUE(contains(line({"--angle", "85"}), "0.5 to 80"));
  EXPECT_TRUE(contains(line({"--yarn", "-1"}), "--yarn"));
  EXPECT_TRUE(contains(line({"--yarn", "1", "--fabric", "clot"}), "\"cloth\""));
}

}  // namespace
}  // namespace wale::test
