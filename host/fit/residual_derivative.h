#pragma once
#include <functional>
#include <vector>

#include "host/fit/lit_pair.h"
#include "host/fit/parameter.h"

namespace wale::fit {

/// Values that are compared with the photographs', weighed and flattened: their squares add up to the loss.
using PairResiduals = std::function<std::vector<double>(const PicturePair&)>;

/// Derivative of the residuals by a parameter's place, from that of the pictures; empty where paths do not gather it.
std::vector<double> residual_derivative(const PairResiduals& residuals, const LitPair::WithGradients& rendered,
                                        const FitParameter& parameter, double place);

}  // namespace wale::fit
