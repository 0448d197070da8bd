#include "host/material_schema.h"
#include "host/scene_materials.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/scenes.h"
#include "tests/fuzz/targets.h"

// The first line is what the scene says, the rest is the material's own file.
bool wale::fuzz::material(std::string_view bytes) {
  return accepted([&] {
    const size_t end = std::min(bytes.find('\n'), bytes.size());
    JsonNode own = parse_json(std::string(bytes.substr(0, end)), "scene");
    join_material("m", own, parse_json(std::string(bytes.substr(end)), "file"));
    check_schema(*material_type(), own, {1, scene_folder()});
    expect_consistent(material_of("m", own));
  });
}
