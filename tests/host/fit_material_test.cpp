// A fitted material is written with all that the scene's material had.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "host/fit/material_json.h"
#include "host/material_schema.h"
#include "host/scene.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

using Json = nlohmann::json;

// Between them all keys; colours, gloss and density can be given in one way each.
const char* const kMaterials[] = {
    R"({"type": "ply", "preset": "silk", "color": [0.9, 0.8, 0.7], "gloss": 0.7, "translucency": 0.3, "ior": 1.45,
        "fibre_twist": -12,
        "fibres": {"count": 90, "packing": 0.5, "twist": -20, "radial_beta": 1.5, "radial_epsilon": 0.1,
                   "migration_min": 0.6, "migration_rate": 2, "seed": 7, "transmit_width": 6,
                   "transmit_azimuth_width": 11}})",
    R"({"type": "ply", "preset": "wool", "fibre_color": [0.9, 0.8, 0.7], "roughness": 5, "optical_radius": 3,
        "scattering": {"surface_share": 0.5, "surface_rim": 0.1, "forward_decay": 0.9,
                       "forward_width": 0.3, "forward_narrowing": 0.4, "forward_deflection": 4, "backward_width": 1.5,
                       "backward_deflection": -30, "variance_centre": 0.2, "variance_edge": 0.3, "hits_edge": 2,
                       "hits_chord": 3, "hits_back": 0.8}})",
    R"({"type": "ply", "preset": "cotton", "reflect": [0.3, 0.4, 0.5], "transmit": [0.6, 0.7, 0.8],
        "scattering": {"optical_radius": 2.5}})"};

void gather(const SchemaType& type, const std::string& path, std::set<std::string>& keys) {
  for (const Property& p : type.properties) {
    const bool inner = p.type->kind == SchemaType::Kind::object;
    if (inner) gather(*p.type, path + p.name + ".", keys);
    if (!inner) keys.insert(path + p.name);
  }
}

void gather(const Json& value, const std::string& path, std::set<std::string>& keys) {
  for (const auto& [key, v] : value.items()) {
    if (v.is_object()) gather(v, path + key + ".", keys);
    if (!v.is_object()) keys.insert(path + key);
  }
}

TEST(FitMaterial, IsWrittenWithEveryKeyOfTheScene) {
  std::set<std::string> written;
  for (const char* text : kMaterials) {
    TemporaryFolder folder;
    const auto file = folder.write("s.json", std::string(R"({"wale": 1, "materials": {"y": )") + text + "}}");
    const std::string out = material_json(read_scene(file), {.material = 0, .fabrics = {}});
    EXPECT_EQ(Json::parse(out), Json::parse(text));
    gather(Json::parse(out), "", written);
  }
  // Refused by `wale fit`: cloth of several colours. A file is read into the keys.
  for (const char* other : {"file", "plies", "stripes", "heather.yarn", "heather.ply"}) written.insert(other);
  written.erase("type");
  std::set<std::string> known;
  const Type material = material_type();
  const auto ply = std::find(material->words.begin(), material->words.end(), "ply") - material->words.begin();
  gather(*material->alternatives[size_t(ply)], "", known);
  EXPECT_EQ(written, known) << "a key of the schema that a fitted material would lose";
}

}  // namespace
}  // namespace wale::fit
