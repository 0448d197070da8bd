#include "host/price_class.h"

namespace wale {
namespace {

struct Figure {
  const char *option, *level;
  double times;
};

const Figure kFigures[] = {
#include "host/price_figures.inc"
    {"", "", 0}};

}  // namespace

PriceClass price_class(const std::string& option, const std::string& level) {
  for (const Figure& f : kFigures)
    if (f.times > 0 && f.option == option && f.level == level)
      return {f.times < 1.1 ? "cheap" : f.times < 2 ? "moderate" : "dear", f.times, "bench/results/prices.md"};
  return {"not measured", 0, ""};
}

}  // namespace wale
