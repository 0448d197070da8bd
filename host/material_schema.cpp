#include "host/material_schema.h"

#include "host/scattering_keys.h"

namespace wale {
namespace {

// At 90 degrees fibres would lie across the ply.
const Range kTwist{-89, 89, true, 0, true};

Type scattering() {
  std::vector<Property> keys;
  for (const ScatteringKey& k : kScatteringKeys)
    keys.push_back({k.key, number({k.low, k.high}, k.angle ? Unit::angle : Unit::none), k.doc});
  return object(keys);
}

Type fibres() {
  const Range width{0.01, 90};
  return object({
      {"count", integer({1, 4096}), "fibres in a ply"},
      {"packing", number({0, 0.7, true}), "share of the ply's section that is fibre"},
      {"twist", number(kTwist, Unit::angle), "angle of the outermost fibres to the ply; its sign is their sense"},
      {"radial_beta", number({0, 20}), "fall of their density outwards; 0 = uniform"},
      {"radial_epsilon", number({0, 0.5}), "share of them that is spread uniformly"},
      {"migration_min", number({0, 1, true}), "least share of its distance to which a fibre wanders in; 1 = none"},
      {"migration_rate", number({0, 100}), "migrations per turn of the bundle"},
      {"seed", integer({0, 4294967295.0}), "another seed, another section"},
      {"transmit_width", number(width, Unit::angle), "along the fibre, of light that goes through one"},
      {"transmit_azimuth_width", number(width, Unit::angle), "around the fibre, of light that goes through one"},
  });
}

Type ply() {
  const auto stripe = object({
      {"color", color(), "of this stretch", "", true},
      {"length", number({1e-9, 1e6}, Unit::length), "of yarn", "", true},
  });
  const auto heather = object({
      {"yarn", number({0, 1}), "relative spread of lightness from yarn to yarn", "0"},
      {"ply", number({0, 1}), "and from ply to ply", "0"},
  });
  return object(
      {
          {"file", file(), "a material in a file of its own; the keys given here override it"},
          {"preset", word({"cotton", "wool", "silk", "polyester", "acrylic", "mohair"}), "appearance to start from",
           "wool"},
          {"color", color(), "what a thick layer of the cloth shows in diffuse light"},
          {"fibre_color", color(), "transmission of one fibre, instead of color"},
          {"reflect", color(), "body colour seen from the lit side; with transmit, instead of color"},
          {"transmit", color(), "body colour of light that comes through; with reflect, instead of color"},
          {"gloss", number({0, 1}), "0 = dull, 1 = shiny, 0.5 = the preset's; instead of roughness"},
          {"roughness", number({0, 90}, Unit::angle), "width of the surface highlight"},
          {"ior", number({1, 4}), "refractive index of the fibres"},
          {"translucency", number({0, 1}), "0 = dense, 1 = airy, 0.5 = the preset's; instead of optical_radius"},
          {"optical_radius", number({0, 1e4}), "optical depth of a ply's radius: how dense the fibres are"},
          {"fibre_twist", number(kTwist, Unit::angle), "angle of the surface fibres to the ply, signed"},
          {"scattering", scattering(), "fitted parameters of the ply, each instead of the preset's"},
          {"fibres", fibres(), "what the ply is made of"},
          {"plies", list(color(), 1), "a colour for each ply of the yarn, over again when there are more plies"},
          {"stripes", list(stripe, 1), "colours along the yarn, over again from the first"},
          {"heather", heather, "unevenly dyed yarn"},
      },
      ply_material_groups());
}

}  // namespace

const std::vector<KeyGroup>& ply_material_groups() {
  static const std::vector<KeyGroup> groups = {{{"color", "fibre_color", "plies", "stripes"}, false},
                                               {{"gloss", "roughness"}, false},
                                               {{"translucency", "optical_radius"}, false}};
  return groups;
}

Type material_type() {
  const auto diffuse = object({{"color", color(), "albedo", "[0.5, 0.5, 0.5]"}});
  const auto coated = object({
      {"color", color(), "albedo below the coat", "[0.5, 0.5, 0.5]"},
      {"roughness", number({0, 1}), "of the coat", "0.3"},
      {"ior", number({1, 4}), "of the coat", "1.5"},
  });
  return tagged("type", {{"ply", ply()}, {"diffuse", diffuse}, {"coated", coated}});
}

Type color_image_type() {
  const Range reach{-1e6, 1e6}, extent{1e-6, 1e6};
  return object({
      {"file", file(), "colours that the cloth shows", "", true},
      {"map", word({"uv", "stitches"}), "how it lies: over the base mesh's UV, or one pixel a stitch", "uv"},
      {"origin", vector(2, reach), "of its lower left corner, UV or stitches", "[0, 0]"},
      {"size", vector(2, extent), "across the image, UV", "[1, 1]"},
      {"repeat", truth(), "go on with copies beyond its borders; else the material's own colour", "false"},
  });
}

}  // namespace wale
