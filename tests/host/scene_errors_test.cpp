// Every kind of bad scene has its name, its place and its advice.
#include "host/scene.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

const std::string kFabric =
    "{\"mesh\": {\"generator\": \"swatch\"}, \"pattern\": {\"builtin\": \"stockinette\"}, \"uv_metres\": true";

// The message for a scene, without the name of its folder.
std::string refused(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  const auto file = folder.write("s.json", scene);
  std::string message = user_message([&] { read_scene(file, overrides); });
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (size_t at; (at = message.find(folder.path().string() + "/")) != std::string::npos;)
    message.erase(at, folder.path().string().size() + 1);
  return message;
}

// A scene of `wale` and these keys, which start in line 2, column 1.
std::string refused_keys(const std::string& keys) { return refused("{\"wale\": 1,\n" + keys + "}"); }
std::string refused_camera(const std::string& keys) { return refused_keys("\"camera\": {" + keys + "}"); }
std::string refused_fabric(const std::string& keys) {
  return refused_keys("\"fabrics\": [\n" + kFabric + ",\n" + keys + "}]");
}
std::string refused_ply(const std::string& keys) {
  return refused_keys("\"materials\": {\"m\": {\"type\": \"ply\",\n" + keys + "}}");
}
std::string refused_light(const std::string& light) { return refused_keys("\"lights\": [" + light + "]"); }

TEST(SceneErrors, UnknownKeyIsAnsweredWithTheNearest) {
  EXPECT_EQ(refused_camera("\"position\": [0,0,1],\n  \"fovv\": 40"),
            "s.json:3:3: camera.fovv: unknown key; did you mean \"fov\"?");
}

TEST(SceneErrors, FarKeyIsAnsweredWithTheList) {
  EXPECT_EQ(refused_keys("\"film\": {\"zzzzzzz\": 1}"),
            "s.json:2:10: film.zzzzzzz: unknown key; valid: \"size\", \"exposure\", \"view\", \"filter\"");
}

TEST(SceneErrors, KeyOfTheOtherCameraIsUnknown) {
  EXPECT_TRUE(refused_camera("\"type\": \"orthographic\", \"position\": [0,0,1], \"fov\": 40")
                  .starts_with("s.json:2:57: camera.fov: unknown key; "));
}

TEST(SceneErrors, RootMustBeAnObject) {
  EXPECT_EQ(refused("[]"), "s.json:1:1: the scene: an object is needed here, not a list of 0");
}

TEST(SceneErrors, MissingVersion) { EXPECT_EQ(refused("{}"), "s.json:1:1: the scene: the key \"wale\" is missing"); }

TEST(SceneErrors, OtherVersion) {
  EXPECT_EQ(refused("{\"wale\": 2}"), "s.json:1:10: wale: the number 2 is not valid; valid: 1");
}

TEST(SceneErrors, WrongType) {
  EXPECT_EQ(refused_keys("\"film\": {\"exposure\": \"bright\"}"),
            "s.json:2:22: film.exposure: a number is needed here, not \"bright\"");
}

TEST(SceneErrors, VectorOfWrongLength) {
  EXPECT_EQ(refused_camera("\"position\": [0, 0]"),
            "s.json:2:24: camera.position: a list of 3 numbers is needed here, not a list of 2");
}

TEST(SceneErrors, FractionWhereWholeNumberIsNeeded) {
  EXPECT_EQ(refused_keys("\"integrator\": {\"spp\": 1.5}"),
            "s.json:2:23: integrator.spp: a whole number is needed here, not the number 1.5");
}

TEST(SceneErrors, WrongWord) {
  EXPECT_EQ(refused_keys("\"integrator\": {\"light_sampling\": \"miss\"}"),
            "s.json:2:34: integrator.light_sampling: \"miss\" is not known; did you mean \"mis\"?");
}

TEST(SceneErrors, WrongUnits) {
  EXPECT_EQ(refused_keys("\"units\": \"inch\""), "s.json:2:10: units: \"inch\" is not known; valid: \"m\", \"mm\"");
}

TEST(SceneErrors, StorageThatIsNone) {
  EXPECT_EQ(refused_fabric("\"storage\": \"procedual\""),
            "s.json:4:12: fabrics.0.storage: \"procedual\" is not known; did you mean \"procedural\"?");
}

