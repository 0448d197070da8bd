// What a good scene becomes, and --set.
#include "host/scene.h"

#include <cstdlib>
#include <numbers>
#include <random>

#include "host/materials.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(WALE_SOURCE_DIR) / "scenes";
constexpr double kDegree = std::numbers::pi / 180;

const std::string kMinimal =
    "{\"wale\": 1, \"fabrics\": [{\"mesh\": {\"generator\": \"swatch\"}, \"pattern\": {\"builtin\": \"stockinette\"}, "
    "\"uv_metres\": true}]}";

Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  return read_scene(folder.write("s.json", text), overrides);
}

TEST(Scene, MinimalSceneHasSensibleDefaults) {
  const Scene scene = scene_of(kMinimal);
  EXPECT_FALSE(scene.camera_given);
  ASSERT_EQ(scene.fabrics.size(), 1u);
  const FabricScene& fabric = scene.fabrics[0];
  EXPECT_EQ(fabric.spec.name, "fabric0");
  EXPECT_EQ(fabric.spec.scale.kind, FabricScale::Kind::uv_metres);
  EXPECT_EQ(fabric.mesh.generator, "swatch");
  EXPECT_DOUBLE_EQ(fabric.mesh.width, 0.1);
  EXPECT_EQ(fabric.mesh.nu, 32);
  EXPECT_EQ(fabric.pattern.builtin, "stockinette");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_TRUE(scene.materials[0].ply);
  EXPECT_EQ(scene.materials[0].yarn.preset, "wool");
  EXPECT_FALSE(scene.materials[0].yarn.color);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].kind, LightScene::Kind::environment);
  EXPECT_EQ(scene.lights[0].radiance, (Rgb{1, 1, 1}));
}

TEST(Scene, DefaultsOfTheFormatAreThoseOfTheStructs) {
  const Scene scene = scene_of(kMinimal);
  const FilmScene film;
  EXPECT_EQ(scene.film.width, film.width);
  EXPECT_EQ(scene.film.height, film.height);
  EXPECT_EQ(scene.film.exposure, film.exposure);
  EXPECT_EQ(scene.film.view, film.view);
  EXPECT_EQ(scene.film.filter, film.filter);
  const IntegratorScene integrator;
  EXPECT_EQ(scene.integrator.spp, integrator.spp);
  EXPECT_EQ(scene.integrator.max_depth, integrator.max_depth);
  EXPECT_EQ(scene.integrator.russian_roulette_depth, integrator.russian_roulette_depth);
  EXPECT_EQ(scene.integrator.light_sampling, integrator.light_sampling);
  EXPECT_EQ(scene.integrator.local_stage, integrator.local_stage);
  EXPECT_EQ(scene.integrator.lanes, integrator.lanes);
  EXPECT_EQ(scene.integrator.pool, integrator.pool);
  const FabricSpec spec;
  EXPECT_EQ(scene.fabrics[0].spec.plies, spec.plies);
  EXPECT_EQ(scene.fabrics[0].spec.twist_pitch, spec.twist_pitch);
  EXPECT_EQ(scene.fabrics[0].spec.thickness, spec.thickness);
  EXPECT_EQ(scene.fabrics[0].spec.ply_radius, spec.ply_radius);
  EXPECT_EQ(scene.fabrics[0].spec.tolerance, spec.tolerance);
}

// What the schema lets through, the materials take.
TEST(Scene, MaterialsAtTheEndsOfTheirRanges) {
  for (const char* values : {R"("roughness": 0, "ior": 1, "optical_radius": 0, "fibre_twist": -88.9)",
                             R"("roughness": 90, "ior": 4, "optical_radius": 10000, "fibre_twist": 88.9)"}) {
    const Scene scene = scene_of(std::string(R"({"wale": 1, "materials": {"y": {"type": "ply", )") + values + "}}}");
    EXPECT_NO_THROW(ply_material(scene.materials[0].yarn)) << values;
  }
  for (const char* values : {R"("roughness": 0, "ior": 1)", R"("roughness": 1, "ior": 4)"}) {
    const Scene scene = scene_of(std::string(R"({"wale": 1, "materials": {"s": {"type": "coated", )") + values + "}}}");
    EXPECT_NO_THROW(surface_material(scene.materials[0].surface)) << values;
  }
}

