#include "bench/goniometer/published.h"

#include <cmath>
#include <numbers>

namespace wale {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;

FibreScattering fibre(dvec3 reflect, dvec3 transmit, double beta_r, double beta_tt, double gamma_tt) {
  return {reflect, transmit, beta_r * kDegree, beta_tt * kDegree, gamma_tt * kDegree, Longitudinal::gaussian};
}

FibreRecipe soh(int fibres, double packing, double alpha) {
  return {.fibres = fibres, .packing = packing, .twist = kPi * alpha};
}

FibreRecipe zhao(int fibres, double beta, double epsilon, double alpha, double e_x, double e_y) {
  const double e = 0.5 * (e_x + e_y), radius = 0.002 / e;
  return {.fibres = fibres,
          .packing = fibres * radius * radius,
          .radial_beta = beta,
          .radial_epsilon = epsilon,
          .twist = 2 * kPi * e / alpha};
}

FibreRecipe dielectric(int fibres, double packing, double twist) {
  return {.fibres = fibres, .packing = packing, .twist = twist};
}

}  // namespace

std::vector<PublishedBundle> published_bundles() {
  const dvec3 dyed(.95, .80, .50);
  return {
      {"fleece",
       soh(300, .300, .240),
       fibre({.040, .087, .087}, {.452, .725, .948}, 7.238, 10, 25.989),
       .016,
       .022,
       {.035, .138, .584},
       .64,
       24.1,
       7.8},
      {"gabardine",
       soh(450, .250, .120),
       fibre({.185, .047, .069}, {.999, .330, .354}, 2.141, 10, 23.548),
       .013,
       .030,
       {.922, .021, .026},
       .52,
       22.6,
       11.2},
      {"silk",
       soh(300, .200, .000),
       fibre({.745, .008, .070}, {.620, .553, .562}, 1, 10, 19.823),
       .017,
       .085,
       {.332, .063, .081},
       .42,
       11.0,
       4.0},
      {"cotton",
       soh(600, .350, .060),
       fibre({.989, .959, .874}, {.999, .999, .999}, 1, 27.197, 38.269),
       .011,
       .303,
       {.666, .680, .683},
       .19,
       17.0,
       18.9},
      {"polyester",
       soh(200, .400, .200),
       fibre({.7, .7, .7}, {.6, .0, .8}, 5.238, 10, 25),
       .021,
       .231,
       {.284, .115, .418},
       .25,
       24.6,
       5.5},
      {"Z_cotton2",
       zhao(37, .430, .033, -.436, .025, .018),
       fibre({.10, .10, .05}, {.93, .53, .01}, 1, 27, 38),
       .073,
       .031,
       {.694, .163, .002},
       .74,
       26.1,
       3.4},
      {"Z_rayon1",
       zhao(150, .682, .139, .710, .053, .036),
       fibre({.15, .25, .25}, {.45, .82, .95}, 1.2, 10, 26),
       .026,
       .071,
       {.072, .358, .672},
       .54,
       20.2,
       5.9},
      {"Z_silk1",
       zhao(33, .462, .000, -.458, .025, .022),
       fibre({.10, .10, .10}, {.73, .50, .67}, 1, 10, 20),
       .109,
       .036,
       {.370, .165, .303},
       .88,
       15.1,
       2.5},
      {"Z_poly1",
       zhao(60, .258, .202, -.379, .029, .021),
       fibre({.10, .10, .05}, {.88, .83, .01}, 4, 10, 20),
       .050,
       .030,
       {.514, .404, .001},
       .80,
       19.4,
       4.6},
      {"P_cotton",
       dielectric(75, .50, .39),
       fibre(dvec3(.045), dyed, 8, 20, 35),
       .027,
       .017,
       {.706, .311, .080},
       .69,
       24.9,
       5.2},
      {"P_wool",
       dielectric(60, .40, .35),
       fibre(dvec3(.047), dyed, 6, 12, 28),
       .047,
       .017,
       {.730, .351, .086},
       .81,
       20.5,
       4.5},
      {"P_silk",
       dielectric(120, .50, .09),
       fibre(dvec3(.050), dyed, 3, 8, 20),
       .019,
       .019,
       {.669, .244, .048},
       .79,
       17.1,
       6.5},
      {"P_polyester",
       dielectric(72, .50, .16),
       fibre(dvec3(.055), dyed, 4, 10, 22),
       .031,
       .021,
       {.711, .310, .070},
       .82,
       18.6,
       5.2},
  };
}

}  // namespace wale
