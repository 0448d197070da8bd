// Rendering to an error goal: what is reached, its bias, and what it saves over equal samples everywhere
// (bench/results/adaptive.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <ctime>

#include "geom/error.h"
#include "host/error_goal.h"
#include "tests/image/actual_error.h"
#include "tests/image/picture.h"

namespace wale {
namespace {

using test::ActualError;

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

// One scene and its pictures, with the processor time that each takes.
class Bench {
 public:
  Bench(const std::string& file, int size, const std::vector<std::string>& set)
      : studio_(test::device(), [&] {
          Scene scene = read_scene(file, set);
          scene.film.width = scene.film.height = size;
          return scene;
        }()) {}

  struct Taken {
    Rendered rendered;
    double cpu = 0;
  };
  Taken take(double error, int spp, unsigned seed) const {
    RenderOptions options;
    options.error = error;
    options.spp = spp;
    double start = 0;
    options.ready = [&] { start = cpu_seconds(); };  // programs are compiled
    Taken taken{studio_.take(options, seed), 0};
    taken.cpu = cpu_seconds() - start;
    return taken;
  }

 private:
  test::Studio studio_;
};

struct Arguments {
  std::vector<std::string> scenes, set;
  int size = 128, limit = 65536, reference = 1024, seeds = 64;
  double error = 0.05;
};

std::string name_of(const std::string& file) { return std::filesystem::path(file).stem().string(); }

// Actual error beside the goal.
void goal(const Arguments& args) {
  fmt::print(
      "| scene | actual, all tiles | actual, sampled tiles | worst tile | estimated: worst, median | missed | "
      "samples: least, mean, most | CPU s |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& file : args.scenes) {
    const Bench bench(file, args.size, args.set);
    const auto taken = bench.take(args.error, args.limit, 1);
    const Image a = bench.take(0, args.reference, 1001).rendered.image;
    const Image b = bench.take(0, args.reference, 1002).rendered.image;
    const Reached& r = taken.rendered.reached;
    const auto squared = test::actual_tile_errors(taken.rendered.image, a, b, r.floor);
    // Tiles that the first checkpoint found below the goal say nothing of when tiles stop.
    std::vector<double> sampled;
    const int columns = (args.size + 7) / 8;
    for (size_t t = 0; t < squared.size(); ++t)
      if (taken.rendered.image.at(int(t) % columns * 8, int(t) / columns * 8)[6] > next_checkpoint(0, 65536))
        sampled.push_back(squared[t]);
    const ActualError all = test::summary(squared), some = sampled.empty() ? ActualError{} : test::summary(sampled);
    fmt::print("| {} | {:.4f} | {:.4f} ({}) | {:.4f} | {:.4f}, {:.4f} | {} of {} | {}, {:.0f}, {} | {:.1f} |\n",
               name_of(file), all.rms, some.rms, sampled.size(), all.worst, r.worst, r.median, r.missed, r.tiles,
               r.least, r.mean, r.most, taken.cpu);
    std::fflush(stdout);
  }
}

// Mean over many seeds against equal samples everywhere.
void bias(const Arguments& args) {
  fmt::print(
      "| scene | goal | seeds | mean samples | bias of the picture | its standard error | largest of a tile, in "
      "standard errors | expected by chance |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& file : args.scenes) {
    const Bench bench(file, args.size, args.set);
    const int columns = (args.size + 7) / 8;
    const size_t tiles = size_t(columns * columns);
    std::vector<double> sum(tiles), square(tiles);
    double all = 0, all_square = 0, samples = 0;
    const auto tile_means = [&](const Image& image) {
      std::vector<double> means(tiles);
      for (int y = 0; y < args.size; ++y)
        for (int x = 0; x < args.size; ++x) {
          const float* v = image.at(x, y);
          means[size_t(y / 8 * columns + x / 8)] += (0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]) / 64;
        }
      return means;
    };
    // Pairs: an adaptive picture and one of as many samples everywhere, of another seed.
    double whole = 0;
    for (int seed = 0; seed < args.seeds; ++seed) {
      const Rendered r = bench.take(args.error, args.limit, unsigned(seed)).rendered;
      samples += r.reached.mean / args.seeds;
      const Image same = bench.take(0, int(std::lround(r.reached.mean / 8)) * 8, unsigned(seed + 5000)).rendered.image;
      const auto x = tile_means(r.image), y = tile_means(same);
      double picture = 0;
      for (size_t t = 0; t < tiles; ++t) {
        sum[t] += x[t] - y[t];
        square[t] += (x[t] - y[t]) * (x[t] - y[t]);
        picture += x[t] - y[t];
        whole += y[t] / args.seeds;
      }
      all += picture;
      all_square += picture * picture;
    }
    const double n = args.seeds;
    double worst = 0;
    for (size_t t = 0; t < tiles; ++t) {
      const double mean = sum[t] / n, variance = (square[t] / n - mean * mean) / (n - 1);
      if (variance > 0) worst = std::max(worst, std::abs(mean) / std::sqrt(variance));
    }
    const double mean = all / n;
    fmt::print("| {} | {:g} | {} | {:.0f} | {:+.3f} % | {:.3f} % | {:.1f} of {} tiles | {:.1f} |\n", name_of(file),
               args.error, args.seeds, samples, 100 * mean / whole,
               100 * std::sqrt((all_square / n - mean * mean) / (n - 1)) / whole, worst, tiles,
               std::sqrt(2 * std::log(double(tiles))));
    std::fflush(stdout);
  }
}

// The least equal samples whose worst tile is as good.
void sooner(const Arguments& args) {
  fmt::print(
      "| scene | goal | adaptive: mean samples, CPU s, worst tile | equal: samples, CPU s, worst tile | samples | "
      "CPU time |\n|---|---|---|---|---|---|\n");
  for (const auto& file : args.scenes) {
    const Bench bench(file, args.size, args.set);
    bench.take(0, 8, 7);  // first launches
    const auto adaptive = bench.take(args.error, args.limit, 1);
    const Reached& r = adaptive.rendered.reached;
    // Upwards from what the adaptive picture took on average, in the steps of its own checkpoints.
    for (uint32_t spp = next_checkpoint(uint32_t(r.mean), 1u << 24);; spp = next_checkpoint(spp, 1u << 24)) {
      const auto equal = bench.take(0, int(spp), 1);
      const Reached& e = equal.rendered.reached;
      fmt::print("| {} | {:g} | {:.0f}, {:.1f}, {:.4f} | {}, {:.1f}, {:.4f} | {:.2f} x | {:.2f} x |{}\n", name_of(file),
                 args.error, r.mean, adaptive.cpu, r.worst, spp, equal.cpu, e.worst, spp / r.mean,
                 equal.cpu / adaptive.cpu, e.worst > args.error ? " not yet" : "");
      std::fflush(stdout);
      if (e.worst <= args.error || spp >= uint32_t(args.limit)) break;
    }
  }
}

int run(int argc, char** argv) {
  CLI::App app{"Rendering to an error goal"};
  app.require_subcommand(1);
  Arguments args;
  const auto command = [&](const char* name, const char* what, void (*run_it)(const Arguments&)) {
    auto* c = app.add_subcommand(name, what);
    c->add_option("SCENES", args.scenes)->required();
    c->add_option("--set", args.set)->allow_extra_args(false);
    c->add_option("--size", args.size, "pixels a side");
    c->add_option("--error", args.error);
    c->add_option("--limit", args.limit, "most samples per pixel");
    c->add_option("--reference", args.reference, "samples per pixel of each reference");
    c->add_option("--seeds", args.seeds);
    c->callback([&args, run_it] { run_it(args); });
  };
  command("goal", "actual error beside the goal", goal);
  command("bias", "mean over many seeds", bias);
  command("sooner", "against equal samples everywhere", sooner);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

}  // namespace
}  // namespace wale

int main(int argc, char** argv) {
  try {
    return wale::run(argc, argv);
  } catch (const wale::Error& e) {
    fmt::print(stderr, "adaptive_bench: {}\n", e.what());
    return 1;
  }
}
