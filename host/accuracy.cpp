#include "host/accuracy.h"

#include <fmt/format.h>

#include <array>

#include "geom/error.h"
#include "host/scene.h"
#include "host/suggest.h"

namespace wale {
namespace {

// What all fabrics have in common.
template <typename Value>
std::string of_fabrics(const Scene& scene, const Value& value) {
  std::string common;
  for (const FabricScene& fabric : scene.fabrics) {
    const std::string one = value(fabric.spec);
    if (!common.empty() && one != common) return "mixed";
    common = one;
  }
  return common.empty() ? "no fabric" : common;
}

std::string detail_name(const FabricSpec& spec) {
  constexpr std::array names = {"none", "paper", "maps", "fibres"};
  return names.at(size_t(spec.detail));
}

// One level per word that a key takes.
std::vector<AccuracyLevel> words(const std::string& key, const std::vector<std::string>& names) {
  std::vector<AccuracyLevel> out;
  for (const auto& name : names) out.push_back({name, {key + "=" + name}});
  return out;
}

const std::vector<AccuracyOption>& table() {
  static const std::vector<AccuracyOption> options = {
      {"local_stage", "which cells of the cloth a ray visits (KNIT21 Algorithm 2 is cell)",
       words("integrator.local_stage", {"cell", "cell+ring", "exact"}),
       [](const Scene& s) { return s.integrator.local_stage; }},
      {"curves", "largest distance of the segments from the ply's curve, in ply radii",
       words("fabrics.*.tolerance", {"0.4", "0.2", "0.1", "0.05", "0.02"}),
       [](const Scene& s) {
         return of_fabrics(s, [](const FabricSpec& f) { return fmt::format("{:g}", f.tolerance); });
       }},
      {"joints", "how segments of a ply meet: cut square (gaps), with a sphere, or cut by the bisecting plane",
       words("integrator.joints", {"open", "capsule", "mitre"}), [](const Scene& s) { return s.integrator.joints; }},
      {"warp",
       "cells along a tile's side of the lattice that bends the yarns; mesh = every vertex by the base mesh",
       {{"1", {"fabrics.*.lattice=1"}},
        {"2", {"fabrics.*.lattice=2"}},
        {"4", {"fabrics.*.lattice=4"}},
        {"mesh", {"fabrics.*.lattice=0"}}},
       [](const Scene& s) {
         return of_fabrics(s, [](const FabricSpec& f) {  // A procedural fabric has a lattice always.
           return f.lattice ? std::to_string(f.lattice) : f.storage == Storage::procedural ? "1" : "mesh";
         });
       }},
      {"strain", "loops where the cloth is stretched: scaled with it, or as the tile's table of strains says",
       words("fabrics.*.strain", {"affine", "relaxed"}),
       [](const Scene& s) {
         return of_fabrics(
             s, [](const FabricSpec& f) { return f.strain == LoopStrain::relaxed ? "relaxed" : "affine"; });
       }},
      {"normals", "frames that plies are shaded with: of each segment, or interpolated between joints",
       words("integrator.normals", {"flat", "linear", "rotation-minimising"}),
       [](const Scene& s) { return s.integrator.normals; }},
      {"detail", "fibres on plies: none, maps as KNIT21, maps, or a curve for every fibre",
       words("fabrics.*.detail", {"none", "paper", "maps", "fibres"}),
       [](const Scene& s) { return of_fabrics(s, detail_name); }},
      {"ply_lobes", "how a ply scatters: Lambert lobes as in papers, or the measured ones",
       words("integrator.ply_lobes", {"paper", "full"}), [](const Scene& s) { return s.integrator.ply_lobes; }},
      {"ply_shadows", "plies stop all light on its way from a lamp, or let the uncollided part pass",
       words("integrator.ply_shadows", {"opaque", "attenuated"}),
       [](const Scene& s) { return s.integrator.ply_shadows; }},
      {"depth", "scattering events per path; 0 = no limit",
       words("integrator.max_depth", {"2", "4", "8", "16", "32", "0"}),
       [](const Scene& s) { return std::to_string(s.integrator.max_depth); }},
      {"light_choice", "lights and texels of the sky are sampled evenly, or by their power",
       words("integrator.light_choice", {"uniform", "power"}),
       [](const Scene& s) { return s.integrator.light_choice; }},
      {"light_sampling", "directions of direct light: from scattering, from lights, or both weighed (MIS)",
       words("integrator.light_sampling", {"bsdf", "light", "mis"}),
       [](const Scene& s) { return s.integrator.light_sampling; }},
      {"precision", "arithmetic of rays and shading; what is stored stays float",
       words("integrator.precision", {"float", "double"}), [](const Scene& s) { return s.integrator.precision; }},
      {"math", "what the kernels' compiler may do to arithmetic", words("integrator.math", {"relaxed", "exact"}),
       [](const Scene& s) { return s.integrator.math; }},
  };
  return options;
}

using Levels = std::vector<std::pair<std::string, std::string>>;

Levels with(Levels levels, const Levels& changes) {
  for (const auto& [option, level] : changes)
    for (auto& [name, value] : levels)
      if (name == option) value = level;
  return levels;
}

}  // namespace

const AccuracyLevel* AccuracyOption::level(const std::string& wanted) const {
  for (const AccuracyLevel& one : levels)
    if (one.name == wanted) return &one;
  return nullptr;
}

std::vector<std::string> AccuracyPreset::overrides() const {
  std::vector<std::string> out;
  for (const auto& [option, level] : levels)
    for (const auto& text : accuracy_option(option).level(level)->overrides) out.push_back(text);
  return out;
}

std::span<const AccuracyOption> accuracy_options() { return table(); }

const AccuracyOption& accuracy_option(const std::string& name) {
  std::vector<std::string> names;
  for (const AccuracyOption& option : table()) {
    if (option.name == name) return option;
    names.push_back(option.name);
  }
  user_error("{}: no such accuracy option; {}", one_line(name), nearest_choice(name, names));
}

std::span<const AccuracyPreset> accuracy_presets() {
  // The others as changes to it.
  const Levels final = {{"local_stage", "exact"},
                        {"curves", "0.05"},
                        {"joints", "mitre"},
                        {"warp", "mesh"},
                        {"strain", "affine"},
                        {"normals", "rotation-minimising"},
                        {"detail", "maps"},
                        {"ply_lobes", "full"},
                        {"ply_shadows", "attenuated"},
                        {"depth", "0"},
                        {"light_choice", "power"},
                        {"light_sampling", "mis"},
                        {"precision", "float"},
                        {"math", "exact"}};
  // A reference keeps maps: explicit fibres are another model of the ply, a hundred times as large.
  static const std::vector<AccuracyPreset> presets = {
      {"draft", "to place camera and lights",
       with(
           final,
           {{"curves", "0.2"}, {"detail", "none"}, {"ply_lobes", "paper"}, {"ply_shadows", "opaque"}, {"depth", "4"}})},
      {"paper", "as KNIT21 describes it",
       with(final, {{"local_stage", "cell"},
                    {"curves", "0.1"},
                    {"detail", "paper"},
                    {"ply_lobes", "paper"},
                    {"ply_shadows", "opaque"},
                    {"depth", "16"}})},
      {"final", "what scenes have where they say nothing", final},
      {"reference", "to measure others against", with(final, {{"curves", "0.02"}})},
  };
  return presets;
}

std::string preset_names() {
  std::string out;
  for (const AccuracyPreset& preset : accuracy_presets()) out += (out.empty() ? "" : ", ") + preset.name;
  return out;
}

const AccuracyPreset& accuracy_preset(const std::string& name) {
  for (const AccuracyPreset& preset : accuracy_presets())
    if (preset.name == name) return preset;
  user_error("--preset {}: no such preset; valid: {}", one_line(name), preset_names());
}

}  // namespace wale
