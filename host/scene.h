#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geom/fabric.h"

namespace wale {

using Rgb = std::array<double, 3>;

/// Scale, then rotation about x, y, z (radians), then translation (metres).
struct Transform {
  double scale = 1;
  dvec3 rotate{0, 0, 0};
  dvec3 translate{0, 0, 0};

  bool operator==(const Transform&) const = default;
};

/// A mesh: a file, or one of the bundled generators with its sizes (metres).
struct MeshSource {
  std::filesystem::path file;  ///< absolute; empty when generated
  std::string generator;       ///< swatch, tube, pillow, beanie, sock, draped_square
  double width = 0, height = 0, radius = 0, thickness = 0, length = 0, size = 0, sphere_radius = 0;
  int nu = 0, nv = 0;

  bool operator==(const MeshSource&) const = default;
};

struct PatternSource {
  std::filesystem::path file;  ///< absolute; empty when built in
  std::string builtin;         ///< one of bundled_tiles()
  PatternHints hints;

  bool operator==(const PatternSource&) const = default;
};

/// Fitted parameters of the ply BSDF given directly (docs/appearance.md); each replaces the preset's. Angles in
/// radians.
struct Scattering {
  std::optional<double> optical_radius;                                                       ///< tau_e
  std::optional<double> surface_share, surface_rim;                                           ///< e_r, e_r_h4
  std::optional<double> forward_decay, forward_width, forward_narrowing, forward_deflection;  ///< b, s_f0, e_f, d_f
  std::optional<double> backward_width, backward_deflection;                                  ///< s_b, d_b
  std::optional<double> variance_centre, variance_edge;                                       ///< v_c, v_e, rad^2
  std::optional<double> hits_edge, hits_chord, hits_back;                                     ///< n0, n1, of lobe B

  bool operator==(const Scattering&) const = default;
};

/// What a ply is made of, where it is not the preset's; see FibreRecipe. Angles in radians.
struct Fibres {
  std::optional<int> count;
  std::optional<double> packing, twist;
  std::optional<double> radial_beta, radial_epsilon, migration_min, migration_rate;
  std::optional<uint32_t> seed;
  std::optional<double> transmit_width, transmit_azimuth_width;

  bool operator==(const Fibres&) const = default;
};

/// One stretch of self-striping yarn.
struct Stripe {
  Rgb color{1, 1, 1};
  double length = 0;  ///< metres of yarn

  bool operator==(const Stripe&) const = default;
};

/// Appearance of plies: a preset, then what the scene overrides. Colours are scene-linear Rec. 709 in [0,1].
struct PlyAppearance {
  std::string preset = "wool";       ///< cotton, wool, silk, polyester, acrylic, mohair
  std::optional<Rgb> color;          ///< shown by a thick layer of the cloth in diffuse light
  std::optional<Rgb> fibre_color;    ///< C_f, instead of color
  std::optional<Rgb> forward, back;  ///< body colours directly (both or none)
  std::optional<double> roughness;   ///< beta_R, radians
  std::optional<double> gloss;       ///< [0,1], instead of roughness; 0.5 = the preset's
  std::optional<double> ior;
  std::optional<double> optical_radius;  ///< tau_e
  std::optional<double> translucency;    ///< [0,1], instead of optical_radius; 0.5 = the preset's
  std::optional<double> fibre_twist;     ///< angle of the surface fibres to the ply axis, radians, signed
  Scattering scattering;
  Fibres fibres;
  std::vector<Rgb> plies;                    ///< ply i of the yarn has colour i mod n
  std::vector<Stripe> stripes;               ///< one after the other along the yarn, then again from the first
  double heather_yarn = 0, heather_ply = 0;  ///< relative spread of lightness per full yarn and per ply

  bool operator==(const PlyAppearance&) const = default;
};

struct SurfaceAppearance {
  bool coated = false;
  Rgb color{0.5, 0.5, 0.5};
  double roughness = 0.3;  ///< of the coat
  double ior = 1.5;

  bool operator==(const SurfaceAppearance&) const = default;
};

struct MaterialSpec {
  std::string name;
  bool ply = false;
  PlyAppearance yarn;
  SurfaceAppearance surface;

  bool operator==(const MaterialSpec&) const = default;
};

/// An image that colours stitches.
struct ColorImage {
  std::filesystem::path file;      ///< absolute; empty = none
  bool per_stitch = false;         ///< a pixel is a stitch; else the image lies over the base mesh's UV
  dvec2 origin{0, 0}, size{1, 1};  ///< UV of the image's lower left corner, and its extent; stitches when per_stitch
  bool repeat = false;             ///< else stitches beyond the image keep the material's colour

