// Forces that relaxation goes by, against differences of the energy that it goes down, at tiles that are not at rest.
#include <gtest/gtest.h>

#include "geom/chart/loop_curves.h"
#include "geom/relax/descent.h"
#include "geom/relax/step_bound.h"

namespace wale {
namespace {

// In units of the yarn's diameter: nearly at rest, so that yarns touch, and then moved on.
PeriodicYarns pushed_tile() {
  PeriodicYarns yarns = loop_curves(knit_chart(parse_chart("kp\npk", "test")), {0.5, 14, 0.6});
  EXPECT_TRUE(relax(yarns, {}).converged);
  TileStep step;
  for (size_t i = 0; i < yarns.points.size(); ++i)
    step.points.push_back(0.01 *
                          dvec3(std::sin(3.0 * double(i)), std::cos(5.0 * double(i)), std::sin(7.0 * double(i))));
  step.strain = {0.01, -0.005};
  return moved(yarns, step, 1);
}

RelaxSettings pulled() {
  RelaxSettings settings;
  settings.tension = {2.5, 1.5};
  return settings;
}

double energy_at(const PeriodicYarns& yarns, const TileStep& step, double share) {
  PeriodicYarns at = moved(yarns, step, share);
  Descent descent(at, pulled());
  descent.barrier(1, 0.9);
  descent.look();
  return descent.energy();
}

double slope(const PeriodicYarns& yarns, const TileStep& step) {
  constexpr double kStep = 1e-5;
  return (energy_at(yarns, step, kStep) - energy_at(yarns, step, -kStep)) / (2 * kStep);
}

constexpr double kSame = 1e-6;  // relative: differences lose half the digits

TEST(RelaxForces, OnPointsAreTheSlopeOfTheEnergy) {
  PeriodicYarns yarns = pushed_tile();
  Descent descent(yarns, pulled());
  descent.barrier(1, 0.9);
  descent.look();
  double most = 0;
  for (size_t i = 0; i < yarns.points.size(); ++i) {
    dvec3 force(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      TileStep step;
      step.points.assign(yarns.points.size(), dvec3(0.0));
      step.points[i][axis] = 1;
      force[axis] = slope(yarns, step);
    }
    most = std::max(most, glm::length(force));
  }
  EXPECT_GT(most, 1);
  EXPECT_NEAR(descent.force(), most, kSame * most);
}

TEST(RelaxForces, OnThePeriodAreTheSlopeOfTheEnergyWithTheTension) {
  PeriodicYarns yarns = pushed_tile();
  for (const int axis : {0, 1}) {
    RelaxSettings settings = pulled();
    (axis ? settings.free_period_x : settings.free_period_y) = false;
    Descent descent(yarns, settings);
    descent.barrier(1, 0.9);
    descent.look();
    TileStep step;
    step.points.assign(yarns.points.size(), dvec3(0.0));
    step.strain[axis] = 1;
    const double force = std::abs(slope(yarns, step)) / yarns.period[axis];
    EXPECT_GT(force, 1);
    EXPECT_NEAR(descent.period_force(), force, kSame * force) << axis;
  }
}

// What a scale of the slopes alone would not show, as they are 0 at rest: the pull that a tile holds is the one asked
// for.
TEST(RelaxForces, ATileAtRestHoldsItsTension) {
  PeriodicYarns yarns = loop_curves(knit_chart(parse_chart("kp", "test")), {0.5, 14, 0.6});
  RelaxSettings settings = pulled();
  settings.force_tolerance = 1e-5;
  ASSERT_TRUE(relax(yarns, settings).converged);
  double longest = 0;
  for (const PeriodicYarn& y : yarns.yarns) longest = std::max(longest, y.length / y.count);
  for (const int axis : {0, 1}) {
    TileStep step;
    step.points.assign(yarns.points.size(), dvec3(0.0));
    step.strain[axis] = 1;
    const auto elastic = [&](double share) {
      PeriodicYarns at = moved(yarns, step, share);
      Descent descent(at, {});
      descent.barrier(1, barrier_for(settings.closest, 1.01 * longest, settings.contact_samples));
      descent.look();
      return descent.energy();
    };
    const double pull = (elastic(1e-6) - elastic(-1e-6)) / 2e-6 / yarns.period[axis];
    EXPECT_NEAR(pull, settings.tension[axis], 1e-3) << axis;
  }
}

}  // namespace
}  // namespace wale
