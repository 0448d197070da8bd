#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <string>

#include "geom/error.h"
#include "geom/flat_knit.h"
#include "geom/yarn_spline.h"

namespace wale::test {

/// A folder of its own for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("wale_") + info->test_suite_name() + "_" + info->name() + "_" + std::to_string(std::rand()));
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// Expects a user error of one line that contains every one of the texts.
inline void expect_user_error(const std::function<void()>& run, const std::vector<std::string>& texts) {
  try {
    run();
    FAIL() << "no error was thrown";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(error.fault(), Fault::user) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    for (const std::string& text : texts)
      EXPECT_NE(what.find(text), std::string::npos) << what << "\n  lacks: " << text;
  }
}

/// Control points of one tile yarn round its whole cycle, without the repeated joints.
inline std::vector<dvec3> cycle_points(const Pattern& pattern, const YarnChain& cycle) {
  std::vector<dvec3> result;
  for (const Link& link : cycle.links) {
    const PatternCurve& curve = pattern.curves[link.curve];
    const size_t count = curve.points.size();
    for (size_t i = 0; i + (curve.closed ? 0 : 1) < count; ++i)
      result.push_back(curve.points[link.reversed ? count - 1 - i : i] +
                       dvec3(link.instance.x * pattern.period.x, link.instance.y * pattern.period.y, 0));
  }
  return result;
}

/// The same tile, moved by `by` and cut anew at the borders of [0, period): other pieces, other crossings; with
/// `random` some pieces are stored backwards. Cycles keep their points.
inline Pattern recut(const Pattern& pattern, dvec2 by, std::mt19937_64* random = nullptr) {
  Pattern result = pattern;
  result.curves.clear();
  for (const YarnChain& cycle : tile_yarns(pattern, match_partners(pattern))) {
    std::vector<dvec3> points = cycle_points(pattern, cycle);
    for (dvec3& p : points) p += dvec3(by, 0);
    const dvec3 advance(cycle.shift.x * pattern.period.x, cycle.shift.y * pattern.period.y, 0);
    const size_t count = points.size();
    const auto point = [&](size_t i) { return points[i % count] + advance * double(i / count); };
    const auto cell = [&](const dvec3& p) {
      return ivec2(std::floor(p.x / pattern.period.x), std::floor(p.y / pattern.period.y));
    };
    std::vector<size_t> cuts;
    for (size_t i = 0; i < count; ++i)
      if (cell(point(i)) != cell(point(i + 1))) cuts.push_back(i + 1);
    if (cuts.empty()) {
      result.curves.push_back({points, true});
      continue;
    }
    cuts.push_back(cuts[0] + count);
    for (size_t c = 0; c + 1 < cuts.size(); ++c) {
      const ivec2 home = cell(point(cuts[c]));
      PatternCurve curve;
      for (size_t i = cuts[c]; i <= cuts[c + 1]; ++i)
        curve.points.push_back(point(i) - dvec3(home.x * pattern.period.x, home.y * pattern.period.y, 0));
      if (random && (*random)() % 2) std::reverse(curve.points.begin(), curve.points.end());
      result.curves.push_back(std::move(curve));
    }
  }
  return result;
}

/// Two rows of plain knit, the second one walked in -x and shifted in phase: two yarns, one of them backwards.
inline Pattern two_row_tile() {
  Pattern pattern = stockinette_pattern(0.002);
  pattern.name = "two rows";
  PatternCurve second = pattern.curves[0];
  for (dvec3& p : second.points) p += dvec3(0.0007, pattern.period.y, 0);
  std::reverse(second.points.begin(), second.points.end());
  pattern.curves.push_back(second);
  pattern.period.y *= 2;
  pattern.stitches = {1, 2};
  return pattern;
}

/// One straight yarn that advances by (1,1), and a ring.
inline Pattern diagonal_and_ring() {
  Pattern pattern;
  pattern.name = "diagonal";
  pattern.period = {0.01, 0.01};
  pattern.yarn_radius = 0.0005;
  PatternCurve line, ring;
  for (int i = 0; i <= 4; ++i) line.points.push_back({0.0025 * i, 0.0025 * i, 0});
  for (int i = 0; i < 12; ++i)
    ring.points.push_back({0.005 + 0.002 * std::cos(i * M_PI / 6), 0.005 + 0.002 * std::sin(i * M_PI / 6), 0.002});
  ring.closed = true;
  pattern.curves = {line, ring};
  return pattern;
}

inline YarnSpec yarn_spec(const Pattern& pattern, int plies = 3, double pitch_in_radii = 8) {
  YarnSpec spec;
  spec.plies = plies;
  spec.twist = pitch_in_radii == 0 ? 0 : 1 / (pitch_in_radii * pattern.yarn_radius);
  fill_yarn(spec, pattern.yarn_radius);
  return spec;
}

inline std::vector<FlatYarn> knit_all(const Pattern& pattern, const YarnSpec& spec, const InstanceRect& rect,
                                      dvec3 scale = dvec3(1)) {
  std::vector<FlatYarn> yarns;
  knit_flat(pattern, match_partners(pattern), spec, scale, rect,
            [&](FlatYarn&& yarn) { yarns.push_back(std::move(yarn)); });
  return yarns;
}

/// Every (instance, curve) of the rectangle is in exactly one yarn.
inline void expect_partition(const Pattern& pattern, const InstanceRect& rect, const std::vector<YarnChain>& yarns) {
  std::set<std::array<int, 3>> seen;
  const auto fold = [](int v, int lo, int wrap) { return wrap > 0 ? lo + ((v - lo) % wrap + wrap) % wrap : v; };
  for (const YarnChain& yarn : yarns)
    for (const Link& link : yarn.links) {
      const int x = fold(link.instance.x, rect.lo.x, rect.wrap.x), y = fold(link.instance.y, rect.lo.y, rect.wrap.y);
      EXPECT_TRUE(x >= rect.lo.x && x < rect.hi.x && y >= rect.lo.y && y < rect.hi.y);
      EXPECT_TRUE(seen.insert({x, y, link.curve}).second) << "twice: " << x << "," << y << " curve " << link.curve;
    }
  const ivec2 size = rect.hi - rect.lo;
  EXPECT_EQ(seen.size(), size_t(size.x) * size.y * pattern.curves.size());
}

/// Partners are an involution with opposite shifts and equal distances.
inline void expect_involution(const Pattern& pattern, const PartnerMap& map) {
  for (int c = 0; c < int(pattern.curves.size()); ++c) {
    for (int end : {0, 1}) {
      const Partner& to = map.of[c][end];
      if (pattern.curves[c].closed) {
        EXPECT_EQ(to.to.curve, -1);
        continue;
      }
      ASSERT_GE(to.to.curve, 0);
      const Partner& back = map.of[to.to.curve][to.to.end];
      EXPECT_EQ(back.to, (Endpoint{c, end}));
      EXPECT_EQ(back.shift, -to.shift);
      EXPECT_NEAR(back.distance, to.distance, 1e-12);
      EXPECT_LE(to.distance, map.worst_distance);
    }
  }
}

}  // namespace wale::test
