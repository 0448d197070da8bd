#include "host/cost/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "geom/error.h"
#include "host/accuracy.h"
#include "host/scene_identity.h"
#include "host/suggest.h"

namespace wale::cost {
namespace {

// Options that launches and programs alone know of: what lies on the device is the same at all their levels.
constexpr std::array kNoGeometry = {"normals",        "ply_lobes", "ply_shadows", "depth",
                                    "light_sampling", "precision", "math"};

class Collector {
 public:
  Collector(const std::filesystem::path& file, const std::vector<std::string>& set, PictureSize size)
      : file_(file), set_(set), size_(size) {}

  size_t add(const std::string& name, const std::vector<std::string>& overrides) {
    Scene scene = read(overrides);
    const std::string settings = accuracy_settings(scene);
    for (size_t u = 0; u < out_.units.size(); ++u)
      if (out_.units[u].settings == settings) return u;
    const std::string geometry = geometry_of(scene);
    out_.units.push_back({name, std::move(scene), geometry, settings});
    return out_.units.size() - 1;
  }

  void add_row(const std::string& option, const std::string& level, const std::vector<std::string>& overrides) {
    Level row{option, level, {}, {}, false, false};
    try {
      row.unit = add(option + " " + level, overrides);
      row.own = *row.unit == 0;
    } catch (const Error& error) {
      if (error.fault() != Fault::user) throw;
      row.skipped = error.what();
    }
    out_.rows.push_back(std::move(row));
  }

  Levels& levels() { return out_; }

 private:
  Scene read(const std::vector<std::string>& overrides) const {
    std::vector<std::string> all = set_;
    all.insert(all.end(), overrides.begin(), overrides.end());
    Scene scene = read_scene(file_, all);
    FilmScene& film = scene.film;
    if (size_.width > 0) {
      film.width = size_.width, film.height = size_.height;
    } else if (const int longest = std::max(film.width, film.height); longest > kLongestSide) {
      const auto smaller = [&](int side) { return std::max(1, int(int64_t(side) * kLongestSide / longest)); };
      film.width = smaller(film.width), film.height = smaller(film.height);
    }
    return scene;
  }

  static std::string geometry_of(const Scene& scene) {
    std::string out;
    for (const AccuracyOption& option : accuracy_options())
      if (std::find(kNoGeometry.begin(), kNoGeometry.end(), option.name) == kNoGeometry.end())
        out += option.name + " " + option.at(scene) + ", ";
    return out;
  }

  const std::filesystem::path& file_;
  const std::vector<std::string>& set_;
  PictureSize size_;
  Levels out_;
};

size_t place_of(const AccuracyOption& option, const std::string& level) {
  for (size_t i = 0; i < option.levels.size(); ++i)
    if (option.levels[i].name == level) return i;
  return option.levels.size();  // between levels, or mixed: not comparable
}

// The finest lattice that is a level: the most accurate way to hold a fabric procedurally.
constexpr int kFinestLattice = 4;

// The preset of that name, and what it does not mention at its most accurate; loops as the scene has them.
std::vector<std::string> reference_overrides(const Scene& scene) {
  std::vector<std::string> out;
  const AccuracyPreset& preset = accuracy_preset("reference");
  for (const AccuracyOption& option : accuracy_options()) {
    if (option.name == "warp") {
      for (size_t i = 0; i < scene.fabrics.size(); ++i) {
        const FabricSpec& spec = scene.fabrics[i].spec;
        const bool procedural = spec.storage == Storage::procedural;
        out.push_back(fmt::format("fabrics.{}.lattice={}", i, procedural ? std::max(spec.lattice, kFinestLattice) : 0));
      }
      continue;
    }
    if (option.name == "strain") continue;  // loops of another shape are another cloth: it keeps the scene's
    const bool named = std::any_of(preset.levels.begin(), preset.levels.end(),
                                   [&](const auto& level) { return level.first == option.name; });
    if (!named) out.insert(out.end(), option.most_accurate().overrides.begin(), option.most_accurate().overrides.end());
  }
  const std::vector<std::string> own = preset.overrides();
  out.insert(out.end(), own.begin(), own.end());
  return out;
}

bool any_procedural(const Scene& scene) {
  return std::any_of(scene.fabrics.begin(), scene.fabrics.end(),
                     [](const FabricScene& f) { return f.spec.storage == Storage::procedural; });
}

}  // namespace

WantedOptions wanted_options(const std::string& text) {
  WantedOptions out;
  std::vector<std::string> known;
  for (const AccuracyOption& option : accuracy_options()) known.push_back(option.name);
  if (text.empty()) {
    out.options = known;
    return out;
  }
  known.push_back("presets");
  out.presets = false;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const std::string name = text.substr(from, comma - from);
    if (std::find(known.begin(), known.end(), name) == known.end())
      user_error("--options {}: no such option; {}", one_line(name), nearest_choice(name, known));
    if (name == "presets")
      out.presets = true;
    else if (std::find(out.options.begin(), out.options.end(), name) != out.options.end())
      user_error("--options {}: named twice", name);
    else
      out.options.push_back(name);
    from = comma + 1;
  }
  return out;
}

Levels collect_levels(const std::filesystem::path& file, const std::vector<std::string>& set,
                      const WantedOptions& wanted, PictureSize size) {
  Collector collector(file, set, size);
  Levels& levels = collector.levels();
  collector.add("the scene", {});
  levels.reference = collector.add("reference", reference_overrides(Scene(levels.units[0].scene)));
  std::string silent;
  const auto scene_of = [&](size_t unit) -> const Scene& { return levels.units[unit].scene; };
  for (const AccuracyOption& option : accuracy_options()) {
    if (std::find(wanted.options.begin(), wanted.options.end(), option.name) == wanted.options.end()) continue;
    if (option.at(scene_of(0)) == kNoFabric) {  // it says nothing of this scene
      silent += (silent.empty() ? "" : ", ") + option.name;
      continue;
    }
    const size_t at_reference = place_of(option, option.at(scene_of(levels.reference)));
    for (size_t i = 0; i < option.levels.size(); ++i) {
      const AccuracyLevel& level = option.levels[i];
      if (option.name == "warp" && level.name == "mesh" && any_procedural(scene_of(0)))
        levels.rows.push_back({option.name, level.name, {}, "what is held procedurally has a lattice always"});
      else
        collector.add_row(option.name, level.name, level.overrides);
      levels.rows.back().beyond = i > at_reference;
    }
  }
  if (levels.rows.empty() && !wanted.presets) user_error("--options {}: the scene has no fabric", silent);
  if (wanted.presets)
    for (const AccuracyPreset& preset : accuracy_presets())
      collector.add_row("preset", preset.name, preset.overrides());
  return std::move(levels);
}

}  // namespace wale::cost
