// Our goniometer beside the published one, bundle by bundle.
#include <fmt/core.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bench/goniometer/commands.h"
#include "bench/goniometer/measure.h"
#include "bench/goniometer/ply_model.h"
#include "bench/goniometer/published.h"

namespace wale {
namespace {

/// First reflections alone: albedo E_R = R1 / ((1 - T0) F0) and total variation from the ply's cosine lobe about the
/// normal, for fibres that reflect evenly in azimuth and for smooth round ones.
void print_first_surface(const Options& options) {
  struct Row {
    const char* bundle;
    bool smooth;
    const char* published;
  };
  fmt::print("\n| fibre reflection | bundle | published E_R at h = .05 / .5 / .85, TV | ours |\n|---|---|---|---|\n");
  for (const Row row : {Row{"P_polyester", false, ".335 .385 .449, .09 .11 .14"},
                        {"P_cotton", false, ".320 .362 .438, .06 .11 .16"},
                        {"P_polyester", true, ".500 .536 .533, .07 .08 .10"},
                        {"P_cotton", true, ".487 .502 .524, .04 .05 .06"}}) {
    for (PublishedBundle p : published_bundles()) {
      if (p.name != row.bundle) continue;
      p.fibre.transmit = dvec3(0);
      p.fibre.smooth = row.smooth;
      std::string albedo, tv;
      for (const double h : {.05, .5, .85}) {
        const Measurement m = measure(p.recipe, p.fibre,
                                      Incidence{.h_low = h,
                                                .h_high = h,
                                                .paths = 4 * options.paths,
                                                .seed = options.seed,
                                                .sections = options.sections});
        albedo += fmt::format("{:.3f} ", m.surface[0].mean / ((1 - m.uncollided.mean) * p.fibre.reflect.x));
        tv += fmt::format(" {:.2f}", total_variation(m.surface_phi, ply_surface_azimuth(h)));
      }
      fmt::print("| {} | {} | {} | {},{} |\n", row.smooth ? "smooth cylinder" : "even in azimuth", row.bundle,
                 row.published, albedo, tv);
    }
  }
}

}  // namespace

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
  print_first_surface(options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  fmt::print("\n{} paths, {} sections a bundle, seed {}, {:.1f} s\n", options.paths, options.sections, options.seed,
             seconds.count());
}

}  // namespace wale