TEST(SceneErrors, LatticeOfTooManyCells) {
  EXPECT_EQ(refused_fabric("\"lattice\": 65"), "s.json:4:12: fabrics.0.lattice: 65 is out of range; valid: 0 to 64");
}

TEST(SceneErrors, LatticeOfHalfACell) {
  EXPECT_EQ(refused_fabric("\"lattice\": 1.5"),
            "s.json:4:12: fabrics.0.lattice: a whole number is needed here, not the number 1.5");
}

TEST(SceneErrors, LanesThatNoKernelHas) {
  EXPECT_EQ(refused_keys("\"integrator\": {\"lanes\": 4}"),
            "s.json:2:25: integrator.lanes: the number 4 is not valid; valid: 0, 1, 8, 16");
}

TEST(SceneErrors, FilmOfNoSize) {
  EXPECT_EQ(refused_keys("\"film\": {\"size\": [0, 10]}"),
            "s.json:2:19: film.size.0: 0 is out of range; valid: 1 to 65536");
}

TEST(SceneErrors, FilmTooWide) {
  EXPECT_EQ(refused_keys("\"film\": {\"size\": [10, 65537]}"),
            "s.json:2:23: film.size.1: 65537 is out of range; valid: 1 to 65536");
}

TEST(SceneErrors, FilmOfTooManyPixels) {
  EXPECT_TRUE(
      refused_keys("\"film\": {\"size\": [65536, 65536]}").starts_with("s.json:2:18: film.size: 65536 x 65536"));
}

TEST(SceneErrors, ColourAboveOne) {
  EXPECT_EQ(refused_ply("\"color\": [0.5, 1.5, 0]"),
            "s.json:3:16: materials.m.color.1: 1.5 is out of range; valid: 0 to 1");
}

TEST(SceneErrors, ColourBelowZero) {
  EXPECT_EQ(refused_ply("\"color\": [-0.1, 0, 0]"),
            "s.json:3:11: materials.m.color.0: -0.1 is out of range; valid: 0 to 1");
}

TEST(SceneErrors, HexColourOfWrongForm) {
  EXPECT_EQ(refused_ply("\"color\": \"#12345\""),
            "s.json:3:10: materials.m.color: \"#12345\" is no colour; valid: \"#rrggbb\" (sRGB) or [r, g, b] (linear)");
}

TEST(SceneErrors, NegativeRoughness) {
  EXPECT_EQ(refused_ply("\"roughness\": -1"), "s.json:3:14: materials.m.roughness: -1 is out of range; valid: 0 to 90");
}

TEST(SceneErrors, IorBelowOne) {
  EXPECT_EQ(refused_ply("\"ior\": 0.9"), "s.json:3:8: materials.m.ior: 0.9 is out of range; valid: 1 to 4");
}

TEST(SceneErrors, ReflectWithoutTransmit) {
  EXPECT_EQ(
      refused_ply("\"reflect\": [1, 1, 1]"),
      "s.json:3:12: materials.m.reflect: \"reflect\" and \"transmit\" are given both or not at all; \"transmit\" is "
      "missing");
}

TEST(SceneErrors, ColorBesideReflectAndTransmit) {
  EXPECT_TRUE(refused_ply("\"color\": [1,1,1], \"reflect\": [1, 1, 1], \"transmit\": [1, 1, 1]")
                  .starts_with("s.json:3:10: materials.m.color: cannot be given together"));
}

TEST(SceneErrors, ColourTwice) {
  EXPECT_EQ(refused_ply("\"color\": [1,1,1], \"fibre_color\": [1,1,1]"),
            "s.json:3:19: materials.m.fibre_color: cannot be given together with \"color\"; choose one of \"color\", "
            "\"fibre_color\", \"plies\", \"stripes\"");
}

TEST(SceneErrors, GlossBesideRoughness) {
  EXPECT_TRUE(refused_ply("\"gloss\": 0.5, \"roughness\": 4")
                  .starts_with("s.json:3:15: materials.m.roughness: cannot be given together with \"gloss\""));
}

TEST(SceneErrors, TranslucencyBesideOpticalRadius) {
  EXPECT_TRUE(refused_ply("\"translucency\": 0.5, \"optical_radius\": 4")
                  .starts_with("s.json:3:22: materials.m.optical_radius: cannot be given together"));
  EXPECT_EQ(refused_ply("\"translucency\": 0.5, \"scattering\": {\"optical_radius\": 4}"),
            "s.json:3:17: materials.m.translucency: cannot be given together with \"scattering.optical_radius\"");
}

