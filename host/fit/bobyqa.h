#pragma once
#include <functional>
#include <span>
#include <vector>

namespace wale::fit {

struct BobyqaResult {
  std::vector<double> x;
  double loss = 0;
  int evaluations = 0;
  bool converged = false;  ///< else the evaluations were used up, or it was stopped
};

/// Least value of a function over the unit box from its values alone: BOBYQA (Powell 2009) of NLopt, first steps of
/// 0.1, until steps are below `least_step`.
BobyqaResult bobyqa(const std::function<double(std::span<const double>)>& f, std::span<const double> start,
                    int evaluations, double least_step, const std::function<bool()>& stop);

}  // namespace wale::fit
