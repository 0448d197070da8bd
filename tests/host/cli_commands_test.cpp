// What the commands write when all is well.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "cli_fixture.h"
#include "host/accuracy.h"
#include "host/image.h"
#include "host/price_class.h"

namespace wale::test {
namespace {

using Json = nlohmann::json;

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + part.size())) ++n;
  return n;
}

class CliCommands : public Cli {
 protected:
  std::string good(const std::vector<std::string>& args, const std::vector<std::string>& environment = {}) {
    const Outcome run = run_wale(args, environment, 300);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.complaints().empty()) << run.err;
    return run.out;
  }
  Json built() { return Json::parse(good({"build", scene_, "--json", "-"}, {kNoDevice}))["fabrics"][0]; }
};

TEST_F(CliCommands, BuildReportsTheFabric) {
  const Json fabric = built();
  EXPECT_EQ(fabric["name"], "cloth");
  EXPECT_EQ(fabric["mesh"]["vertices"], 25);
  EXPECT_EQ(fabric["mesh"]["triangles"], 32);
  EXPECT_NEAR(fabric["mesh"]["stretch_median"][0].get<double>(), 1, 1e-9);
  EXPECT_NEAR(fabric["stitch_m"][0].get<double>(), 0.1 / 30, 1e-12);  // 30 wales in 10 cm
  const auto runs = fabric["runs"].get<size_t>(), segments = fabric["segments"].get<size_t>();
  EXPECT_EQ(fabric["plies"], 3 * runs);
  EXPECT_EQ(fabric["vertices"], segments + 3 * runs);  // open runs: one more vertex than segments
  EXPECT_GT(segments, 1000u);
}

TEST_F(CliCommands, BuildWritesItsReportToAFile) {
  good({"build", scene_, "--json", at("report.json")}, {kNoDevice});
  EXPECT_EQ(Json::parse(file_text(folder_ / "report.json"))["fabrics"][0]["name"], "cloth");
}

TEST_F(CliCommands, PlanListsWhatIsLeftOut) {
  const Json plan = Json::parse(good({"plan", scene_, "--json", "-"}));
  std::map<std::string, Json> features;
  for (const auto& f : plan["features"]) features[f["feature"]] = f;
  EXPECT_EQ(features["plies"]["used"], true);
  EXPECT_EQ(features["plies"]["because"], "fabrics: cloth");
  EXPECT_EQ(features["environment"]["used"], true);  // the light of a scene without lights
  EXPECT_EQ(features["triangles"]["used"], false);
  EXPECT_EQ(features["triangles"]["because"], "no mesh, ground or quad light");
  EXPECT_EQ(features["spheres"]["used"], false);
  const auto options = plan["options"].get<std::string>();
  EXPECT_TRUE(contains(options, "-DW_HAS_PLIES"));
  EXPECT_FALSE(contains(options, "W_HAS_TRIANGLES"));
  EXPECT_FALSE(contains(options, "W_HAS_SPHERES"));
  EXPECT_GT(plan["buffers"]["ply vertices"].get<size_t>(), 16u * 1000u);

  const std::string text = good({"plan", scene_});
  EXPECT_LT(text.find("simulated\n  plies "), text.find("left out\n  triangles "));
}

TEST_F(CliCommands, PlanSaysWhatIsBuiltLaunchedAndDropped) {
  const std::vector<std::string> lamps = {
      "--set", R"(lights=[{"type":"quad","name":"off","position":[0,0,1],"radiance":0}])"};
  const auto plan_with = [&](std::vector<std::string> more) {
    std::vector<std::string> args = {"plan", scene_, "--json", "-"};
    args.insert(args.end(), more.begin(), more.end());
    return Json::parse(good(args));
  };
  const Json plan = plan_with(lamps);
  std::map<std::string, Json> programs;
  for (const auto& p : plan["programs"]) programs[p["file"]] = p;
  EXPECT_EQ(programs["stages/shade_ply.cl"]["launched"], true);
  EXPECT_EQ(programs["stages/shade_fibre.cl"]["used"], false);
  // The lamp's structure is compiled, its darkness is data.
  EXPECT_EQ(programs["stages/connect.cl"]["used"], true);
  EXPECT_EQ(programs["stages/connect.cl"]["launched"], false);
  ASSERT_GE(plan["dropped"].size(), 2u);
  EXPECT_EQ(plan["dropped"][0]["what"], "light \"off\" (quad)");
  EXPECT_EQ(plan["dropped"][0]["because"], "it is black: it is never sampled");
  size_t sum = 0;
  for (const auto& [name, bytes] : plan["buffers"].items()) sum += bytes.get<size_t>();
  EXPECT_EQ(plan["bytes"], sum);
  EXPECT_GT(plan["buffers"]["path state"].get<size_t>(), 1u << 20);

  const Json all = plan_with({"--features", "all"});
  std::map<std::string, Json> features;
  for (const auto& f : all["features"]) features[f["feature"]] = f;
  EXPECT_EQ(features["spheres"]["used"], false);
  EXPECT_EQ(features["spheres"]["built"], true);
  EXPECT_EQ(features["Lambert ply lobes"]["built"], false) << "a choice, not a structure";
  EXPECT_TRUE(contains(all["options"].get<std::string>(), "-DW_HAS_SPHERES"));
}

