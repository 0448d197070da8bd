// No yarn passes through another or through itself on the whole way from the loops of the chart to the relaxed tile:
// swept collision between all states, by another method than the bound on steps itself (step_bound.h). Linking numbers
// would not do: those of a knit stitch are 0, as left and right of it are mirror images.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "geom/chart/loop_curves.h"
#include "geom/relax/relaxation.h"

namespace wale {
namespace {

struct Moving {
  dvec3 from[2], by[2];  // both ends at time 0, and their way until time 1
};

double gap(const Moving& f, const Moving& g, double time) {
  return glm::length(closest_points(f.from[0] + time * f.by[0], f.from[1] + time * f.by[1], g.from[0] + time * g.by[0],
                                    g.from[1] + time * g.by[1])
                         .way);
}

// Conservative advancement (Mirtich 1996): at a distance d nothing meets for d over the largest relative speed.
bool meet(const Moving& f, const Moving& g) {
  constexpr double kTouching = 1e-7;
  double speed = 0;
  for (const dvec3& a : f.by)
    for (const dvec3& b : g.by) speed = std::max(speed, glm::length(a - b));
  for (double time = 0; time < 1;) {
    const double d = gap(f, g, time);
    if (d < kTouching) return true;
    if (d >= speed * (1 - time)) return false;
    time += d / speed;
  }
  return false;
}

// Follows the states of one relaxation.
class Sweep {
 public:
  void operator()(const PeriodicYarns& state) {
    const size_t before = last_.points.size(), now = state.points.size();
    if (before == 0)
      first_ = state;
    else if (now == 2 * before)
      same_line(last_, state);
    else if (2 * now == before)
      same_line(state, last_);
    else
      step(state);
    last_ = state;
  }
  const PeriodicYarns& first() const { return first_; }
  const PeriodicYarns& last() const { return last_; }
  int steps() const { return steps_; }
  int meetings() const { return meetings_; }

 private:
  // `fine` has every point of `coarse` and the middles of its segments.
  static void same_line(const PeriodicYarns& coarse, const PeriodicYarns& fine) {
    ASSERT_EQ(coarse.period, fine.period);
    const std::vector<YarnSegment> segments = segments_of(coarse);
    for (const YarnSegment& s : segments) {
      const dvec3 a = coarse.points[s.a], b = coarse.points[s.b] + dvec3(dvec2(s.shift) * coarse.period, 0);
      ASSERT_LT(glm::distance(fine.points[2 * s.a], a), 1e-12);
      ASSERT_LT(glm::distance(fine.points[2 * s.a + 1], 0.5 * (a + b)), 1e-12);
    }
  }

  void step(const PeriodicYarns& to) {
    ASSERT_EQ(last_.points.size(), to.points.size());
    ++steps_;
    const std::vector<YarnSegment> segments = segments_of(last_);
    std::vector<Moving> moving;
    std::vector<dvec3> middle;
    dvec3 low(INFINITY), high(-INFINITY);
    double reach = 0;  // half a segment and half its way
    for (const YarnSegment& s : segments) {
      Moving m;
      m.from[0] = last_.points[s.a], m.from[1] = last_.points[s.b] + dvec3(dvec2(s.shift) * last_.period, 0);
      m.by[0] = to.points[s.a] - m.from[0];
      m.by[1] = to.points[s.b] + dvec3(dvec2(s.shift) * to.period, 0) - m.from[1];
      const dvec3 at = 0.5 * (m.from[0] + m.from[1]) + 0.25 * (m.by[0] + m.by[1]);
      for (int end = 0; end < 2; ++end)
        for (const double time : {0.0, 1.0}) reach = std::max(reach, glm::distance(at, m.from[end] + time * m.by[end]));
      low = glm::min(low, at), high = glm::max(high, at);
      moving.push_back(m), middle.push_back(at);
    }
    const dvec2 period = glm::min(last_.period, to.period);
    const ivec2 images(glm::ceil((dvec2(high - low) + 2 * reach) / period));
    for (int x = -images.x; x <= images.x; ++x)
      for (int y = -images.y; y <= images.y; ++y) {
        const dvec3 by(dvec2(x, y) * last_.period, 0), way(dvec2(x, y) * (to.period - last_.period), 0);
        for (size_t i = 0; i < segments.size(); ++i)
          for (size_t j = i; j < segments.size(); ++j) {
            if (glm::distance(middle[i], middle[j] + by + 0.5 * way) > 2 * reach + 0.5 * glm::length(way)) continue;
            if (joined(segments[i], segments[j], {x, y})) continue;
            Moving other = moving[j];
            for (int end = 0; end < 2; ++end) other.from[end] += by, other.by[end] += way;
            meetings_ += meet(moving[i], other);
          }
      }
  }

