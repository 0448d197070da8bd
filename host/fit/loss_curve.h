#pragma once
#include <string>

#include "host/fit/fit.h"

namespace wale::fit {

/// Loss over the pairs of renders, both axes from the journal, the loss's logarithmic: a line for the least so far and
/// a dot for each pair, a colour per start. SVG.
std::string loss_curve_svg(const FitJournal& journal);

}  // namespace wale::fit
