#pragma once
#include <string>

namespace wale {

/// What a level of an accuracy option costs, by committed measurements.
struct PriceClass {
  std::string name;    ///< cheap, moderate, dear; "not measured" where there is no figure
  double times = 0;    ///< time per sample over that of the cheapest level of its option; 0: not measured
  std::string source;  ///< file of the measurement, from the root of the repository
};

/// cheap: below 1.1 times the time of the option's cheapest level; dear: from 2 times on.
PriceClass price_class(const std::string& option, const std::string& level);

}  // namespace wale