  // The same one, or one that goes on where the other ends.
  static bool joined(const YarnSegment& f, const YarnSegment& g, ivec2 image) {
    return (f.a == g.a && image == ivec2(0)) || (f.b == g.a && image == f.shift) ||
           (g.b == f.a && image + g.shift == ivec2(0));
  }

  PeriodicYarns first_, last_;
  int steps_ = 0, meetings_ = 0;
};

void expect_kept(const StitchChart& chart, double loop_length, double tension) {
  PeriodicYarns yarns = loop_curves(knit_chart(chart), {0.5, loop_length, 0.6});
  const PeriodicYarns start = yarns;
  Sweep sweep;
  RelaxSettings settings;
  settings.tension = tension * dvec2(chart.rows.size(), chart.wales());
  settings.watch = [&](const PeriodicYarns& state) { sweep(state); };
  EXPECT_TRUE(relax(yarns, settings).converged) << chart.name;
  EXPECT_EQ(sweep.first().points, start.points) << "from the loops of the chart ...";
  EXPECT_EQ(sweep.last().points, yarns.points) << "... to the tile";
  EXPECT_GT(sweep.steps(), 30) << chart.name;
  EXPECT_EQ(sweep.meetings(), 0) << chart.name;
}

TEST(RelaxTopology, NoYarnPassesThroughAnother) {
  for (const char* chart : {"k", "kp", "p\nk", "k2p2", "kp\npk", "ks\nkk", "kT\nkp", "o/\nkk", "\\o\nkk",
                            "k2 | ab\nk2 | ba", "o p2tog\nkk", "o cdd o\nkkk", "c1/1f k\nk3"})
    expect_kept(parse_chart(chart, chart), 14, 0);
}

TEST(RelaxTopology, NorInTheBundledCharts) {
  if (!std::getenv("WALE_LONG_TESTS")) GTEST_SKIP() << "takes minutes; set WALE_LONG_TESTS=1";
  for (const auto& file : std::filesystem::directory_iterator(WALE_SOURCE_DIR "/scenes/patterns"))
    if (file.path().extension() == ".chart") expect_kept(read_chart(file.path()), 15, 0.5);
}

// The measure itself: a yarn sent through another in one step is seen, one that stops short of it is not.
TEST(RelaxTopology, ASweepSeesAYarnThatPasses) {
  PeriodicYarns y;
  for (int i = 0; i < 4; ++i) y.points.emplace_back(i, 0.3, 0);
  for (int i = 0; i < 4; ++i) y.points.emplace_back(0.4, i, 1);
  y.yarns = {{0, 4, {1, 0}, 4}, {4, 4, {0, 1}, 4}};
  y.period = {4, 4};
  for (const auto& [to, meetings] : {std::pair{-0.5, 1}, {0.01, 0}, {7.0, 0}}) {
    Sweep sweep;
    sweep(y);
    PeriodicYarns next = y;
    for (size_t i = 4; i < 8; ++i) next.points[i].z = to;
    sweep(next);
    EXPECT_EQ(sweep.meetings(), meetings) << to;
  }
}

}  // namespace
}  // namespace wale
