#include "host/plan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/accuracy.h"
#include "host/memory_needs.h"
#include "host/render.h"
#include "host/stages.h"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

std::vector<Plan::Program> programs(const Features& needed, const Features& built, const SceneDevice& on_device) {
  std::vector<Plan::Program> out;
  const auto add = [&](const std::vector<Stage>& of_needed, const std::vector<Stage>& of_built) {
    for (size_t i = 0; i < of_built.size(); ++i) {
      const Stage& stage = of_built[i];
      Plan::Program program{stage.file, stage.kernels, stage.used, stage.used, stage.because};
      if (stage.used && !of_needed[i].used) program.because = "--features all; " + of_needed[i].because;
      if (stage.used && stage.file == "stages/connect.cl" && !on_device.samples_lights()) {
        program.launched = false;
        program.because = "no light is left to sample";
      }
      out.push_back(program);
    }
  };
  add(geometry_stages(needed), geometry_stages(built));
  add(wavefront_stages(needed), wavefront_stages(built));
  return out;
}

}  // namespace

uint64_t Plan::bytes() const {
  uint64_t all = 0;
  for (const auto& [name, bytes] : buffers) all += bytes;
  return all;
}

Plan plan_render(const Device& device, const Scene& scene, const World& world, const SceneDevice& on_device,
                 const Features& also) {
  RenderOptions options;
  options.aovs = true;
  const DeviceTraits& traits = device.traits();
  const Features needed = features_of(traits, world, scene.integrator, options);
  options.also = also;
  const Features built = features_of(traits, world, scene.integrator, options);
  Plan plan;
  const std::vector<Reason> why = explain(world, scene.integrator, needed);
  const std::vector<Reason> in_programs = explain(world, scene.integrator, built);
  for (size_t i = 0; i < why.size(); ++i) plan.features.push_back({why[i], in_programs[i].used});
  plan.dropped = world.dropped;
  plan.programs = programs(needed, built, on_device);
  plan.options = built.options() + on_device.options();
  plan.buffers = on_device.bytes();
  for (const MemoryNeed& need : memory_needs(world, built, pool_of(traits, scene.integrator, options), traits))
    if (need.name == "film" || need.name == "path state") plan.buffers[need.name] = need.bytes;
  for (const AccuracyOption& option : accuracy_options()) {
    const std::string level = option.at(scene);
    plan.accuracy.push_back({option.name, level, option.doc, price_class(option.name, level)});
  }
  return plan;
}

std::string plan_text(const Plan& plan) {
  std::string out = "simulated\n";
  for (const Plan::Feature& f : plan.features)
    if (f.used) out += fmt::format("  {:<20} {}\n", f.feature, f.because);
  out += "left out\n";
  for (const Plan::Feature& f : plan.features)
    if (!f.used) out += fmt::format("  {:<20} {}{}\n", f.feature, f.because, f.built ? " (but built in)" : "");
  if (!plan.dropped.empty()) out += "dropped, as it cannot matter\n";
  for (const Dropped& d : plan.dropped) out += fmt::format("  {}: {}\n", d.what, d.because);
  out += "programs (+ compiled and launched, o compiled only, - neither)\n";
  for (const Plan::Program& p : plan.programs)
    out += fmt::format("  {} {:<27} {}\n", p.launched ? "+" : p.built ? "o" : "-", p.file, p.because);
  out += fmt::format("kernel options\n  {}\naccuracy (see `wale cost`)\n", plan.options);
  for (const Plan::Accuracy& a : plan.accuracy)
    out += fmt::format("  {:<16} {:<12} {}\n", a.option, a.level,
                       a.price.times > 0 ? fmt::format("{}: {:.2f} times the cheapest level's time ({})", a.price.name,
                                                       a.price.times, a.price.source)
                                         : a.price.name);
  out += "buffers\n";
  for (const auto& [name, bytes] : plan.buffers) out += fmt::format("  {:<20} {:>14} bytes\n", name, bytes);
  return out + fmt::format("  {:<20} {:>14} bytes\n", "all", plan.bytes());
}

std::string plan_json(const Plan& plan) {
  Json json{{"features", Json::array()}, {"dropped", Json::array()},  {"programs", Json::array()},
            {"options", plan.options},   {"accuracy", Json::array()}, {"buffers", plan.buffers},
            {"bytes", plan.bytes()}};
  for (const Plan::Feature& f : plan.features)
    json["features"].push_back({{"feature", f.feature}, {"used", f.used}, {"built", f.built}, {"because", f.because}});
  for (const Dropped& d : plan.dropped) json["dropped"].push_back({{"what", d.what}, {"because", d.because}});
  for (const Plan::Program& p : plan.programs)
    json["programs"].push_back({{"file", p.file},
                                {"kernels", p.kernels},
                                {"used", p.built},
                                {"launched", p.launched},
                                {"because", p.because}});
  for (const Plan::Accuracy& a : plan.accuracy) {
    Json row{{"option", a.option}, {"level", a.level}, {"price", a.price.name}, {"about", a.doc}};
    for (const AccuracyLevel& level : accuracy_option(a.option).levels)
      row["levels"].push_back({{"level", level.name}, {"set", level.overrides}});
    if (a.price.times > 0) row["times_cheapest"] = a.price.times, row["source"] = a.price.source;
    json["accuracy"].push_back(row);
  }
  return json.dump(2) + "\n";
}

}  // namespace wale
