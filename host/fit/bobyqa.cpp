#include "host/fit/bobyqa.h"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <memory>

#include "geom/error.h"

namespace wale::fit {
namespace {

struct Call {
  const std::function<double(std::span<const double>)>& f;
  const std::function<bool()>& stop;
  nlopt_opt optimiser;
  std::exception_ptr failed{};
};

// C code cannot be unwound: what is thrown waits until NLopt has returned.
double evaluate(unsigned n, const double* x, double*, void* data) {
  Call& call = *static_cast<Call*>(data);
  if (call.stop()) {
    nlopt_force_stop(call.optimiser);
    return HUGE_VAL;
  }
  try {
    return call.f(std::span(x, n));
  } catch (...) {
    call.failed = std::current_exception();
    nlopt_force_stop(call.optimiser);
    return 0;
  }
}

}  // namespace

BobyqaResult bobyqa(const std::function<double(std::span<const double>)>& f, std::span<const double> start,
                    int evaluations, double least_step, const std::function<bool()>& stop) {
  const auto n = unsigned(start.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LN_BOBYQA, n), nlopt_destroy);
  if (!optimiser) bug("NLopt: no BOBYQA for {} axes", n);
  Call call{f, stop, optimiser.get()};
  nlopt_set_min_objective(optimiser.get(), evaluate, &call);
  nlopt_set_lower_bounds1(optimiser.get(), 0);
  nlopt_set_upper_bounds1(optimiser.get(), 1);
  nlopt_set_initial_step1(optimiser.get(), 0.1);
  nlopt_set_xtol_abs1(optimiser.get(), least_step);
  nlopt_set_maxeval(optimiser.get(), evaluations);
  BobyqaResult out;
  out.x.assign(start.begin(), start.end());
  const nlopt_result ended = nlopt_optimize(optimiser.get(), out.x.data(), &out.loss);
  if (call.failed) std::rethrow_exception(call.failed);
  out.evaluations = nlopt_get_numevals(optimiser.get());
  // Rounding ends it where the model has become as fine as the numbers.
  out.converged = ended == NLOPT_XTOL_REACHED || ended == NLOPT_FTOL_REACHED || ended == NLOPT_ROUNDOFF_LIMITED;
  if (ended == NLOPT_INVALID_ARGS || ended == NLOPT_OUT_OF_MEMORY) bug("NLopt: BOBYQA ended with {}", int(ended));
  return out;
}

}  // namespace wale::fit
