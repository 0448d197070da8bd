// Materials in files of their own, as a goniometer writes them.
#include "host/materials.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

const std::string kMeasured = R"({"preset": "silk", "fibre_color": [0.9, 0.8, 0.7], "roughness": 5, "ior": 1.5,
  "scattering": {"optical_radius": 2.5, "forward_decay": 0.9, "backward_deflection": -30},
  "fibres": {"count": 90, "twist": -20}})";

PlyAppearance yarn_of(const std::string& material, const std::string& file = kMeasured) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder / "yarns");
  folder.write("yarns/measured.json", file);
  const auto scene = folder.write("s.json", R"({"wale": 1, "materials": {"y": )" + material + "}}");
  return read_scene(scene).materials[0].yarn;
}

TEST(MaterialFile, IsReadBesideTheScene) {
  const PlyAppearance a = yarn_of(R"({"type": "ply", "file": "yarns/measured.json"})");
  EXPECT_EQ(a.preset, "silk");
  EXPECT_EQ(*a.fibre_color, (Rgb{0.9, 0.8, 0.7}));
  EXPECT_NEAR(*a.roughness, 5 * M_PI / 180, 1e-12);
  EXPECT_EQ(*a.scattering.optical_radius, 2.5);
  EXPECT_NEAR(*a.scattering.backward_deflection, -M_PI / 6, 1e-12);
  EXPECT_EQ(*a.fibres.count, 90);
  const WPlyMaterial m = ply_material(a);
  EXPECT_FLOAT_EQ(m.tau_e, 2.5f);
  EXPECT_FLOAT_EQ(m.b, 0.9f);
  EXPECT_NEAR(fibre_recipe(a).twist, std::tan(-M_PI / 9), 1e-6);
}

TEST(MaterialFile, TheScenesOwnKeysGoFirst) {
  const PlyAppearance a = yarn_of(
      R"({"type": "ply", "file": "yarns/measured.json", "color": [0.2, 0.3, 0.4], "gloss": 0.8, "preset": "wool",
          "scattering": {"forward_decay": 0.5}})");
  EXPECT_EQ(a.preset, "wool");
  EXPECT_FALSE(a.fibre_color) << "another way to give the colour";
  EXPECT_EQ(*a.color, (Rgb{0.2, 0.3, 0.4}));
  EXPECT_FALSE(a.roughness);
  EXPECT_EQ(*a.gloss, 0.8);
  EXPECT_EQ(*a.scattering.forward_decay, 0.5);
  EXPECT_EQ(*a.scattering.optical_radius, 2.5) << "what the scene does not say stays";
  EXPECT_NO_THROW(ply_material(a));
}

TEST(MaterialFile, TranslucencyReplacesAnOpticalRadiusInTheFile) {
  const PlyAppearance a = yarn_of(R"({"type": "ply", "file": "yarns/measured.json", "optical_radius": 7})");
  EXPECT_EQ(*a.optical_radius, 7);
  EXPECT_FALSE(a.scattering.optical_radius);
  const PlyAppearance b = yarn_of(R"({"type": "ply", "file": "yarns/measured.json", "translucency": 0.7})");
  EXPECT_FALSE(b.scattering.optical_radius);
  EXPECT_NO_THROW(ply_material(b));
}

TEST(MaterialFile, ErrorsNameTheFile) {
  const auto refused = [](const std::string& file) {
    return user_message([&] { yarn_of(R"({"type": "ply", "file": "yarns/measured.json"})", file); });
  };
  EXPECT_NE(refused(R"({"ior": 0.5})").find("yarns/measured.json:1:9: materials.y.ior: 0.5 is out of range"),
            std::string::npos);
  EXPECT_NE(refused("[1]").find("a ply material is needed in this file, not a list of 1"), std::string::npos);
  EXPECT_NE(refused(R"({"file": "other.json"})").find("cannot name another one"), std::string::npos);
  EXPECT_NE(refused("{").find("measured.json"), std::string::npos);
  EXPECT_NE(user_message([] {
              yarn_of(R"({"type": "ply", "file": "yarns/measurd.json"})");
            }).find("did you mean \"measured.json\"?"),
            std::string::npos);
}

}  // namespace
}  // namespace wale
