#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/fit/least_squares.h"
#include "host/fit/lit_pair.h"
#include "host/fit/parameter.h"
#include "host/fit/polish.h"
#include "host/fit/residual_derivative.h"

namespace wale::fit {

/// How the loss is brought down.
enum class FitMethod {
  paths,        ///< least squares, derivatives gathered along the paths of the pictures, differences for the others
  differences,  ///< least squares, derivatives by rendering once more per parameter
  bobyqa,       ///< NLopt's BOBYQA (Powell 2009): derivative-free, from the loss alone
};

struct FitSettings {
  std::vector<FitParameter> parameters;
  FitTarget target;
  FitMethod method = FitMethod::paths;
  int starts = 3;            ///< places that are descended from
  int samples = 32;          ///< paths a pixel, half of them for each of two independent renders
  int final_samples = 1024;  ///< of all rounds that the best end of a descent is polished by
  int evaluations = 150;     ///< pairs of pictures for one start, at most
  double seconds = 0;        ///< > 0: descents end then, converged or not
  uint32_t seed = 1;
  std::vector<int> cells;  ///< of each residual: see Rounds
};

/// One descent.
struct FitStart {
  std::vector<double> from, to;  ///< places
  double first_loss = 0, loss = 0;
  int evaluations = 0;
  bool converged = false;
};

/// One pair of pictures that was rendered on the way.
struct FitStep {
  int start = -1;  ///< which descent; -1: looking for starts; after the last start: polishing the best of them
  double seconds = 0;
  double loss = 0;
  std::vector<double> places;
};

/// What a fit knows so far; a fit can go on from it.
struct FitJournal {
  std::vector<FitStart> finished;
  std::vector<std::vector<double>> chosen;  ///< where descents begin; empty: not yet looked for
  std::vector<FitStep> steps;
  double seconds = 0;  ///< that earlier runs took
};

struct FittedParameter {
  double value = 0, start = 0;      ///< in the group's unit
  std::optional<double> low, high;  ///< two standard deviations to either side, within the bounds (Rounds::solve)
  bool determined = false;          ///< that range is less than half of the bounds'
  bool at_bound = false;
  bool assessed = true;  ///< there were parts of the photographs enough to tell a range; without, none is claimed
};

struct FitResult {
  FitStart best;
  std::vector<FittedParameter> parameters;
  bool out_of_time = false;                      ///< a descent or polishing was cut short
  bool polished = false;                         ///< polishing came to rest
  std::vector<std::pair<size_t, size_t>> alike;  ///< parameters whose errors go together (correlation above 0.95)
  double render_noise = 0;  ///< squares that noise adds to the pictures' residuals; not in the loss
  PicturePair pictures;
  Scene scene;  ///< with the fitted material
};

struct FitProgress {
  const FitJournal* journal = nullptr;
  const PicturePair* pictures = nullptr;  ///< of the last step
  bool better = false;                    ///< than all before
};

/// Fits a scene's material. The loss is the sum of products of the residuals of two independent renders: squares of one
/// would hold its noise, which some materials make more of than others. Deterministic: every pair is rendered with the
/// same paths as far as the material lets them, so that the loss is smooth. Stops early, with nothing returned, when
/// `stop` says so; the journal then lets another run go on.
class Fit {
 public:
  Fit(const Scene& scene, LitPair& renderer, PairResiduals residuals, FitSettings settings);

  std::optional<FitResult> run(FitJournal& journal, const std::function<bool()>& stop,
                               const std::function<void(const FitProgress&)>& progress);

 private:
  std::optional<FitResult> whole_run(FitJournal& journal, const std::function<bool()>& stop,
                                     const std::function<void(const FitProgress&)>& progress);
  /// Of two replicates, the first by that seed, the second by the next.
  Residuals evaluate(std::span<const double> places, int samples, bool derivatives, uint32_t first_seed);
  uint32_t descent_seed() const { return 2 * settings_.seed; }
  void add(PicturePair& mean, const PicturePair& half, std::vector<double>& residuals) const;
  std::vector<std::vector<double>> look_for_starts(FitJournal& journal);
  FitStart descend(FitJournal& journal, int number, const std::vector<double>& from);
  Replicate round(std::span<const double> places, int samples, uint32_t number);
  FitResult judge(const FitStart& best, const Polished& polished);
  /// From all starts that are wanted.
  bool all_converged(const FitJournal& journal) const;
  const FitStart& best_of(const FitJournal& journal) const;
  void keep(FitJournal& journal, int start, std::span<const double> places, double loss);

  const Scene& scene_;
  LitPair& renderer_;
  PairResiduals residuals_;
  FitSettings settings_;
  PicturePair pictures_;
  double best_loss_ = INFINITY;
  int best_start_ = -1;
  double begun_ = 0;
  bool out_of_time(double share) const;
  std::function<bool()> stop_;
  std::function<void(const FitProgress&)> progress_;
};

}  // namespace wale::fit