TEST(Scene, MillimetresBecomeMetresAndDegreesRadians) {
  const Scene scene = scene_of(R"({"wale": 1, "units": "mm",
    "camera": {"position": [0, 0, 250], "fov": 30, "aperture": 2, "focus": 240},
    "materials": {"y": {"type": "ply", "roughness": 10, "fibre_twist": -20}},
    "fabrics": [{"mesh": {"generator": "tube", "radius": 30}, "pattern": {"builtin": "stockinette"},
      "transform": {"scale": 2, "rotate": [0, 90, 0], "translate": [1, 2, 3]}, "height_offset": -1,
      "gauge": {"wales": 40}, "yarn": {"ply_radius": 0.4}, "material": "y"}],
    "objects": [{"type": "sphere", "radius": 5}, {"type": "ground"}],
    "lights": [{"type": "environment", "rotation": 45}]})");
  EXPECT_TRUE(scene.camera_given);
  EXPECT_DOUBLE_EQ(scene.camera.position.z, 0.25);
  EXPECT_DOUBLE_EQ(scene.camera.fov, 30 * kDegree);
  EXPECT_DOUBLE_EQ(scene.camera.aperture, 0.002);
  EXPECT_DOUBLE_EQ(scene.camera.focus, 0.24);
  EXPECT_DOUBLE_EQ(*scene.materials[0].yarn.roughness, 10 * kDegree);
  EXPECT_DOUBLE_EQ(*scene.materials[0].yarn.fibre_twist, -20 * kDegree);
  const FabricScene& fabric = scene.fabrics[0];
  EXPECT_DOUBLE_EQ(fabric.mesh.radius, 0.03);
  EXPECT_DOUBLE_EQ(fabric.mesh.height, 0.12) << "defaults are metres in every file";
  EXPECT_DOUBLE_EQ(fabric.transform.scale, 2);
  EXPECT_DOUBLE_EQ(fabric.transform.rotate.y, 90 * kDegree);
  EXPECT_DOUBLE_EQ(fabric.transform.translate.z, 0.003);
  EXPECT_DOUBLE_EQ(fabric.spec.height_offset, -0.001);
  EXPECT_DOUBLE_EQ(fabric.spec.ply_radius, 0.0004);
  EXPECT_DOUBLE_EQ(fabric.spec.scale.gauge.x, 400) << "40 per 10 cm";
  EXPECT_EQ(fabric.spec.scale.gauge.y, 0);
  EXPECT_DOUBLE_EQ(scene.objects[0].radius, 0.005);
  EXPECT_DOUBLE_EQ(scene.objects[1].extent, 10);
  EXPECT_DOUBLE_EQ(scene.lights[0].rotation, 45 * kDegree);
  EXPECT_EQ(scene.materials[scene.objects[0].material].name, "(grey)");
  EXPECT_EQ(scene.objects[0].material, scene.objects[1].material) << "one default for all";
}

TEST(Scene, HexColoursAreDecoded) {
  const Scene scene = scene_of(R"({"wale": 1, "materials": {"m": {"type": "diffuse", "color": "#ff8000"}}})");
  EXPECT_DOUBLE_EQ(scene.materials[0].surface.color[0], 1);
  EXPECT_NEAR(scene.materials[0].surface.color[1], 0.2158605, 1e-6);  // IEC 61966-2-1 at 128/255
  EXPECT_EQ(scene.materials[0].surface.color[2], 0);
}

TEST(Scene, IntensityMultipliesRadiance) {
  const Scene scene = scene_of(
      R"({"wale": 1, "lights": [{"type": "sphere", "position": [0, 1, 0], "radius": 1, "radiance": [1, 2, 3],
          "intensity": 10}]})");
  EXPECT_EQ(scene.lights[0].radiance, (Rgb{10, 20, 30}));
}

