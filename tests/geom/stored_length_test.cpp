#include "geom/stored_length.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "appearance/fibre_phase.clh"
#include "geom/base_mesh_generators.h"
#include "geom/fabric.h"

namespace wale {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

TEST(StoredLength, StaysInsideOnePeriodAndKeepsThePhaseOfTheFibres) {
  const double radius = 2e-4;
  for (const double twist : {0.09, -0.35, 0.39, 1.2}) {
    const StoredLength length = stored_length(7, 2, radius, twist, 0);
    const double kappa = double(w_snapped(float(twist / radius), float(radius)));
    EXPECT_NEAR(kappa, twist / radius, 0.5 * kTurn / length.period * 1.001);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const double s = 10.0 * i / 20000 + 1e-7 * i;  // metres of ply
      const float stored = length.at(s);
      ASSERT_GE(stored, 0.0f);
      ASSERT_LT(stored, W_LENGTH_PERIOD * float(radius));
      const double turns = double(w_turns_per_period(float(twist))) * (length.unwrapped(s) / length.period);
      const double phase = double(w_fibre_turn(float(twist), stored, float(radius)));
      worst = std::max(worst, std::abs(std::remainder(phase - kTurn * turns, kTurn)));
    }
    // Three roundings of half a unit in the last place: the stored length, its share of the period, the turns.
    EXPECT_LT(worst, 3 * std::ldexp(1.0, -24) * double(W_LENGTH_PERIOD) * std::abs(twist)) << twist;
  }
}

TEST(StoredLength, InterpolationGoesThroughTheWrap) {
  const float radius = 1e-4f, period = W_LENGTH_PERIOD * radius;
  EXPECT_FLOAT_EQ(w_length_between(0.2f, 0.3f, 0.25f, radius), 0.225f);
  EXPECT_NEAR(w_length_between(period - 1e-4f, 3e-4f, 0.125f, radius), period - 0.5e-4f, 1e-7f);
  EXPECT_NEAR(w_length_between(period - 1e-4f, 3e-4f, 0.75f, radius), 2e-4f, 1e-7f);
  for (int i = 0; i <= 1000; ++i) {
    const float l = w_length_between(period - 1e-4f, 3e-4f, float(i) / 1000, radius);
    EXPECT_GE(l, 0.0f);
    EXPECT_LT(l, period);
  }
}

TEST(StoredLength, NeighboursStartElsewhere) {
  const double radius = 2e-4;
  for (uint32_t yarn = 0; yarn < 50; ++yarn)
    for (uint32_t ply = 0; ply < 3; ++ply) {
      const StoredLength here = stored_length(yarn, ply, radius, 0.3, 0),
                         beside = stored_length(yarn, ply + 1, radius, 0.3, 0);
      const StoredLength above = stored_length(yarn + 1, ply, radius, 0.3, 0);
      EXPECT_GT(std::abs(here.start - beside.start), 1e-5 * here.period);
      EXPECT_GT(std::abs(here.start - above.start), 1e-5 * here.period);
      EXPECT_EQ(here.start, stored_length(yarn, ply, radius, 0.3, 0).start);
    }
}

// Once round a closed ply the fibres are back where they began.
TEST(StoredLength, FibresOfClosedPliesClose) {
  FabricSpec spec;
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.fibres.twist = 0.35;
  const Fabric fabric = knit_fabric(make_tube(0.01, 0.03, 48, 12), stockinette_pattern(), spec);
  size_t closed = 0;
  for (const PlyRun& run : fabric.runs) {
    if (!run.ghost_ends) continue;
    ++closed;
    for (uint32_t p = 0; p < uint32_t(fabric.plies); ++p) {
      const Anchor* a = fabric.anchors.data() + run.first_vertex + p * run.count;
      const float radius = float(fabric.ply_radius), twist = float(spec.fibres.twist);
      const double before = w_fibre_turn(twist, a[1].length, radius);
      const double after = w_fibre_turn(twist, a[run.count - 2].length, radius);
      EXPECT_NEAR(std::remainder(after - before, kTurn), 0, 4e-4);
    }
  }
  EXPECT_GT(closed, 3u);
}

}  // namespace
}  // namespace wale