TEST(SceneErrors, FibreColourBesideReflectAndTransmit) {
  EXPECT_TRUE(refused_ply("\"fibre_color\": [1,1,1], \"reflect\": [1, 1, 1], \"transmit\": [1, 1, 1]")
                  .starts_with("s.json:3:16: materials.m.fibre_color: cannot be given together"));
}

TEST(SceneErrors, TwistThatInverts) {
  EXPECT_EQ(refused_ply("\"fibre_twist\": 89"),
            "s.json:3:16: materials.m.fibre_twist: 89 is out of range; valid: above -89, below 89");
  EXPECT_EQ(refused_ply("\"fibres\": {\"twist\": -90}"),
            "s.json:3:21: materials.m.fibres.twist: -90 is out of range; valid: above -89, below 89");
}

TEST(SceneErrors, ColoursThatVaryOverNothing) {
  EXPECT_TRUE(refused_ply("\"plies\": []")
                  .ends_with("materials.m.plies: the list is empty; give one or more, or leave the "
                             "key out"));
  EXPECT_TRUE(refused_ply("\"stripes\": []").ends_with("or leave the key out"));
}

TEST(SceneErrors, FibresOutOfRange) {
  EXPECT_EQ(refused_ply("\"fibres\": {\"count\": 0}"),
            "s.json:3:21: materials.m.fibres.count: 0 is out of range; valid: 1 to 4096");
  EXPECT_EQ(refused_ply("\"fibres\": {\"packing\": 0.8}"),
            "s.json:3:23: materials.m.fibres.packing: 0.8 is out of range; valid: above 0, up to 0.7");
  EXPECT_EQ(refused_ply("\"fibres\": {\"packing\": 0}"),
            "s.json:3:23: materials.m.fibres.packing: 0 is out of range; valid: above 0, up to 0.7");
}

TEST(SceneErrors, ScatteringOutOfRange) {
  EXPECT_EQ(refused_ply("\"scattering\": {\"variance_centre\": 0}"),
            "s.json:3:35: materials.m.scattering.variance_centre: 0 is out of range; valid: 0.0001 to 100");
  EXPECT_EQ(refused_ply("\"scattering\": {\"forward_witdh\": 1}"),
            "s.json:3:16: materials.m.scattering.forward_witdh: unknown key; did you mean \"forward_width\"?");
}

TEST(SceneErrors, StripeWithoutLength) {
  EXPECT_EQ(refused_ply("\"stripes\": [{\"color\": \"#ffffff\"}]"),
            "s.json:3:13: materials.m.stripes.0: the key \"length\" is missing");
}

TEST(SceneErrors, ColourImageOfNoFile) {
  EXPECT_TRUE(refused_fabric("\"color_image\": {\"file\": \"none.png\"}")
                  .starts_with("s.json:4:25: fabrics.0.color_image.file: no file \"none.png\""));
}

TEST(SceneErrors, MaterialOfUnknownType) {
  EXPECT_EQ(refused_keys("\"materials\": {\"m\": {\"type\": \"difuse\"}}"),
            "s.json:2:29: materials.m.type: \"difuse\" is not known; did you mean \"diffuse\"?");
}

TEST(SceneErrors, MaterialWithoutType) {
  EXPECT_EQ(refused_keys("\"materials\": {\"m\": {}}"),
            "s.json:2:20: materials.m: the key \"type\" is missing; valid: \"ply\", \"diffuse\", \"coated\"");
}

TEST(SceneErrors, NoPlies) {
  EXPECT_EQ(refused_fabric("\"yarn\": {\"plies\": 0}"),
            "s.json:4:19: fabrics.0.yarn.plies: 0 is out of range; valid: 1 to 8");
}

TEST(SceneErrors, NinePlies) {
  EXPECT_EQ(refused_fabric("\"yarn\": {\"plies\": 9}"),
            "s.json:4:19: fabrics.0.yarn.plies: 9 is out of range; valid: 1 to 8");
}

TEST(SceneErrors, TwistTooTight) {
  EXPECT_EQ(refused_fabric("\"yarn\": {\"twist_pitch\": -1.5}"),
            "s.json:4:25: fabrics.0.yarn.twist_pitch: -1.5 is out of range; valid: 0, 2 to 1000 or -1000 to -2");
}

