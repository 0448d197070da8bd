#pragma once
#include <functional>
#include <optional>

#include "host/cost/measured_scene.h"
#include "host/cost/ply_surface_distance.h"
#include "host/cost/report.h"
#include "host/cost/schedule.h"

namespace wale::cost {

/// A picture that was rendered before, in place of one made here.
struct GivenReference {
  std::string file;
  Picture picture;
  std::vector<float> variance;  ///< of each value
  std::string accuracy;         ///< settings of accuracy that it was rendered with
  double samples = 0;
};

/// Measures levels against each other within a time.
class Experiment {
 public:
  using Tell = std::function<void(const std::string& step, double fraction)>;

  /// `clock` began with the command, `seconds` is when it is to have ended.
  Experiment(const Device& device, const Loaders& loaders, Levels levels, std::optional<GivenReference> given,
             double seconds, Clock clock, std::filesystem::path kernel_dir);

  /// Renders every unit once, shortly: its start, its geometric error, its price. Those that have no room or would take
  /// too long are left out.
  void survey(const Tell& tell);
  /// Repeats all of them as often as the time allows. Throws a user error where it is too short for anything.
  void measure(const Tell& tell);
  /// What was found; what a report says of scene and command is left to the caller.
  CostReport report();

 private:
  struct Measured {
    UnitPrice price;
    std::vector<Repetition> repetitions;
    UnitResult result;
  };
  void keep_storage(Scene& scene);
  std::string other_stitches(const Prepared& geometry);
  bool survey_unit(size_t u);
  std::string too_large(const Unit& unit) const;
  void measure_geometry(size_t u);
  bool needed(size_t u) const { return u == 0 || (u == levels_.reference && !given_); }
  double left() const { return seconds_ - clock_(); }
  void leave_out(size_t u, std::string why);
  void cannot_render(size_t u, const std::string& why);
  void analyse(size_t u, const std::vector<double>& weights, const std::vector<Picture>& reference, CostReport& out);

  const Device& device_;
  const Loaders& loaders_;
  Levels levels_;
  std::optional<GivenReference> given_;
  double seconds_;
  Clock clock_;
  MeasuredScenes scenes_;
  std::vector<Measured> measured_;
  std::optional<PlySurface> surface_;
  std::string ended_, reference_note_;
};

}  // namespace wale::cost
