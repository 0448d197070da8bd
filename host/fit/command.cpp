#include "host/fit/command.h"

#include <fmt/format.h>

#include <cmath>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/device.h"
#include "host/fit/journal_file.h"
#include "host/fit/loss_words.h"
#include "host/fit/material_json.h"
#include "host/fit/report.h"
#include "host/fit/task.h"
#include "host/progress.h"
#include "host/stop.h"

namespace wale {
namespace {

using namespace wale::fit;

constexpr double kNoisy = 10;  // times the loss

// What is read must not be written over, nor one output over another.
void require_outputs(const FitArgs& args) {
  using Named = std::pair<const char*, std::filesystem::path>;
  const Named inputs[] = {
      {"SCENE", args.scene}, {"--front", args.front}, {"--back", args.back}, {"--weights", args.weights}};
  const Named outputs[] = {{"-o", args.output}, {"--report", args.report}, {"--progress", args.progress}};
  const auto require_other = [](const Named& output, const Named& other) {
    std::error_code ignored;
    const auto path = std::filesystem::weakly_canonical(output.second, ignored);
    if (path == std::filesystem::weakly_canonical(other.second, ignored))
      user_error("{}: {} is that of {} too; give another", output.first, output.second.string(), other.first);
  };
  for (size_t i = 0; i < std::size(outputs); ++i) {
    if (outputs[i].second.empty()) continue;
    for (const Named& input : inputs)
      if (!input.second.empty()) require_other(outputs[i], input);
    for (size_t j = 0; j < i; ++j)
      if (!outputs[j].second.empty()) require_other(outputs[i], outputs[j]);
  }
  for (const auto& file : {args.output, args.report})
    if (!file.empty()) require_writable_path(file);
  if (!args.progress.empty()) require_writable(args.progress);
}

std::string progress_note(const FitJournal& journal, size_t starts) {
  double best = INFINITY;
  for (const FitStep& s : journal.steps)
    if (s.start >= 0) best = std::min(best, s.loss);
  const int start = journal.steps.empty() ? -1 : journal.steps.back().start;
  const std::string where = start < 0             ? "looking for starts"
                            : start < int(starts) ? fmt::format("start {} of {}", start + 1, starts)
                                                  : "polishing the best";
  return fmt::format("{}, {} pairs{}", where, journal.steps.size(),
                     std::isfinite(best) ? fmt::format(", loss {:.4g}", best) : "");
}

void warn(const std::vector<std::string>& warnings, bool quiet) {
  if (quiet) return;
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

// What makes the result less than it seems.
std::vector<std::string> doubts_of(const FitSettings& settings, const FitResult& result) {
  std::vector<std::string> doubts = parameter_warnings(settings, result);
  if (result.render_noise > kNoisy * std::abs(result.best.loss))
    doubts.push_back(
        fmt::format("the renders' noise ({:.2g}) is far above the loss ({:.2g}), which may be a chance of it: "
                    "--final-spp {} has half",
                    result.render_noise, result.best.loss, 2 * settings.final_samples));
  return doubts;
}

void print_result(const FitSettings& settings, const FitJournal& journal, const FitResult& result) {
  for (size_t k = 0; k < result.parameters.size(); ++k)
    fmt::print("{}\n", parameter_line(settings.parameters[k], result.parameters[k]));
  fmt::print("loss {:.4g}; squares that noise of the renders adds, taken off: {:.2g}; {} pairs of renders in {}\n",
             result.best.loss, result.render_noise, journal.steps.size(), duration_text(journal.seconds));
}

[[noreturn]] void not_converged(const FitArgs& args, const FitJournal& journal, const FitResult& result) {
  user_error("{}: the fit had not converged after {} pairs of renders, loss {:.4g}; no material was written; {}",
             args.output.string(), journal.steps.size(), result.best.loss,
             result.polished
                 ? fmt::format("--evaluations {} goes on from there", 2 * args.evaluations)
                 : fmt::format("polishing went on moving: --final-spp {} may settle it", 4 * args.final_samples));
}

}  // namespace

int run_fit(const FitArgs& args, const Loaders& loaders) {
  require_outputs(args);
  FitTask task = read_task(args);
  const NamedLoss loss(args, task.photographs, task.warnings);
  task.settings.cells = loss.cells();
  warn(task.warnings, args.quiet);

  const FitSettings& settings = task.settings;
  const std::string identity = identity_of(args, task);
  const std::filesystem::path journal_path = args.output.string() + ".fit";
  FitJournal journal;
  if (!args.redo)
    if (auto before = read_journal(journal_path, identity, settings.parameters.size())) {
      journal = std::move(*before);
      if (!args.quiet) fmt::print(stderr, "note: goes on after {} pairs of renders\n", journal.steps.size());
    }

  const Device device = Device::open(one_device_number(args.device));
  LitPair renderer(device, loaders, args.kernel_dir, task.sides);
  Fit fit(
      task.scene, renderer, [&](const PicturePair& pair) { return loss.residuals(pair); }, settings);
  catch_stop_signals();
  Progress bar("fit", args.quiet);
  double written = 0;
  const auto result = fit.run(journal, stop_requested, [&](const FitProgress& p) {
    // About as many pairs as an ordinary fit takes: nobody knows how many are left.
    const double expected = 12.0 * settings.starts + 4.0 * double(settings.parameters.size()) * settings.starts;
    bar.update(1 - std::exp(-double(journal.steps.size()) / expected), progress_note(journal, size_t(settings.starts)));
    if (p.better && !args.progress.empty())
      write_image(side_by_side(task.photographs, *p.pictures), args.progress, 0, "srgb");
    if (const double seconds = journal.steps.back().seconds; seconds > written + 5) {
      journal.seconds = written = seconds;
      write_journal(journal, identity, journal_path);
    }
  });
  if (!result) {
    write_journal(journal, identity, journal_path);
    bar.finish("stopped");
    fmt::print(stderr, "note: stopped after {} pairs of renders; the same command goes on from there\n",
               journal.steps.size());
    return 0;
  }
  bar.finish();

  const std::vector<std::string> doubts = doubts_of(settings, *result);
  warn(doubts, args.quiet);
  print_result(settings, journal, *result);
  if (!args.report.empty()) {
    FitReport report;
    report.scene = args.scene.string();
    report.command = args.command;
    report.device = device.traits().name;
    report.loss = loss.words();
    report.photographs = task.photographs;
    report.warnings = task.warnings;
    report.warnings.insert(report.warnings.end(), doubts.begin(), doubts.end());
    write_text_file(args.report, report_html(report, settings, journal, *result));
  }
  if (!result->best.converged && !result->out_of_time) {
    write_journal(journal, identity, journal_path);
    not_converged(args, journal, *result);
  }
  if (result->out_of_time && !args.quiet)
    fmt::print(stderr, "warning: --minutes {:g} were over before the fit had converged\n", args.minutes);
  write_text_file(args.output, material_json(result->scene, settings.target));
  if (const std::string more = other_settings(result->scene, settings.target, settings.parameters); !more.empty())
    fmt::print("beside the material:\n{}", more);
  std::error_code ignored;
  std::filesystem::remove(journal_path, ignored);
  return 0;
}

}  // namespace wale
