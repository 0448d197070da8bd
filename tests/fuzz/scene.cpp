#include "tests/fuzz/expect.h"
#include "tests/fuzz/scenes.h"
#include "tests/fuzz/targets.h"

bool wale::fuzz::scene(std::string_view bytes) {
  static const std::filesystem::path file = scene_folder() / "scene.json";
  return accepted([&] { expect_consistent(parse_scene(std::string(bytes), file)); });
}
