#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/cost/bias.h"
#include "host/cost/levels.h"
#include "host/cost/measured_scene.h"
#include "host/image.h"

namespace wale::cost {

/// A figure over repetitions.
struct Spread {
  double middle = 0, low = 0, high = 0;  ///< median, least and largest
};
/// Of at least one value.
Spread spread_of(std::vector<double> values);

/// Mean FLIP of two pictures of one size (host/flip.h), clipped at 1 after `exposure` stops.
double flip_of(const Picture& a, const Picture& b, double exposure);

/// What one unit was found to cost and to change.
struct UnitResult {
  std::string left_out;  ///< why nothing of it was measured, or only its start
  int repetitions = 0, samples = 0;
  Spread wall_ns, cpu_ns;       ///< per path
  Spread time;                  ///< per path, over the base's in the same round
  Spread equal_noise;           ///< time to equal noise, over the base's in the same round
  double variance = 0;          ///< of one sample, relative: weighed as the bias
  Bias bias;                    ///< against the reference
  Bias change;                  ///< against the scene as it is: what the option alone does
  double flip = 0;              ///< mean picture against the reference's
  std::optional<double> radii;  ///< largest geometric error; none where the option does not change geometry
  StartPrice start;
  Picture mean;  ///< empty where nothing was measured
};

struct CostReport {
  std::string scene, command, date, device, driver;
  std::string time_kind;  ///< "CPU" or "wall": what times of a path and ratios are of
  Levels levels;
  std::vector<UnitResult> results;  ///< per unit
  std::string reference_text;       ///< what all are compared with, in words
  bool reference_made = true;       ///< here; else it was given
  std::string base_settings;        ///< of the scene, per accuracy option
  Picture reference;                ///< its mean
  double reference_noise = 0;       ///< root of its relative variance
  double reference_flip = 0;        ///< between its two halves: what noise alone gives
  double minutes = 0, seconds_used = 0;
  std::string ended;  ///< why it ended before its plan was done; empty: it did not
  double exposure = 0;
  std::string view;

  const UnitResult* result(const Level& row) const;
  const UnitResult& base() const { return results.front(); }
  bool is_reference(const Level& row) const { return reference_made && row.unit && *row.unit == levels.reference; }
};

/// "0.41", "0.012", "3.4e-05": three digits.
std::string figure(double value);
/// A bias as a relative root mean square with its interval, or that noise hides it, in words.
std::string bias_words(const Bias& bias);
/// That of a row against the reference, and against the scene as it is.
std::string bias_of(const CostReport& report, const Level& row);
std::string change_of(const CostReport& report, const Level& row);
/// Its largest geometric error; nothing where its option does not change geometry.
std::optional<double> radii_of(const CostReport& report, const Level& row);

std::string report_text(const CostReport& report);
std::string report_csv(const CostReport& report);
nlohmann::ordered_json report_json(const CostReport& report);
/// A page that needs nothing else: pictures and the plot (SVG) are in it.
std::string report_html(const CostReport& report, const std::string& plot_svg);

}  // namespace wale::cost