TEST(SceneErrors, TwoScaleKeys) {
  EXPECT_EQ(refused_fabric("\"repeats\": [2, 2]"),
            "s.json:4:1: fabrics.0.repeats: cannot be given together with \"uv_metres\"; choose one of \"repeats\", "
            "\"gauge\", \"uv_metres\"");
}

TEST(SceneErrors, NoScaleKey) {
  EXPECT_EQ(refused_keys(
                "\"fabrics\": [{\"mesh\": {\"generator\": \"swatch\"}, \"pattern\": {\"builtin\": \"stockinette\"}}]"),
            "s.json:2:13: fabrics.0: one of these keys is needed: \"repeats\", \"gauge\", \"uv_metres\"");
}

TEST(SceneErrors, UvMetresFalse) {
  EXPECT_EQ(
      refused("{\"wale\": 1, \"fabrics\": [" + kFabric + "}]}", {"fabrics.0.uv_metres=false"}),
      "--set fabrics.0.uv_metres=false: fabrics.0.uv_metres: true (or leave the key out) is needed here, not false");
}

TEST(SceneErrors, RepeatsOfZero) {
  EXPECT_EQ(refused_fabric("\"repeats\": [0, 2]"),
            "s.json:4:13: fabrics.0.repeats.0: 0 is out of range; valid: 0.001 to 100000");
}

TEST(SceneErrors, GaugeOfZero) {
  EXPECT_EQ(refused_fabric("\"gauge\": {\"wales\": 0}"),
            "s.json:4:20: fabrics.0.gauge.wales: 0 is out of range; valid: 0.1 to 10000");
}

TEST(SceneErrors, UnknownMaterialName) {
  EXPECT_EQ(refused("{\"wale\": 1, \"materials\": {\"red\": {\"type\": \"ply\"}},\n\"fabrics\": [" + kFabric +
                    ", \"material\": \"rad\"}]}"),
            "s.json:2:117: fabrics.0.material: no material is named \"rad\"; did you mean \"red\"?");
}

TEST(SceneErrors, FabricOfDiffuseMaterial) {
  EXPECT_EQ(refused("{\"wale\": 1, \"materials\": {\"red\": {\"type\": \"diffuse\"}},\n\"fabrics\": [" + kFabric +
                    ", \"material\": \"red\"}]}"),
            "s.json:2:117: fabrics.0.material: \"red\" is a diffuse material; one of type \"ply\" is needed here");
}

TEST(SceneErrors, ObjectOfPlyMaterial) {
  EXPECT_EQ(
      refused_keys(
          "\"materials\": {\"y\": {\"type\": \"ply\"}}, \"objects\": [{\"type\": \"ground\",\n\"material\": \"y\"}]"),
      "s.json:3:13: objects.0.material: \"y\" is a ply material; one of type \"diffuse\" or \"coated\" is needed here");
}

TEST(SceneErrors, SphereOfNoRadius) {
  EXPECT_EQ(refused_keys("\"objects\": [{\"type\": \"sphere\", \"radius\": 0}]"),
            "s.json:2:42: objects.0.radius: 0 is out of range; valid: 1e-09 to 1e+06");
}

TEST(SceneErrors, NamesUsedTwice) {
  EXPECT_EQ(
      refused_keys("\"objects\": [{\"type\": \"ground\", \"name\": \"g\"},\n{\"type\": \"ground\", \"name\": \"g\"}]"),
      "s.json:3:28: objects.1.name: \"g\" is the name of another element too");
}

TEST(SceneErrors, CameraInsideItsTarget) {
  EXPECT_EQ(refused_camera("\"position\": [1, 2, 3], \"look_at\": [1, 2, 3]"),
            "s.json:2:24: camera.position: the same point as look_at (1, 2, 3 m)");
}

TEST(SceneErrors, UpAlongTheView) {
  EXPECT_EQ(refused_camera("\"position\": [0, 3, 0]"),
            "s.json:2:11: camera.up: parallel to the line from position to look_at; choose another direction");
}

TEST(SceneErrors, UpOfLengthZero) {
  EXPECT_EQ(refused_camera("\"position\": [0, 3, 0], \"up\": [0, 0, 0]"),
            "s.json:2:41: camera.up: a direction of length 0");
}

