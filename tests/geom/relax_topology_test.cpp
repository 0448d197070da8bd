// No yarn passes through another or through itself on the whole way from the loops of the chart to the relaxed tile:
// swept collision between all states, by another method than the bound on steps itself (step_bound.h). Linking numbers
// would not do: those of a knit stitch are 0, as left and right of it are mirror images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "geom/chart/knit_tile.h"
#include "geom/chart/loop_curves.h"
#include "geom/relax/relaxation.h"
#include "tests/bundled_settings.h"

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
  size_t pairs() const { return pairs_; }

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
    // All that may be near, by x: most of a large tile is not.
    struct Copy {
      double x;
      size_t segment;
      ivec2 image;
    };
    std::vector<Copy> copies;
    const double spare = 0.5 * glm::length(dvec2(images) * glm::abs(to.period - last_.period)),
                 near = 2 * reach + spare;
    for (int x = -images.x; x <= images.x; ++x)
      for (int y = -images.y; y <= images.y; ++y)
        for (size_t j = 0; j < segments.size(); ++j) {
          const dvec2 at = dvec2(middle[j]) + dvec2(x, y) * last_.period;
          if (at.x >= low.x - near && at.x <= high.x + near && at.y >= low.y - near && at.y <= high.y + near)
            copies.push_back({at.x, j, {x, y}});
        }
    std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.x < b.x; });
    for (size_t i = 0; i < segments.size(); ++i) {
      const auto first = std::lower_bound(copies.begin(), copies.end(), middle[i].x - near,
                                          [](const Copy& c, double x) { return c.x < x; });
      for (auto c = first; c != copies.end() && c->x <= middle[i].x + near; ++c) {
        const size_t j = c->segment;
        const dvec3 by(dvec2(c->image) * last_.period, 0), way(dvec2(c->image) * (to.period - last_.period), 0);
        if (j < i || glm::distance(middle[i], middle[j] + by + 0.5 * way) > 2 * reach + 0.5 * glm::length(way))
          continue;
        if (joined(segments[i], segments[j], c->image)) continue;
        Moving other = moving[j];
        for (int end = 0; end < 2; ++end) other.from[end] += by, other.by[end] += way;
        ++pairs_;
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
  size_t pairs_ = 0;
};

// All paths of a tile as scenes/patterns/make.sh makes it: every start from where the loops begin, shaken or not, the
// finer pass from where the best of them ended, and the shapes of its table of strains from their neighbours.
void expect_kept_as_bundled(const std::string& name) {
  const std::filesystem::path folder = WALE_SOURCE_DIR "/scenes/patterns";
  const Pattern tile = read_pattern(folder / (name + ".json"));
  const StitchChart chart = read_chart(folder / (name + ".chart"));
  KnitSettings settings = test::bundled_settings(tile);
  const size_t starts = size_t(settings.starts),
               shapes = settings.strains ? std::size(kStrains) * std::size(kStrains) : 0;
  std::vector<Sweep> paths(starts + 1 + shapes);
  settings.watch = [&](size_t path, const PeriodicYarns& state) { paths.at(path)(state); };
  ASSERT_TRUE(knit_tile(chart, settings).relaxed.converged) << name;
  int steps = 0, meetings = 0;
  for (size_t p = 0; p < paths.size(); ++p) {
    EXPECT_EQ(paths[p].meetings(), 0) << name << ", path " << p;
    EXPECT_GT(paths[p].steps(), 0) << name << ", path " << p;
    steps += paths[p].steps(), meetings += paths[p].meetings();
  }
  // But for rounding: a relaxation reckons in diameters, and gives metres back.
  const auto ends_at = [](const PeriodicYarns& there) {
    return [&](const Sweep& path) {
      return path.last().points.size() == there.points.size() &&
             std::equal(there.points.begin(), there.points.end(), path.last().points.begin(),
                        [](const dvec3& a, const dvec3& b) { return glm::distance(a, b) < 1e-9; });
    };
  };
  const auto from = paths.begin(), finer = from + std::ptrdiff_t(starts), shape = finer + 1;
  for (auto p = from; p != finer; ++p) EXPECT_EQ(p->first().points, from->first().points) << "where the loops begin";
  EXPECT_TRUE(std::any_of(from, finer, ends_at(finer->first()))) << name << ": the finer pass goes on from a start";
  for (auto p = shape; p != paths.end(); ++p)
    EXPECT_TRUE(std::any_of(finer, paths.end(), ends_at(p->first()))) << name << ": a shape goes on from another one";
  std::printf("  %-20s %zu paths, %d steps, %d meetings\n", name.c_str(), paths.size(), steps, meetings);
  std::fflush(stdout);
}

void expect_kept(const StitchChart& chart) {
  PeriodicYarns yarns = loop_curves(knit_chart(chart), {0.5, 14, 0.6});
  const PeriodicYarns start = yarns;
  Sweep sweep;
  RelaxSettings settings;
  settings.watch = [&](size_t, const PeriodicYarns& state) { sweep(state); };
  EXPECT_TRUE(relax(yarns, settings).converged) << chart.name;
  EXPECT_EQ(sweep.first().points, start.points) << "from the loops of the chart ...";
  EXPECT_EQ(sweep.last().points, yarns.points) << "... to the tile";
  EXPECT_GT(sweep.steps(), 30) << chart.name;
  EXPECT_EQ(sweep.meetings(), 0) << chart.name;
}

TEST(RelaxTopology, NoYarnPassesThroughAnother) {
  for (const char* chart : {"k", "kp", "p\nk", "k2p2", "kp\npk", "ks\nkk", "kT\nkp", "o/\nkk", "\\o\nkk",
                            "k2 | ab\nk2 | ba", "o p2tog\nkk", "o cdd o\nkkk", "o sk2p o\nkkk", "c1/1f k\nk3"})
    expect_kept(parse_chart(chart, chart));
}

TEST(RelaxTopology, NorInTheBundledCharts) {
  for (const char* name : test::kQuickTiles) expect_kept_as_bundled(name);
}

TEST(RelaxTopology, NorInThoseThatTakeLong) {
  if (!std::getenv("WALE_LONG_TESTS")) GTEST_SKIP() << "takes minutes; set WALE_LONG_TESTS=1";
  for (const auto& file : std::filesystem::directory_iterator(WALE_SOURCE_DIR "/scenes/patterns"))
    if (file.path().extension() == ".chart" &&
        std::none_of(std::begin(test::kQuickTiles), std::end(test::kQuickTiles),
                     [&](const char* quick) { return file.path().stem() == quick; }))
      expect_kept_as_bundled(file.path().stem());
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
    EXPECT_GT(sweep.pairs(), 0u);
  }
}

}  // namespace
}  // namespace wale
