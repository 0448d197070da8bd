#include "host/cost/command.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/cost/drawing.h"
#include "host/cost/experiment.h"
#include "host/cost/pareto.h"
#include "host/film.h"
#include "host/image_coder.h"
#include "host/loaded_library.h"
#include "host/progress.h"
#include "host/scene_identity.h"
#include "host/stop.h"

namespace wale {
namespace {

using namespace cost;
namespace fs = std::filesystem;

constexpr double kPixelsPerPoint = 2;

Clock started_now() {
  const auto begin = std::chrono::steady_clock::now();
  return [begin] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
}

// Whatever would keep the report from being written is found before the long work; nothing is made yet.
void require_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    user_error("-o {}: this is a file; give a folder", folder.string());
  require_writable_path(fs::exists(folder, error) ? folder / "cost.json" : folder);
  require_image_coder();
  require_library(kPainterLibrary);
}

float value_of(const Image& image, size_t pixel, const std::string& channel, const fs::path& file) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), channel);
  if (found == image.channels.end())
    user_error("--reference {}: has no channel {}; give an .exr of `wale render`", file.string(), channel);
  return image.pixels[pixel * image.channels.size() + size_t(found - image.channels.begin())];
}

GivenReference read_reference(const CostArgs& args) {
  const fs::path& file = args.reference;
  const Image image = read_image(file, true);
  const auto shows = image.attributes.find(kSceneAttribute);
  if (shows == image.attributes.end())
    user_error("--reference {}: does not say which scene it shows; give an .exr of `wale render {}`", file.string(),
               args.scene.string());
  if (const std::string wanted = scene_identity(args.scene, args.set); shows->second != wanted)
    user_error("--reference {}: shows another scene ({}) than {} with its --set ({}); render it with `wale render {}`",
               file.string(), shows->second, args.scene.string(), wanted, args.scene.string());
  GivenReference out;
  out.file = file.string();
  const size_t pixels = size_t(image.width) * size_t(image.height);
  out.picture = {image.width, image.height, std::vector<float>(3 * pixels)};
  out.variance.resize(3 * pixels);
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) {
      const std::string name(1, "RGB"[c]);
      out.picture.rgb[3 * p + c] = value_of(image, p, name, file);
      out.variance[3 * p + c] = value_of(image, p, "variance." + name, file);
    }
    const double samples = value_of(image, p, "samples", file);
    if (samples < double(kScrambles))
      user_error("--reference {}: has {:g} samples in a pixel, whose noise nothing tells; at least {} are needed",
                 out.file, samples, kScrambles);
    out.samples += samples / double(pixels);
  }
  if (const auto found = image.attributes.find(kAccuracyAttribute); found != image.attributes.end())
    out.accuracy = found->second;
  return out;
}

PictureSize size_of(const CostArgs& args, const std::optional<GivenReference>& given) {
  FilmScene film;
  film.width = film.height = 0;
  if (!args.size.empty()) apply_size(args.size, film);
  if (!given) return {film.width, film.height};
  const Picture& picture = given->picture;
  if (!args.size.empty() && (film.width != picture.width || film.height != picture.height))
    user_error("--reference {}: is {} x {}, --size is {}", given->file, picture.width, picture.height, args.size);
  return {picture.width, picture.height};
}

// One point per picture that was rendered; it bears the name of the first level that asked for it.
std::vector<ParetoPoint> points_of(const CostReport& report) {
  std::vector<ParetoPoint> out;
  std::vector<std::string> options;
  std::vector<bool> seen(report.results.size(), false);
  const auto add = [&](const std::string& label, const std::string& option, size_t unit) {
    const UnitResult& r = report.results[unit];
    if (seen[unit] || !r.left_out.empty() || !(r.equal_noise.middle > 0)) return;
    seen[unit] = true;
    const bool reference = unit == report.levels.reference && report.reference_made;
    if (!reference && !r.bias.known()) return;
    const auto found = std::find(options.begin(), options.end(), option);
    const size_t group = size_t(found - options.begin());
    if (found == options.end()) options.push_back(option);
    const auto root = [](double v) { return v > 0 ? std::sqrt(v) : 0; };
    ParetoPoint p{label,
                  r.equal_noise.middle,
                  r.equal_noise.low,
                  r.equal_noise.high,
                  root(r.bias.relative_mse),
                  root(r.bias.low()),
                  root(r.bias.high()),
                  r.bias.resolved(),
                  group};
    if (!p.resolved) p.bias = root(r.bias.limit());
    out.push_back(p);
  };
  add("the scene", "the scene", 0);
  for (const Level& row : report.levels.rows)
    if (row.unit)
      add(report.is_reference(row) ? "reference"
          : row.option == "preset" ? row.level
                                   : row.option + " " + row.level,
          row.option, *row.unit);
  return out;
}

void write_report(const CostReport& report, const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) user_error("-o {}: cannot be made: {}", folder.string(), error.message());
  write_text_file(folder / "cost.csv", report_csv(report));
  write_text_file(folder / "cost.json",
                  report_json(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  const Drawing chart = pareto_chart(points_of(report), fmt::format("What accuracy costs: {}", report.scene));
  std::string svg, png;
  if (const std::string failure = drawing_painter().svg(chart, svg); !failure.empty()) bug("pareto.svg: {}", failure);
  if (const std::string failure = drawing_painter().png(chart, kPixelsPerPoint, png); !failure.empty())
    bug("pareto.png: {}", failure);
  write_text_file(folder / "pareto.svg", svg);
  write_text_file(folder / "pareto.png", png);
  write_text_file(folder / "index.html", report_html(report, svg));
}

}  // namespace

int run_cost(const CostArgs& args, const Loaders& loaders) {
  const Clock clock = started_now();
  const WantedOptions wanted = wanted_options(args.options);
  std::optional<GivenReference> given;
  if (!args.reference.empty()) given = read_reference(args);
  Levels levels = collect_levels(args.scene, overrides_of(args), wanted, size_of(args, given));
  require_folder(args.output);
  const Device device = Device::open(one_device_number(args.device));
  catch_stop_signals();
  const double seconds = 60 * args.minutes;
  Experiment experiment(device, loaders, std::move(levels), std::move(given), seconds, clock, args.kernel_dir);
  {
    Progress bar("first pass", args.quiet);
    experiment.survey([&](const std::string& unit, double done) { bar.update(done, unit); });
    bar.finish();
  }
  {
    Progress bar("measure", args.quiet);
    experiment.measure([&](const std::string& unit, double done) { bar.update(done, unit); });
    bar.finish();
  }
  CostReport report = experiment.report();
  report.scene = args.scene.string();
  report.command = args.command;
  report.date = fmt::format("{:%d %B %Y}", fmt::localtime(std::time(nullptr)));
  report.minutes = args.minutes;
  report.seconds_used = clock();
  write_report(report, args.output);
  fmt::print("{}written    {}\n", report_text(report), (args.output / "index.html").string());
  return 0;
}

}  // namespace wale