TEST(SceneErrors, FovOfHalfTurn) {
  EXPECT_EQ(refused_camera("\"position\": [0, 0, 1], \"fov\": 180"),
            "s.json:2:42: camera.fov: 180 is out of range; valid: 0.01 to 179");
}

TEST(SceneErrors, CoordinateBeyondFloat) {
  EXPECT_EQ(refused_camera("\"position\": [0, 0, 1e300]"),
            "s.json:2:31: camera.position.2: 1e+300 is out of range; valid: -1e+06 to 1e+06");
}

TEST(SceneErrors, QuadThatLooksAtItself) {
  EXPECT_TRUE(refused_light("{\"type\": \"quad\", \"position\": [0, 0, 0]}")
                  .starts_with("s.json:2:41: lights.0.position: the same point as look_at"));
}

TEST(SceneErrors, NegativeRadiance) {
  EXPECT_EQ(refused_light("{\"type\": \"environment\", \"radiance\": -1}"),
            "s.json:2:48: lights.0.radiance: -1 is out of range; valid: 0 to 1e+09");
}

TEST(SceneErrors, TwoEnvironments) {
  EXPECT_EQ(refused_light("{\"type\": \"environment\"},\n {\"type\": \"environment\"}"),
            "s.json:3:2: lights.1: a second environment light; a scene has at most one");
}

TEST(SceneErrors, EnvironmentOfFileAndRadiance) {
  TemporaryFolder folder;
  folder.write("sky.exr", "x");
  const auto file = folder.write(
      "s.json", "{\"wale\": 1, \"lights\": [{\"type\": \"environment\", \"file\": \"sky.exr\", \"radiance\": 1}]}");
  EXPECT_NE(
      user_message([&] { read_scene(file); }).find(":1:67: lights.0.radiance: cannot be given together with \"file\""),
      std::string::npos);
}

TEST(SceneErrors, MissingFileNamesTheOneBeside) {
  TemporaryFolder folder;
  folder.write("shirt.obj", "x");
  const auto file = folder.write("s.json", "{\"wale\": 1, \"fabrics\": [{\"mesh\":\n\"shrit.obj\"}]}");
  EXPECT_EQ(user_message([&] { read_scene(file); }),
            fmt::format("{}:2:1: fabrics.0.mesh: no file \"shrit.obj\" (looked for {}); did you mean \"shirt.obj\"?",
                        file.string(), (folder / "shrit.obj").string()));
}

TEST(SceneErrors, FolderWhereAFileIsNeeded) {
  EXPECT_TRUE(refused_keys("\"fabrics\": [{\"mesh\": \".\"}]").starts_with("s.json:2:22: fabrics.0.mesh: "));
}

TEST(SceneErrors, UnknownGenerator) {
  EXPECT_EQ(refused_keys("\"fabrics\": [{\"mesh\": {\"generator\": \"beany\"}}]"),
            "s.json:2:36: fabrics.0.mesh.generator: \"beany\" is not known; did you mean \"beanie\"?");
}

TEST(SceneErrors, MisspeltGeneratorKey) {
  EXPECT_EQ(refused_keys("\"fabrics\": [{\"mesh\": {\"genertor\": \"tube\"}}]"),
            "s.json:2:23: fabrics.0.mesh.genertor: unknown key; did you mean \"generator\"?");
}

TEST(SceneErrors, SizeOfAnotherGenerator) {
  EXPECT_TRUE(refused_keys("\"fabrics\": [{\"mesh\": {\"generator\": \"tube\", \"width\": 1}}]")
                  .starts_with("s.json:2:44: fabrics.0.mesh.width: unknown key; "));
}

// Each key would nest the document one level deeper, until its destruction ran out of stack.
TEST(SceneErrors, SetWithAPathOfThousandsOfKeys) {
  std::string path = "a";
  for (int i = 0; i < 30000; ++i) path += ".a";
  const TemporaryFolder folder;
  const auto scene = folder.write("s.json", R"({"wale": 1})");
  const std::string message = user_message([&] { read_scene(scene, {path + "=1"}); });
  EXPECT_NE(message.find("a path of 30001 keys; at most 64"), std::string::npos) << message;
  EXPECT_LT(message.size(), 200u);
}

}  // namespace
}  // namespace wale