TEST(Scene, ReflectAndTransmitAreTheBodyColours) {
  const Scene scene = scene_of(
      R"({"wale": 1, "materials": {"m": {"type": "ply", "reflect": [0.1, 0.2, 0.3], "transmit": [0.4, 0.5, 0.6]}}})");
  EXPECT_EQ(*scene.materials[0].yarn.back, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(*scene.materials[0].yarn.forward, (Rgb{0.4, 0.5, 0.6}));
}

TEST(Scene, FilesAreRelativeToTheScene) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  folder.write("in/a.obj", "x");
  folder.write("in/t.txt", "x");
  const auto file =
      folder.write("s.json", R"({"wale": 1, "units": "mm", "fabrics": [{"mesh": "in/a.obj", "repeats": [3, 4],
                   "pattern": {"file": "in/../in/t.txt", "period": [2, 3], "unit": 0.01, "stitches": [1, 2]}}]})");
  const FabricScene fabric = read_scene(file).fabrics[0];
  EXPECT_EQ(fabric.mesh.file, folder / "in/a.obj");
  EXPECT_EQ(fabric.pattern.file, folder / "in/t.txt");
  EXPECT_DOUBLE_EQ(fabric.pattern.hints.period.y, 0.003);
  EXPECT_DOUBLE_EQ(fabric.pattern.hints.unit, 0.01);
  EXPECT_EQ(fabric.pattern.hints.stitches, ivec2(1, 2));
  EXPECT_EQ(fabric.spec.scale.repeats, dvec2(3, 4));
}

TEST(Scene, SetReplacesAndAdds) {
  const Scene scene = scene_of(
      R"({"wale": 1, "materials": {"red": {"type": "ply", "color": [0, 0, 0]}}, "fabrics": [
          {"name": "sock", "mesh": {"generator": "tube"}, "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30},
           "material": "red"}]})",
      {"film.size=[256,128]", "fabrics.0.yarn.plies=2", "materials.red.color=[1,0,0]", "fabrics.sock.gauge.wales=50",
       "integrator.local_stage=cell+ring", "units=mm", "film.size.1=64"});
  EXPECT_EQ(scene.film.width, 256);
  EXPECT_EQ(scene.film.height, 64);
  EXPECT_EQ(scene.fabrics[0].spec.plies, 2);
  EXPECT_EQ(*scene.materials[0].yarn.color, (Rgb{1, 0, 0}));
  EXPECT_DOUBLE_EQ(scene.fabrics[0].spec.scale.gauge.x, 500);
  EXPECT_EQ(scene.integrator.local_stage, "cell+ring");
}

TEST(Scene, SetErrorsNameTheOption) {
  const auto refused = [](const std::string& option) {
    return user_message(
        [&] { scene_of(R"({"wale": 1, "objects": [{"type": "ground", "name": "floor"}]})", {option}); });
  };
  EXPECT_EQ(refused("film.sice=[1,1]"), "--set film.sice=[1,1]: film.sice: unknown key; did you mean \"size\"?");
  EXPECT_EQ(refused("flim.size=[1,1]"), "--set flim.size=[1,1]: flim: unknown key; did you mean \"film\"?");
  EXPECT_EQ(refused("objects.flor.height=1"),
            "--set objects.flor.height=1: objects: no element is named \"flor\"; did you mean \"floor\"?");
  EXPECT_EQ(refused("objects.3.height=1"), "--set objects.3.height=1: objects: there is no element 3; valid: 0 to 0");
  EXPECT_EQ(refused("wale.x=1"), "--set wale.x=1: wale is the number 1, which has no \"x\"");
  EXPECT_EQ(refused("film"), "--set film: not of the form key.path=value, for example film.size=[256,256]");
  EXPECT_EQ(refused("a..b=1"), "--set a..b=1: an empty key in the path");
  EXPECT_EQ(refused("integrator.spp=many"),
            "--set integrator.spp=many: integrator.spp: a whole number is needed here, not \"many\"");
}