TEST_F(CliCommands, PlanGivesEveryAccuracyOptionWithItsPrice) {
  const Json plan = Json::parse(good({"plan", scene_, "--json", "-", "--set", "integrator.max_depth=4"}));
  ASSERT_EQ(plan["accuracy"].size(), accuracy_options().size());
  for (size_t i = 0; i < plan["accuracy"].size(); ++i) {
    const Json& row = plan["accuracy"][i];
    const AccuracyOption& option = accuracy_options()[i];
    EXPECT_EQ(row["option"], option.name);
    EXPECT_EQ(row["levels"].size(), option.levels.size());
    if (option.name == "depth") {
      EXPECT_EQ(row["level"], "4");
    }
  }
}

// The figures that `wale plan` quotes are those of the committed measurement.
TEST_F(CliCommands, PricesAreThoseThatWereMeasured) {
  const std::string table = file_text(std::filesystem::path(WALE_SOURCE_DIR) / "bench/results/prices.md");
  size_t quoted = 0;
  for (const AccuracyOption& option : accuracy_options())
    for (const AccuracyLevel& level : option.levels) {
      const PriceClass price = price_class(option.name, level.name);
      const size_t row = table.find(fmt::format("| {} | {} | ", option.name, level.name));
      if (price.times == 0) {
        EXPECT_EQ(price.name, "not measured");
        continue;
      }
      ++quoted;
      ASSERT_NE(row, std::string::npos) << option.name << " " << level.name;
      const std::string line = table.substr(row, table.find('\n', row) - row);
      EXPECT_TRUE(contains(line, fmt::format(" | {:.2f} | ", price.times))) << line;
      EXPECT_EQ(price.name, price.times < 1.1 ? "cheap" : price.times < 2 ? "moderate" : "dear");
      EXPECT_EQ(price.source, "bench/results/prices.md");
    }
  EXPECT_GT(quoted, 20u);
}

TEST_F(CliCommands, DevicesListsTheFirst) {
  const std::string text = good({"devices"});
  EXPECT_TRUE(text.starts_with("0: "));
  EXPECT_TRUE(contains(text, " compute units, "));
}

TEST_F(CliCommands, SchemaIsJsonSchema) {
  const Json schema = Json::parse(good({"schema"}, {kNoDevice}));
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_TRUE(schema["properties"].contains("fabrics"));
}

TEST_F(CliCommands, ExportWritesTheSameCurvesInFourFormats) {
  const Json fabric = built();
  const size_t plies = fabric["plies"], vertices = fabric["vertices"], segments = fabric["segments"];
  std::map<std::string, std::string> text;
  for (const char* suffix : {".obj", ".pbrt", ".txt", ".usda"}) {
    good({"export", scene_, "-o", at(std::string("plies") + suffix)});
    text[suffix] = file_text(folder_ / (std::string("plies") + suffix));
    EXPECT_EQ(count(text[suffix], "nan") + count(text[suffix], "inf"), 0u) << suffix;
  }
  EXPECT_EQ(count(text[".obj"], "\nv "), vertices);
  EXPECT_EQ(count(text[".obj"], "\nl "), plies);

  EXPECT_EQ(count(text[".pbrt"], "Shape \"curve\""), plies);
  EXPECT_EQ(count(text[".pbrt"], "\n"), 1 + 2 * plies + 3 * segments + plies);  // 3 n + 1 points in a curve

  size_t points = 0, curves = 1;
  std::istringstream lines(text[".txt"]);
  for (std::string line; std::getline(lines, line);) {
    double x, y, z, r;
    if (line.empty()) {
      ++curves;
    } else {
      ASSERT_EQ(std::sscanf(line.c_str(), "%lf %lf %lf %lf", &x, &y, &z, &r), 4) << line;
      EXPECT_NEAR(r, fabric["ply_radius_m"].get<double>(), 1e-9);
      ASSERT_LT(std::max(std::abs(x), std::abs(y)), 0.0125);  // half the swatch and half a stitch
      ++points;
    }
  }
  EXPECT_EQ(curves, plies);
  EXPECT_EQ(points, vertices);

  EXPECT_TRUE(text[".usda"].starts_with("#usda 1.0\n"));
  EXPECT_TRUE(contains(text[".usda"], "def BasisCurves \"plies\""));
  const std::string declaration = "int[] curveVertexCounts = ";
  const size_t from = text[".usda"].find(declaration);
  ASSERT_NE(from, std::string::npos);
  const size_t list = from + declaration.size();
  const auto counts =
      Json::parse(text[".usda"].substr(list, text[".usda"].find('\n', list) - list)).get<std::vector<size_t>>();
  EXPECT_EQ(counts.size(), plies);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), size_t(0)), vertices);
}

