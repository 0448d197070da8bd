#pragma once
#include <array>
#include <string>
#include <vector>

#include "bench/goniometer/fibre_scattering.h"
#include "geom/fibre_section.h"

namespace wale {

/// A bundle of fibres from the literature, and what an independent goniometer measured on it: uncollided and surface
/// light, body colour, forward share of the body, standard deviation of th_o + th_i (degrees), fibres met. Normal
/// incidence, averaged over the offset, Khungurn's longitudinal function. That goniometer's own noise is about .01.
struct PublishedBundle {
  std::string name;
  FibreRecipe recipe;
  FibreScattering fibre;
  double t0, r1;
  std::array<double, 3> body;
  double forward, theta_sd, events;
};

/// Thirteen bundles: five of Soh and Montazeri 2024 (surface tilt tan = pi Alpha), four of Zhao, Luan and Bala 2016
/// (tables 2 and 3; fibre radius 0.002, ply radius the mean of e_X and e_Y, tan = 2 pi e / alpha), four dielectric
/// ones.
std::vector<PublishedBundle> published_bundles();

}  // namespace wale
