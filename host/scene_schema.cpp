#include "host/scene_schema.h"

#include "host/animation.h"
#include "host/bundled_tiles.h"
#include "host/material_schema.h"
#include "host/scene.h"

namespace wale {
namespace {

// Lengths in the file's units. The bounds keep every later square and quotient inside float.
const Range kAnyLength{-1e6, 1e6}, kLength{0, 1e6}, kPositiveLength{1e-9, 1e6};

Type length(Range range = kPositiveLength) { return number(range, Unit::length); }
Type point() { return vector(3, kAnyLength, Unit::length); }
Type direction() { return vector(3, {-1e6, 1e6}); }
Type count(int min, int max) { return integer({double(min), double(max)}); }

Type camera() {
  const std::vector<Property> both = {
      {"position", point(), "where the camera stands", "", true},
      {"look_at", point(), "the point in the middle of the picture", "[0, 0, 0]"},
      {"up", direction(), "points up in the picture", "[0, 1, 0]"},
  };
  auto perspective = both, orthographic = both;
  perspective.push_back({"fov", number({0.01, 179}, Unit::angle), "vertical angle of view", "35"});
  perspective.push_back({"aperture", length(kLength), "lens radius; 0 = a pinhole", "0"});
  perspective.push_back({"focus", length(kLength), "distance in focus; 0 = that of look_at", "0"});
  orthographic.push_back({"height", length(), "height of the picture in the scene", "1"});
  return tagged("type", {{"perspective", object(perspective)}, {"orthographic", object(orthographic)}}, "perspective");
}

Type film() {
  return object({
      {"size", vector(2, {1, 65536}, Unit::none, true), "width and height in pixels", "[768, 768]"},
      {"exposure", number({-30, 30}), "stops, for 8-bit images", "0"},
      {"view", word({"neutral", "srgb"}), "tone curve of 8-bit images: Khronos PBR neutral, or none", "neutral"},
      {"filter", word({"tent", "box"}), "pixel reconstruction filter", "tent"},
  });
}

Type integrator() {
  return object({
      {"spp", count(1, 1 << 20), "samples per pixel", "64"},
      {"max_depth", count(0, 65536), "scattering events per path; 0 = no limit", "0"},
      {"russian_roulette_depth", count(0, 65536), "scattering events before Russian roulette starts", "4"},
      {"light_sampling", word({"mis", "light", "bsdf"}), "how direct light is sampled", "mis"},
      {"light_choice", word({"power", "uniform"}), "which light, and which texel of the sky, a sample goes to",
       "power"},
      {"ply_lobes", word({"full", "paper"}), "how a ply scatters: the measured lobes, or Lambert lobes as in papers",
       "full"},
      {"local_stage", word({"exact", "cell", "cell+ring"}), "which cells a ray visits (KNIT21 Algorithm 2 is cell)",
       "exact"},
      {"joints", word({"open", "capsule", "mitre"}),
       "how segments of a ply meet: cut square, with a sphere, or cut by the bisecting plane", "mitre"},
      {"normals", word({"flat", "linear", "rotation-minimising"}),
       "frames that plies are shaded with: of each segment, or interpolated between joints", "rotation-minimising"},
      {"vertices", word({"quantised", "full"}), "how stored curves keep their points: 16 bits a coordinate, or floats",
       "full"},
      {"precision", word({"float", "double"}), "arithmetic of rays and shading (needs a device with fp64)", "float"},
      {"ply_shadows", word({"attenuated", "opaque"}),
       "whether plies let the uncollided light of a lamp pass, as they do on paths", "attenuated"},
      {"math", word({"exact", "relaxed"}), "relaxed = the kernels' compiler may reorder and approximate arithmetic",
       "exact"},
      {"lanes", one_of({0, 1, 8, 16}), "width of explicit vectors; 0 = from the device", "0"},
      {"pool", count(0, 1 << 26), "paths in flight; 0 = from the device", "0"},
      {"seed", integer({0, 4294967295.0}), "another seed, another noise", "0"},
  });
}

Type transform() {
  return object({
      {"scale", number({1e-6, 1e6}), "factor, applied first", "1"},
      {"rotate", vector(3, {-36000, 36000}, Unit::angle), "about x, then y, then z", "[0, 0, 0]"},
      {"translate", point(), "applied last", "[0, 0, 0]"},
  });
}

// "mesh": "file", {"file": ...} or {"generator": ...}; UVs of generated meshes are metres along the cloth.
Type mesh() {
  const auto nu = [](const char* preset) { return Property{"nu", count(3, 4096), "faces along u", preset}; };
  const auto nv = [](const char* preset) { return Property{"nv", count(3, 4096), "faces along v", preset}; };
  const auto size = [](const char* name, const char* preset, const char* doc) {
    return Property{name, length(), doc, preset};
  };
  const auto generated = tagged(
      "generator",
      {{"swatch", object({size("width", "0.1", "along u"), size("height", "0.1", "along v"), nu("32"), nv("32")})},
       {"tube", object({size("radius", "0.04", "of the tube"), size("height", "0.12", "along its axis z"), nu("64"),
                        nv("32")})},
       {"pillow", object({size("width", "0.2", "along u"), size("height", "0.2", "along v"),
                          size("thickness", "0.08", "in the middle"), nu("48"), nv("48")})},
       {"beanie",
        object({size("radius", "0.1", "of the brim"), size("height", "0.2", "from brim to top"), nu("96"), nv("48")})},
       {"sock", object({size("radius", "0.04", "of the leg"), size("height", "0.2", "of the leg"),
                        size("length", "0.22", "of the foot"), nu("96"), nv("96")})},
       {"draped_square", object({size("size", "0.3", "side of the cloth"),
                                 size("sphere_radius", "0.08", "of the sphere below, at the origin"), nu("64")})}});
  const auto named = object({{"file", file(), "OBJ, PLY or OFF", "", true}});
  const auto moving = [](std::vector<Property> keys) {
    const Range numbers{-1e9, 1e9};
    for (const Property& key : std::vector<Property>{
             {"first", integer(numbers), "number of the file, or place in it, at frame 0", "0"},
             {"step", integer({-1e6, 1e6, false, 1}), "numbers from one frame to the next", "1"},
             {"last", integer(numbers), "number beyond which nothing is read; absent = the last there is"},
             {"rest", integer(numbers), "frame on which the cloth is knitted", "0"},
             {"missing", word({"stop", "hold"}),
              "a frame that is not there or damaged: an error, or the frame before it stays", "stop"},
             {"topology", word({"fixed", "changing"}),
              "all frames have the same triangles, or each is a mesh of its own with UV on the same cloth", "fixed"}})
      keys.push_back(key);
    return object(keys);
  };
  const auto cached = moving({{"file", file(), "OBJ, PLY or OFF", "", true},
                              {"cache", file(), "point cache (.pc2) that moves its vertices", "", true}});
  const auto frames =
      moving({{"frames", text(), "\"cloth_####.obj\", one file a frame, or a file of frames (.bin)", "", true}});
  return either({{"", file()}, {"cache", cached}, {"file", named}, {"frames", frames}, {"generator", generated}});
}

Type pattern() {
  const auto named = object({
      {"file", file(), "tile: .pyp, .txt (Leaf et al. 2018), .bcc or .json", "", true},
      {"period", vector(2, kPositiveLength, Unit::length), "size of the tile, where the file does not say"},
      {"yarn_radius", length(), "where the file does not say"},
      {"stitches", vector(2, {1, 10000}, Unit::none, true), "wales and courses in the tile"},
      {"unit", number({1e-9, 1e3}), "metres per unit of the file"},
  });
  const auto built_in = object({{"builtin", word(bundled_tiles()),
                                 "stockinette in closed form, or a relaxed tile of docs/patterns.md", "", true}});
  return either({{"", file()}, {"file", named}, {"builtin", built_in}});
}

Type fabric() {
  const Range twist{-1000, 1000, false, 2};
  const auto yarn = object({
      {"plies", count(1, 8), "plies in the yarn", "3"},
      {"twist_pitch", number(twist), "yarn radii per turn of the plies; negative = left-handed, 0 = none", "8"},
      {"thickness", number({0.01, 100}), "factor on the yarn radius of the tile", "1"},
      {"ply_radius", length(kLength), "in the cloth; 0 = touching circles that fill the yarn", "0"},
  });
  const auto flyaways = object({
      {"hairs", number({0, 1000}), "with one free end, per millimetre of ply", "0"},
      {"loops", number({0, 1000}), "with both ends in the ply, per millimetre of ply", "0"},
      {"length", length(kLength), "mean length of a hair; 0 = 2.2 ply radii, as measured", "0"},
      {"radius", length(kLength), "of a flyaway; 0 = that of the ply's fibres", "0"},
  });
  const auto gauge = object({
      {"wales", number({0.1, 10000}), "per 10 cm", "", true},
      {"courses", number({0.1, 10000}), "per 10 cm; absent = from the tile's aspect"},
  });
  return object(
      {
          {"name", text(), "for messages, statistics and --set"},
          {"mesh", mesh(), "base mesh with UV", "", true},
          {"transform", transform(), "of the base mesh", "{}"},
          {"pattern", pattern(), "yarn tile", "", true},
          {"repeats", vector(2, {1e-3, 1e5}), "tiles across u and v in [0,1]"},
          {"gauge", gauge, "stitches per 10 cm of cloth"},
          {"uv_metres", only_true(), "UVs are metres and the tile keeps its own size"},
          {"yarn", yarn, "plies of the yarn", "{}"},
          {"height_offset", length(kAnyLength), "along the normal of the base mesh", "0"},
          {"tolerance", number({1e-4, 1}), "of the ply curves, in ply radii", "0.05"},
          {"material", text(), "name of a ply material; absent = wool"},
          {"flyaways", flyaways, "fibres that stand off the plies", "{}"},
          {"detail", word({"none", "paper", "maps", "fibres"}),
           "of plies: the tube, maps as KNIT21, maps, or explicit fibres", "maps"},
          {"strain", word({"affine", "relaxed"}),
           "of loops where the cloth is stretched: scaled with it, or as the tile's own table of strains says",
           "affine"},
          {"storage", word({"auto", "stored", "procedural"}),
           "points of plies kept, or warped from a lattice where a ray needs them; auto = by size", "auto"},
          {"lattice", count(0, 64),
           "cells along a tile's side of the lattice that warps the plies; 0 = the base mesh itself (1 if procedural)",
           "0"},
          {"palette", list(color()),
           "colours of the tile's yarns, in turn; absent = the tile's own, [] = the material's"},
          {"color_image", color_image_type(),
           "one colour per stitch from an image; goes before the material's colours"},
      },
      {{{"repeats", "gauge", "uv_metres"}, true}});
}

Type scene_object() {
  const Property name{"name", text(), "for messages and --set"};
  const Property material{"material", text(), "name of a diffuse or coated material; absent = grey"};
  return tagged("type", {{"mesh", object({name,
                                          {"mesh", mesh(), "UVs are not needed", "", true},
                                          {"transform", transform(), "of the mesh", "{}"},
                                          material})},
                         {"sphere", object({name,
                                            {"center", point(), "of the sphere", "[0, 0, 0]"},
                                            {"radius", length(), "of the sphere", "", true},
                                            material})},
                         {"ground", object({name,
                                            {"height", length(kAnyLength), "along up", "0"},
                                            {"extent", length(), "half size", "10"},
                                            {"up", direction(), "normal of the ground", "[0, 1, 0]"},
                                            material})}});
}

Type light() {
  const Property emitted{"radiance", radiance(), "W/(m^2 sr), one number or [r, g, b]", "1"};
  const Property intensity{"intensity", number({0, 1e6}), "factor on the radiance", "1"};
  const Property name{"name", text(), "for messages and --set"};
  const auto quad = object({
      name,
      {"position", point(), "middle of the quad", "", true},
      {"look_at", point(), "what it faces", "[0, 0, 0]"},
      {"up", direction(), "direction of its height", "[0, 1, 0]"},
      {"width", length(), "of the quad", "1"},
      {"height", length(), "of the quad", "1"},
      emitted,
      intensity,
      {"two_sided", truth(), "shines backwards too", "false"},
  });
  const auto sphere = object({name,
                              {"position", point(), "of its centre", "", true},
                              {"radius", length(), "of the sphere", "", true},
                              emitted,
                              intensity});
  const auto glowing_mesh = object({name,
                                    {"mesh", mesh(), "every triangle shines", "", true},
                                    {"transform", transform(), "of the mesh", "{}"},
                                    emitted,
                                    intensity});
  const auto environment = object(
      {
          name,
          {"file", file(), "latitude-longitude image"},
          {"radiance", radiance(), "of a constant environment; 1 when no file is given"},
          intensity,
          {"rotation", number({-36000, 36000}, Unit::angle), "about up", "0"},
          {"up", direction(), "where the top of the image points", "[0, 1, 0]"},
      },
      {{{"file", "radiance"}, false}});
  return tagged("type", {{"quad", quad}, {"sphere", sphere}, {"mesh", glowing_mesh}, {"environment", environment}});
}

}  // namespace

const SchemaType& scene_type() {
  static const Type type = object({
      {"$schema", text(), "where an editor finds this schema; not read"},
      {"wale", one_of({1}), "version of the format", "", true},
      {"units", word({"m", "mm"}), "of every length in the file", "m"},
      {"camera", camera(), "absent = frames the fabrics"},
      {"film", film(), "the image", "{}"},
      {"integrator", integrator(), "accuracy and effort", "{}"},
      {"animation", animation_type(), "frames, key frames and motion blur", "{}"},
      {"materials", map(material_type()), "by name", "{}"},
      {"fabrics", list(fabric()), "knitted cloth", "[]"},
      {"objects", list(scene_object()), "everything else that is seen", "[]"},
      {"lights", list(light()), "absent or empty = a constant environment of radiance 1", "[]"},
  });
  return *type;
}

std::string scene_schema() { return schema_text(scene_type(), "Wale scene"); }

}  // namespace wale
