// Throughput of a device, on a machine that has a driver and nothing else: links the OpenCL loader alone.
#include <cstdio>
#include <exception>

#include "bench/wale_bench/options.h"
#include "geom/error.h"
#include "host/device.h"

namespace {

// Scenes may use the bundled meshes and plain colours.
const wale::Loaders kNoFiles{
    [](const std::filesystem::path& file) -> wale::BaseMesh {
      wale::user_error("{}: wale_bench reads no mesh files; use `wale bench`, or a generated mesh", file.string());
    },
    [](const std::filesystem::path& file) -> wale::Image {
      wale::user_error("{}: wale_bench reads no images; use `wale bench`", file.string());
    }};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Throughput of an OpenCL device with Wale's kernels; without options, the score of wale-bench v1"};
  wale::bench::BenchArgs args;
  wale::bench::add_bench_options(app, args);
  try {
    app.parse(argc, argv);
    return wale::bench::run_bench(args, kNoFiles);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "wale_bench: %s (see `wale_bench --help`)\n", wale::one_line(e.what()).c_str());
    return 1;
  } catch (const wale::Error& e) {
    std::fprintf(stderr, "wale_bench: %s\n", e.what());
    return static_cast<int>(e.fault());
  } catch (const cl::Error& e) {
    std::fprintf(stderr, "wale_bench: OpenCL: %s failed with error %d\n", e.what(), e.err());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "wale_bench: out of memory; use fewer segments or rays\n");
    return 1;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "wale_bench: a bug: %s\n", e.what());
    return 3;
  }
}