  bool operator==(const ColorImage&) const = default;
};

struct FabricScene {
  FabricSpec spec;
  MeshSource mesh;
  Transform transform;
  PatternSource pattern;
  int material = 0;  ///< index into Scene::materials, a ply material
  ColorImage color_image;
  std::optional<std::vector<Rgb>> palette;  ///< of the tile's yarns, in place of the tile's own; empty: the material's

  bool operator==(const FabricScene&) const = default;
};

/// A prop: mesh, sphere or an endless-looking ground quad.
struct ObjectScene {
  enum class Kind { mesh, sphere, ground } kind = Kind::mesh;
  std::string name;
  MeshSource mesh;
  Transform transform;
  dvec3 center{0, 0, 0};
  double radius = 1;   ///< sphere, metres
  double height = 0;   ///< ground: along `up`
  double extent = 10;  ///< ground: half size, metres
  dvec3 up{0, 1, 0};   ///< ground
  int material = 0;    ///< a surface material

  bool operator==(const ObjectScene&) const = default;
};

struct LightScene {
  enum class Kind { quad, sphere, mesh, environment } kind = Kind::quad;
  std::string name;       ///< may be empty
  Rgb radiance{1, 1, 1};  ///< W/(m^2 sr), times intensity already applied
  dvec3 position{0, 0, 0}, look_at{0, 0, 0}, up{0, 1, 0};
  double width = 1, height = 1;  ///< quad
  bool two_sided = false;        ///< quad: else only towards look_at
  double radius = 1;             ///< sphere
  MeshSource mesh;
  Transform transform;
  std::filesystem::path file;  ///< environment image; empty = constant radiance
  double rotation = 0;         ///< environment: radians about its up axis
  dvec3 env_up{0, 1, 0};

  bool operator==(const LightScene&) const = default;
};

struct CameraScene {
  bool orthographic = false;
  dvec3 position{0, 0, 1}, look_at{0, 0, 0}, up{0, 1, 0};
  double fov = 0.6;     ///< vertical, radians
  double height = 1;    ///< orthographic: metres
  double aperture = 0;  ///< lens radius, metres
  double focus = 0;     ///< metres; 0 = distance to look_at

  bool operator==(const CameraScene&) const = default;
};

struct FilmScene {
  int width = 768, height = 768;
  double exposure = 0;           ///< stops
  std::string view = "neutral";  ///< neutral, srgb
  std::string filter = "tent";   ///< tent, box

  bool operator==(const FilmScene&) const = default;
};

struct IntegratorScene {
  int spp = 64;
  int max_depth = 0;  ///< scattering events; 0 = unlimited
  int russian_roulette_depth = 4;
  std::string light_sampling = "mis";      ///< mis, light, bsdf
  std::string ply_lobes = "full";          ///< full, paper
  std::string local_stage = "exact";       ///< exact, cell, cell+ring
  std::string ply_shadows = "attenuated";  ///< attenuated, opaque
  std::string light_choice = "power";      ///< power, uniform
  std::string math = "exact";              ///< exact, relaxed
  std::string joints = "mitre";            ///< open, capsule, mitre
  std::string normals = "rotation-minimising";  ///< flat, linear, rotation-minimising
  std::string vertices = "full";                ///< quantised, full
  std::string precision = "float";              ///< float, double
  int lanes = 0;                           ///< 0 = from the device; 1, 8, 16
  unsigned pool = 0;                       ///< paths in flight; 0 = from the device
  unsigned seed = 0;

  bool operator==(const IntegratorScene&) const = default;
};

/// A whole scene in SI units (metres, radians), colours linear. Materials are referred to by index.
struct Scene {
  std::string file;
  bool camera_given = false;  ///< else the host frames what there is
  CameraScene camera;
  FilmScene film;
  IntegratorScene integrator;
  std::vector<MaterialSpec> materials;
  std::vector<FabricScene> fabrics;
  std::vector<ObjectScene> objects;
  std::vector<LightScene> lights;
  std::string accuracy_preset;  ///< of --preset, for messages

  bool operator==(const Scene&) const = default;
};

/// Reads a scene file strictly. Throws a user error "file:line:column: ..." with the nearest valid choice on unknown
/// keys, wrong types, values out of range, unresolved names. `overrides` are "key.path=value" (--set), applied before
/// checking; they may name array elements by index or by "name".
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same from the text of a scene file; `file` gives the folder that files are relative to, and the name for
/// messages.
Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<std::string>& overrides = {});

/// The JSON Schema (draft 2020-12) of scene files, from the same table that read_scene checks against.
std::string scene_schema();

}  // namespace wale
