// What each level of the accuracy options costs per sample: bench/results/prices.md, whose figures `wale plan` quotes.
//   prices_bench SCENE [ROUNDS] [ROWS]
// writes the table, and to the file ROWS what host/price_class.cpp includes. Time: CPU seconds of all kernels, all
// threads, per sample; in every round the scene's levels one after the other, each over the scene as it is, rendered
// right before it; median over the rounds. Compiling, knitting and uploading are not counted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include "bench/wale_bench/clock.h"
#include "geom/base_mesh.h"
#include "geom/error.h"
#include "host/accuracy.h"
#include "host/image.h"
#include "host/render.h"

namespace {

using namespace wale;

constexpr int kSamples = 16, kSide = 64;

struct Subject {
  Scene scene;
  World world;
  SceneDevice on_device;
  Subject(const Device& device, Scene s)
      : scene(std::move(s)),
        world(build_world(
            scene, {[](const auto& f) { return read_mesh(f); }, [](const auto& f) { return read_image(f, true); }})),
        on_device(device, world) {}

  double seconds_per_sample(const Device& device) const {
    RenderOptions options;
    options.spp = kSamples;
    options.count_cpu_time = device.traits().cpu;
    const Rendered r = render(device, world, on_device, scene.integrator, options);
    double sum = 0;
    for (const auto& [kernel, stage] : r.counts.stages) sum += stage.seconds;
    return sum / double(r.counts.paths);
  }
};

std::unique_ptr<Subject> subject(const Device& device, const std::string& file, std::vector<std::string> overrides) {
  overrides.push_back(fmt::format("film.size=[{0},{0}]", kSide));
  return std::make_unique<Subject>(device, read_scene(file, overrides));
}

struct Row {
  std::string option, level, refused;
  std::unique_ptr<Subject> subject;
  std::vector<double> ratios;
};

std::vector<Row> rows_of(const Device& device, const std::string& file) {
  std::vector<Row> rows;
  for (const AccuracyOption& option : accuracy_options())
    for (const AccuracyLevel& level : option.levels) {
      Row& row = rows.emplace_back();
      row.option = option.name;
      row.level = level.name;
      try {
        row.subject = subject(device, file, level.overrides);
      } catch (const Error& e) {
        row.refused = e.what();
      }
    }
  return rows;
}

void measure(const Device& device, const Subject& base, std::vector<Row>& rows, int rounds) {
  for (int turn = 0; turn <= rounds; ++turn)
    for (Row& row : rows) {
      if (!row.subject) continue;
      const double as_it_is = base.seconds_per_sample(device), at_level = row.subject->seconds_per_sample(device);
      if (turn) row.ratios.push_back(at_level / as_it_is);  // the first round compiles
    }
}

double cheapest(const std::vector<Row>& rows, const std::string& option) {
  double least = INFINITY;
  for (const Row& row : rows)
    if (row.option == option && !row.ratios.empty()) least = std::min(least, bench::median(row.ratios));
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : "bench/specialised/2_lamp.json";
  const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
  const Device device = Device::open();
  const auto base = subject(device, file, {});
  std::vector<Row> rows = rows_of(device, file);
  measure(device, *base, rows, rounds);
  std::string figures;
  fmt::print("{}; {}, {} rounds.\n\n", device.traits().name, file, rounds);
  fmt::print("| option | level | times the option's cheapest | times the scene as it is | least and greatest |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    if (row.ratios.empty()) {
      fmt::print("| {} | {} | - | refused: {} | |\n", row.option, row.level, row.refused);
      continue;
    }
    const double times = bench::median(row.ratios), over = times / cheapest(rows, row.option);
    const auto [least, greatest] = std::minmax_element(row.ratios.begin(), row.ratios.end());
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.2f} to {:.2f} |\n", row.option, row.level, over, times, *least,
               *greatest);
    figures += fmt::format("{{\"{}\", \"{}\", {:.2f}}},\n", row.option, row.level, over);
  }
  if (argc > 3) std::ofstream(argv[3]) << "// Written by bench/prices.cpp; see bench/results/prices.md.\n" << figures;
  return 0;
}
