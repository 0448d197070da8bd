// A checked document becomes a Scene; what a table of types cannot say is checked here.
#include <algorithm>
#include <cmath>
#include <set>

#include "geom/error.h"
#include "host/animation.h"
#include "host/file_fence.h"
#include "host/scene.h"
#include "host/scene_fabrics.h"
#include "host/scene_materials.h"
#include "host/scene_nodes.h"
#include "host/scene_overrides.h"
#include "host/scene_schema.h"
#include "host/scene_sources.h"

namespace wale {
namespace {

constexpr double kMaxPixels = double(1 << 28);

// A view needs two different points and an up that is not along their line.
void check_view(const JsonNode& node, const std::string& path) {
  const dvec3 line = vector_of(node["look_at"]) - vector_of(node["position"]);
  if (glm::length(line) < 1e-12) {
    const JsonNode& at = node["position"];
    fail(at, path + ".position", "the same point as look_at ({:g}, {:g}, {:g} m)", vector_of(at).x, vector_of(at).y,
         vector_of(at).z);
  }
  const JsonNode& up_node = node["up"];
  const dvec3 up = glm::normalize(nonzero_direction(up_node, path + ".up"));
  if (glm::length(glm::cross(glm::normalize(line), up)) < 1e-6)
    fail(up_node, path + ".up", "parallel to the line from position to look_at; choose another direction");
}

CameraScene camera_of(const JsonNode& node) {
  check_view(node, "camera");
  CameraScene camera;
  camera.orthographic = node["type"].text == "orthographic";
  camera.position = vector_of(node["position"]);
  camera.look_at = vector_of(node["look_at"]);
  camera.up = vector_of(node["up"]);
  if (camera.orthographic) {
    camera.height = number_of(node, "height");
  } else {
    camera.fov = number_of(node, "fov");
    camera.aperture = number_of(node, "aperture");
    camera.focus = number_of(node, "focus");
  }
  return camera;
}

FilmScene film_of(const JsonNode& node) {
  const dvec2 size = pair_of(node["size"]);
  if (size.x * size.y > kMaxPixels)
    fail(node["size"], "film.size", "{:g} x {:g} are more pixels than {:g}", size.x, size.y, kMaxPixels);
  return {int(size.x), int(size.y), number_of(node, "exposure"), node["view"].text, node["filter"].text};
}

IntegratorScene integrator_of(const JsonNode& node) {
  IntegratorScene out;
  out.spp = integer_of(node, "spp");
  out.max_depth = integer_of(node, "max_depth");
  out.russian_roulette_depth = integer_of(node, "russian_roulette_depth");
  out.light_sampling = node["light_sampling"].text;
  out.ply_lobes = node["ply_lobes"].text;
  out.local_stage = node["local_stage"].text;
  out.joints = node["joints"].text;
  out.normals = node["normals"].text;
  out.vertices = node["vertices"].text;
  out.precision = node["precision"].text;
  out.ply_shadows = node["ply_shadows"].text;
  out.light_choice = node["light_choice"].text;
  out.math = node["math"].text;
  out.lanes = integer_of(node, "lanes");
  out.pool = static_cast<unsigned>(number_of(node, "pool"));
  out.seed = static_cast<unsigned>(number_of(node, "seed"));
  if (out.precision == "double" && out.lanes > 1)
    fail(node["lanes"], "integrator.lanes", "{} lanes are of floats; precision \"double\" has 0 or 1", out.lanes);
  return out;
}

AnimationScene animation_of(const JsonNode& node) {
  AnimationScene out;
  out.frame = number_of(node, "frame");
  out.fps = number_of(node, "fps");
  out.shutter = number_of(node, "shutter");
  out.shutter_steps = integer_of(node, "shutter_steps");
  out.moves = !node["keys"].members.empty();
  return out;
}

ObjectScene object_of(Scene& scene, const JsonNode& node, size_t index, const SceneMoment& moment) {
  const std::string path = fmt::format("objects.{}", index);
  ObjectScene object;
  object.name = text_or(node, "name", fmt::format("object{}", index));
  const std::string& type = node["type"].text;
  if (type == "mesh") {
    object.mesh = mesh_of(node["mesh"], moment);
    object.transform = transform_of(node["transform"]);
  } else if (type == "sphere") {
    object.kind = ObjectScene::Kind::sphere;
    object.center = vector_of(node["center"]);
    object.radius = number_of(node, "radius");
  } else {
    object.kind = ObjectScene::Kind::ground;
    object.height = number_of(node, "height");
    object.extent = number_of(node, "extent");
    object.up = nonzero_direction(node["up"], path + ".up");
  }
  object.material = find_material(scene, node, path, false);
  return object;
}

LightScene light_of(const JsonNode& node, size_t index, const SceneMoment& moment) {
  const std::string path = fmt::format("lights.{}", index);
  const std::string& type = node["type"].text;
  LightScene light;
  light.name = text_or(node, "name", fmt::format("light{}", index));
  if (node.has("radiance")) light.radiance = color_of(node["radiance"]);
  for (double& channel : light.radiance) channel *= number_of(node, "intensity");
  if (type == "quad") {
    check_view(node, path);
    light.position = vector_of(node["position"]);
    light.look_at = vector_of(node["look_at"]);
    light.up = vector_of(node["up"]);
    light.width = number_of(node, "width");
    light.height = number_of(node, "height");
    light.two_sided = node["two_sided"].boolean;
  } else if (type == "sphere") {
    light.kind = LightScene::Kind::sphere;
    light.position = vector_of(node["position"]);
    light.radius = number_of(node, "radius");
  } else if (type == "mesh") {
    light.kind = LightScene::Kind::mesh;
    light.mesh = mesh_of(node["mesh"], moment);
    light.transform = transform_of(node["transform"]);
  } else {
    light.kind = LightScene::Kind::environment;
    if (node.has("file")) light.file = node["file"].text;
    light.rotation = number_of(node, "rotation");
    light.env_up = nonzero_direction(node["up"], path + ".up");
  }
  return light;
}

void check_names(const JsonNode& list, const std::string& path) {
  std::set<std::string> seen;
  for (size_t i = 0; i < list.items.size(); ++i)
    if (const JsonNode* name = list.items[i].find("name"))
      if (!seen.insert(name->text).second)
        fail(*name, fmt::format("{}.{}.name", path, i), "\"{}\" is the name of another element too", name->text);
}

// Material files are joined before the schema is checked.
void fence_materials(const JsonNode& root, const SchemaContext& context) {
  const JsonNode* materials = root.find("materials");
  if (!context.fence || !materials) return;
  for (const auto& [name, place, node] : materials->members)
    if (const JsonNode* named = node.find("file"); named && named->kind == JsonNode::Kind::string)
      if (!context.fence->admits(std::filesystem::absolute(context.folder / named->text).lexically_normal()))
        fail(*named, "materials." + name + ".file", "{}", context.fence->refusal(named->text));
}

Scene scene_of(JsonNode root, const std::filesystem::path& file, const std::vector<std::string>& overrides,
               FileFence* fence = nullptr) {
  apply_overrides(root, overrides);
  apply_key_frames(root);
  if (root.has("animation")) apply_overrides(root, overrides);  // what they say goes before keys
  SchemaContext context{1, std::filesystem::absolute(file).parent_path(), fence};
  // Lengths are converted while the document is checked, so the units are looked up first; a wrong word is found there.
  const JsonNode* units = root.find("units");
  if (units && units->text == "mm") context.metres_per_unit = 1e-3;
  fence_materials(root, context);
  join_material_files(root, context.folder);
  check_schema(scene_type(), root, context);

  Scene scene;
  scene.file = file.string();
  scene.camera_given = root.has("camera");
  if (scene.camera_given) scene.camera = camera_of(root["camera"]);
  scene.film = film_of(root["film"]);
  scene.integrator = integrator_of(root["integrator"]);
  scene.animation = animation_of(root["animation"]);
  const SceneMoment moment{scene.animation.frame, context.folder, fence};
  for (const auto& member : root["materials"].members) scene.materials.push_back(material_of(member.key, member.value));
  for (const char* key : {"fabrics", "objects", "lights"}) check_names(root[key], key);
  for (size_t i = 0; i < root["fabrics"].items.size(); ++i)
    scene.fabrics.push_back(fabric_of(scene, root["fabrics"].items[i], i, moment));
  for (size_t i = 0; i < root["objects"].items.size(); ++i)
    scene.objects.push_back(object_of(scene, root["objects"].items[i], i, moment));
  int environments = 0;
  for (size_t i = 0; i < root["lights"].items.size(); ++i) {
    const JsonNode& node = root["lights"].items[i];
    scene.lights.push_back(light_of(node, i, moment));
    if (scene.lights.back().kind == LightScene::Kind::environment && ++environments > 1)
      fail(node, fmt::format("lights.{}", i), "a second environment light; a scene has at most one");
  }
  const auto& tracks = root["animation"]["keys"].members;
  const bool keyed_fabrics =
      std::any_of(tracks.begin(), tracks.end(), [](const auto& track) { return track.key.starts_with("fabrics."); });
  const auto moving = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& item) { return item.mesh.sequence.has_value(); });
  };
  for (FabricScene& fabric : scene.fabrics) fabric.moves = fabric.mesh.sequence.has_value() || keyed_fabrics;
  scene.animation.moves |= moving(scene.fabrics) || moving(scene.objects) || moving(scene.lights);
  if (scene.lights.empty()) {
    scene.lights.emplace_back();
    scene.lights.back().kind = LightScene::Kind::environment;
  }
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return scene_of(read_json(file), file, overrides);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides) {
  return scene_of(parse_json(text, file.string()), file, overrides);
}

Scene fenced_scene(const JsonNode& document, const std::filesystem::path& file, FileFence& fence) {
  return scene_of(document, file, {}, &fence);
}

}  // namespace wale
