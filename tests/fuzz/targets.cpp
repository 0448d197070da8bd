#include "tests/fuzz/targets.h"

#include <algorithm>

namespace wale::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"pyp", "tiles of Sperl et al.", "geom/pattern_pyp.cpp", true, {"*pattern", "*Q", "*E", "-1", "#"}, pyp},
      {"leaf",
       "tiles of Leaf et al.",
       "geom/pattern_leaf.cpp geom/recover_periods.cpp",
       true,
       {"Num Yarns: ", "\n2\n", " 0 "},
       leaf},
      {"bcc", "binary curves", "geom/pattern_bcc.cpp", true, {"BCC\x44", "C0", "BS", "PL"}, bcc},
      {"chart",
       "stitch charts",
       "geom/chart/stitch_chart.cpp geom/chart/chart_row.cpp geom/chart/loops.cpp",
       true,
       {"k2tog", "ssk", "yo", "c4f", "c2/1b", "k2", "|", "yarn b: #102030\n", "name: ", "#", " | ab\n"},
       chart},
      {"chart_json",
       "stitch charts in JSON",
       "geom/chart/chart_json.cpp geom/json_value.cpp",
       false,
       {"\"rows\"", "\"yarns\"", "\"stitches\"", "\"k2tog\"", "\"c4f\"", "null", "[[", "k2 p2"},
       chart_json},
      {"knitout",
       "machine instructions",
       "geom/chart/knitout.cpp geom/chart/repeat_unit.cpp",
       true,
       {"knit + f1 1\n", "tuck - b2 1\n", "miss + f3 1\n", "xfer f1 b1\n", "rack 1\n", "rack 0\n", "drop f1\n",
        "inhook 1\n"},
       knitout},
      {"obj", "OBJ meshes", "geom/obj_reader.cpp", true, {"\nv ", "\nvt ", "\nf ", "/", "//", "-1", "\\\n"}, obj},
      {"mesh_text",
       "PLY before OpenMesh",
       "geom/mesh_text_check.cpp",
       true,
       {"element ", "property list ", "property ", "end_header\n", "format ascii", "format binary_little_endian",
        "uchar ", "float ", "double "},
       mesh_text},
      {"tile_json",
       "Wale's own tiles",
       "geom/pattern_json.cpp",
       false,
       {"\"points\"", "\"closed\"", "\"curves\"", "\"period\"", "bspline", "[[", "]]", "1e308"},
       tile_json},
      {"ply",
       "PLY meshes",
       "geom/mesh_io.cpp",
       false,
       {"element vertex ", "element face ", "property list uchar int vertex_indices\n", "property float ",
        "end_header\n", "format binary_big_endian 1.0\n"},
       ply},
      {"off", "OFF meshes", "geom/off_reader.cpp", true, {"ST", "C", "N", "OFF\n", "#", "-1", "\n3 0 1 2"}, off},
      {"scene",
       "scene files",
       "host/scene_read.cpp",
       false,
       {"\"fabrics\"", "\"materials\"", "\"lights\"", "\"objects\"", "\"camera\"", "\"type\"", "\"file\"",
        "\"units\": \"mm\"", "\"repeats\"", "1e999", "//", "/*", "tile.json", "mesh.obj"},
       scene},
      {"material",
       "material files",
       "host/scene_materials.cpp host/materials.cpp",
       false,
       {"\"type\": \"ply\"", "\"color\"", "\"scattering\"", "\"fibres\"", "\"stripes\"", "\"optical_radius\"",
        "\"file\""},
       material},
      {"overrides",
       "--set",
       "host/scene_overrides.cpp",
       false,
       {"fabrics.0.", "fabrics.cloth.", "lights.sun.", "materials.yarn.", "film.size=[", "=", "."},
       overrides},
      {"image", "images", "host/image_io.cpp host/exr_header.cpp host/png_chunks.cpp", false, {}, image},
  };
  return all;
}

const Target* find_target(std::string_view name) {
  const auto found = std::find_if(targets().begin(), targets().end(), [&](const Target& t) { return t.name == name; });
  return found == targets().end() ? nullptr : &*found;
}

}  // namespace wale::fuzz
