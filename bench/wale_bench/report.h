#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/wale_bench/score.h"

namespace wale::bench {

/// Everything that one run measured.
struct BenchReport {
  DeviceTraits device;
  DeviceRates rates;
  int repeats = 0;
  std::vector<FabricResult> fabrics;
  std::optional<Score> score;  ///< of the frozen workload, the first of the fabrics

  bool verified() const;
  /// The first thing that did not verify, as one line.
  std::string failure() const;
};

/// Version of the JSON and CSV below.
inline constexpr const char* kSchema = "wale-bench report 1";

/// Speeds that did not verify are null.
nlohmann::ordered_json report_json(const BenchReport& report);
/// One line for each row of rays.
std::string report_csv(const BenchReport& report);
std::string report_text(const BenchReport& report);

}  // namespace wale::bench
