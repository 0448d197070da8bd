#include "tests/fuzz/expect.h"
#include "tests/fuzz/scenes.h"
#include "tests/fuzz/targets.h"

// Each line is one --set.
bool wale::fuzz::overrides(std::string_view bytes) {
  static const std::filesystem::path file = scene_folder() / "scene.json";
  static const std::string text = R"({"wale": 1, "materials": {"yarn": {"type": "ply"}},
    "fabrics": [{"name": "cloth", "mesh": {"generator": "swatch"}, "pattern": {"builtin": "stockinette"},
    "material": "yarn", "repeats": [4, 4]}], "lights": [{"name": "sun", "type": "sphere", "position": [0, 1, 0], "radius": 0.1}]})";
  std::vector<std::string> options;
  while (!bytes.empty()) {
    const size_t end = std::min(bytes.find('\n'), bytes.size());
    options.emplace_back(bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
  return accepted([&] { expect_consistent(parse_scene(text, file, options)); });
}
