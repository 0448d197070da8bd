// Our goniometer beside the published one, bundle by bundle.
#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bench/goniometer/commands.h"
#include "bench/goniometer/measure.h"
#include "bench/goniometer/published.h"

namespace wale {

void print_table(const Options& options) {
  constexpr double kToDegrees = 180 / std::numbers::pi;
  const auto start = std::chrono::steady_clock::now();
  fmt::print(
      "| bundle | | T0 | R1 | M (RGB) | forward | sd(th) | events | misses |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const PublishedBundle& p : published_bundles()) {
    const Measurement m = measure(
        p.recipe, p.fibre, Incidence{.paths = options.paths, .seed = options.seed, .sections = options.sections});
    const double r1 = (m.surface[0].mean + m.surface[1].mean + m.surface[2].mean) / 3;
    const double sd = m.theta_sd * kToDegrees;
    std::string misses;
    const auto check = [&](const char* what, double ours, double theirs, double tolerance) {
      if (std::abs(ours - theirs) > tolerance) misses += fmt::format(" {} {:+.3f}", what, ours - theirs);
    };
    check("T0", m.uncollided.mean, p.t0, .01);
    check("R1", r1, p.r1, .01);
    check("forward", m.forward, p.forward, .07);
    check("sd", sd, p.theta_sd, 3);
    for (size_t k = 0; k < 3; ++k) {
      const double f = p.fibre.reflect[int(k)], omega = f + (1 - f) * p.fibre.transmit[int(k)];
      check(std::array{"red", "green", "blue"}[k], m.body[k].mean, p.body[k], omega < .6 ? .10 : .05);
    }
    fmt::print("| {} | published | {:.3f} | {:.3f} | {:.3f} {:.3f} {:.3f} | {:.2f} | {:.1f} | {:.1f} | |\n", p.name,
               p.t0, p.r1, p.body[0], p.body[1], p.body[2], p.forward, p.theta_sd, p.events);
    fmt::print("| | ours | {:.3f} | {:.3f} | {:.3f} {:.3f} {:.3f} | {:.2f} | {:.1f} | {:.1f} |{} |\n",
               m.uncollided.mean, r1, m.body[0].mean, m.body[1].mean, m.body[2].mean, m.forward, sd, m.events,
               misses.empty() ? " none" : misses);
    std::fflush(stdout);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  fmt::print("\n{} paths, {} sections a bundle, seed {}, {:.1f} s\n", options.paths, options.sections, options.seed,
             seconds.count());
}

}  // namespace wale