TEST_F(CliCommands, StatisticsOfARender) {
  good({"render", scene_, "-o", at("a.exr"), "--spp", "16", "--stats", at("s.json")});
  const Json s = Json::parse(file_text(folder_ / "s.json"));
  EXPECT_EQ(s["scene"], scene_);
  for (const char* key : {"name", "driver", "platform"}) EXPECT_FALSE(s["device"][key].get<std::string>().empty());
  const auto features = s["features"].get<std::vector<std::string>>();
  EXPECT_NE(std::find(features.begin(), features.end(), "plies"), features.end());
  EXPECT_EQ(std::find(features.begin(), features.end(), "triangles"), features.end());
  ASSERT_FALSE(s["programs"].empty());
  for (const auto& program : s["programs"]) EXPECT_GE(program["build_seconds"].get<double>(), 0);
  EXPECT_EQ(s["geometry"]["ply segments"]["count"], built()["segments"]);
  EXPECT_GT(s["geometry"]["ply segments"]["bytes"].get<size_t>(), 0u);
  for (const char* stage : {"knit", "warp", "build tree", "intersect", "connect"})
    EXPECT_GT(s["stage_seconds"].at(stage).get<double>(), 0) << stage;
  std::map<std::string, Json> stages;
  for (const Json& stage : s["stages"]) {
    stages[stage["stage"]] = stage;
    for (const char* key : {"seconds", "launches", "items", "ns_per_item", "bytes_per_item", "floor_ns"})
      EXPECT_GT(stage[key].get<double>(), 0) << key << " of " << stage;
  }
  size_t nearest = stages["intersect"]["items"];
  if (stages.contains("intersect_packets")) nearest += stages["intersect_packets"]["items"].get<size_t>();
  EXPECT_EQ(nearest, s["rays"]["primary"]["count"].get<size_t>() + s["rays"]["bounce"]["count"].get<size_t>());
  EXPECT_EQ(stages["connect"]["items"], s["rays"]["shadow"]["count"]);
  EXPECT_EQ(nearest, stages["shade_ply"]["items"].get<size_t>() + stages["miss"]["items"].get<size_t>());
  EXPECT_FALSE(stages.contains("shade_surface"));
  EXPECT_GT(s["ns_per_path_vertex"], stages["intersect"]["ns_per_item"]);
  EXPECT_EQ(s["samples"], 16 * 16 * 16);
  EXPECT_EQ(s["image"], (Json{{"width", 16}, {"height", 16}, {"samples_per_pixel", 16.0}}));
  EXPECT_EQ(s["rays"]["primary"]["count"], 16 * 16 * 16);
  size_t all = 0;
  for (const char* kind : {"primary", "shadow", "bounce"}) {
    EXPECT_GT(s["rays"][kind]["count"].get<size_t>(), 0u) << kind;
    EXPECT_GT(s["rays"][kind]["mrays_per_second"].get<double>(), 0) << kind;
    all += s["rays"][kind]["count"].get<size_t>();
  }
  EXPECT_EQ(s["rays"]["all"]["count"], all);
  for (const char* event : {"nan", "stack full", "energy above 1"}) EXPECT_EQ(s["rare_events"].at(event), 0) << event;
  EXPECT_GT(s["total_seconds"].get<double>(), 0);
  EXPECT_GT(s["peak_memory_bytes"].get<size_t>(), size_t(1) << 20);
}

}  // namespace
}  // namespace wale::test
