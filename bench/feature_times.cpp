// Times the features of VGG16: how long one picture of a fit takes.
//
//     build/bench/feature_times WEIGHTS [RUNS]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "geom/error.h"
#include "host/fit/vgg16.h"

namespace {

// Least of `runs` in milliseconds: other programs only ever add to it.
double milliseconds(const wale::fit::Vgg16& network, const wale::fit::Picture& picture, const std::string& layer,
                    int runs) {
  double least = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    network.features(picture, {layer});
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    least = std::min(least, time.count());
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) wale::user_error("usage: feature_times WEIGHTS [RUNS]");
  const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 15;
  const auto network = wale::fit::read_vgg16(argv[1]);
  fmt::print("{}; {} hardware threads; least of {} runs\n\n| picture |", network->text(),
             std::thread::hardware_concurrency(), runs);
  for (const std::string& layer : network->layers()) fmt::print(" to {} |", layer);
  fmt::print("\n|---|");
  for (size_t i = 0; i < network->layers().size(); ++i) fmt::print("---|");
  fmt::print("\n");
  for (const int size : {102, 512}) {
    const wale::fit::Picture picture(size, size);
    fmt::print("| {} x {} |", size, size);
    for (const std::string& layer : network->layers())
      fmt::print(" {:.0f} ms |", milliseconds(*network, picture, layer, runs));
    fmt::print("\n");
  }
  return 0;
} catch (const wale::Error& error) {
  fmt::print(stderr, "feature_times: {}\n", error.what());
  return int(error.fault());
}
