#include "tests/hard/fixtures_scenes.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

namespace wale::test {
namespace {

/// Files of the fixtures, gone when the program ends.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / fmt::format("wale_hard_{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path next(const std::string& suffix) { return path_ / fmt::format("{}{}", number_++, suffix); }

 private:
  std::filesystem::path path_;
  int number_ = 0;
};

}  // namespace

std::filesystem::path fixture_file(const std::string& suffix) {
  static Folder folder;
  return folder.next(suffix);
}

FabricScene& add_cloth(Scene& scene, const BaseMesh& mesh, const Rgb& color) {
  const auto file = fixture_file(".obj");
  write_obj(mesh, file);
  MaterialSpec material;
  material.name = "yarn";
  material.ply = true;
  material.yarn.color = color;
  FabricScene fabric;
  fabric.spec.name = mesh.name;
  fabric.spec.scale.kind = FabricScale::Kind::uv_metres;
  fabric.mesh.file = file;
  fabric.pattern.builtin = "stockinette";
  fabric.material = int(scene.materials.size());
  scene.materials.push_back(material);
  scene.fabrics.push_back(fabric);
  return scene.fabrics.back();
}

Scene white_furnace(const BaseMesh& mesh, double view, int pixels) {
  Scene scene = empty_scene(view, pixels);
  add_cloth(scene, mesh);
  scene.lights.push_back(constant_environment(1));
  return scene;
}

Scene closed_cloth(const BaseMesh& mesh) {
  Scene scene = empty_scene(0.006, 8);
  FabricScene& fabric = add_cloth(scene, mesh);
  fabric.spec.thickness = 2;
  scene.materials[size_t(fabric.material)].yarn.optical_radius = 100;
  return scene;
}

}  // namespace wale::test