TEST(Scene, MessagesAreOneLineWhateverTheTextHolds) {
  const auto one_line = [](const std::string& scene, const std::vector<std::string>& options) {
    const std::string message = user_message([&] { scene_of(scene, options); });
    EXPECT_EQ(message.find_first_of("\n\r\t"), std::string::npos) << message;
  };
  one_line(R"({"wale": 1, "a\nb": 1})", {});
  one_line(R"({"wale": 1, "units": "m\nm"})", {});
  one_line(R"({"wale": 1, "objects": [{"type": "ground", "material": "a\r\nb"}]})", {});
  one_line(R"({"wale": 1})", {"film.size=a\nb"});
  one_line(R"({"wale": 1})", {"film.size=\xFF\xFE"});
  one_line(R"({"wale": 1})", {"fi\nlm.size=1"});
  one_line("{\"wale\": 1, \"a\nb\": 1}", {});
}

// Bytes of good scenes changed at random: either a scene or one user error, never another exception or a crash.
TEST(Scene, MutatedScenesNeverEscape) {
  std::mt19937 random(7);
  const auto below = [&](size_t n) { return size_t(random() % n); };
  TemporaryFolder folder;
  const std::string pieces[] = {"{",     "}",    "[",    "]",  ",",  ":",       "\"",  "-",
                                "1e308", "null", "true", "//", "/*", "\\u0000", "\xFF"};
  int good = 0, bad = 0;
  for (const char* name : {"draped_square.json", "swatch_back.json", "demo.json"}) {
    const std::string text = file_text(kScenes / name);
    for (int i = 0; i < 700; ++i) {
      std::string changed = text;
      for (size_t n = 1 + below(3); n > 0; --n) {
        const size_t at = below(changed.size()), length = below(12);
        switch (below(3)) {
          case 0:
            changed.erase(at, length);
            break;
          case 1:
            changed.insert(at, pieces[below(std::size(pieces))]);
            break;
          default:
            changed.insert(at, text.substr(below(text.size()), length));
            break;
        }
      }
      try {
        read_scene(folder.write("s.json", changed));
        ++good;
      } catch (const Error& error) {
        ASSERT_EQ(error.fault(), Fault::user) << error.what() << "\n" << changed;
        ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        ++bad;
      }
    }
  }
  EXPECT_GT(good, 50) << "the changes are too coarse to test anything behind the parser";
  EXPECT_GT(bad, 500);
}

TEST(Scene, BundledScenesAreRead) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json") continue;
    const Scene scene = read_scene(entry.path());
    EXPECT_FALSE(scene.fabrics.empty()) << entry.path();
    EXPECT_TRUE(scene.camera_given) << entry.path();
    EXPECT_GE(scene.lights.size(), 2u) << entry.path();
    ++read;
  }
  EXPECT_GE(read, 7);
}

// The schema is an independent reader's view of the same table: it must accept the bundled scenes and refuse bad ones.
TEST(Scene, JsonSchemaAgreesWithTheReader) {
  if (std::system("python3 -c 'import jsonschema' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "python3 with the module jsonschema is not installed";
  TemporaryFolder folder;
  const auto schema = folder.write("schema.json", scene_schema());
  const std::string command = fmt::format("python3 {}/tests/host/check_schema.py {} {} > {} 2>&1", WALE_SOURCE_DIR,
                                          schema.string(), kScenes.string(), (folder / "log").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << file_text(folder / "log");
}

}  // namespace
}  // namespace wale
