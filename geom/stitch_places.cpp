#include "geom/stitch_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wale {
namespace {

/// A tile yarn once round, in stitches: samples of all its links one after the other.
struct Course {
  const YarnChain* chain = nullptr;
  std::vector<dvec2> at;      ///< in stitches
  std::vector<double> share;  ///< of the cycle's length
  int stitches = 0;           ///< in one cycle, going to +x; 0 = not a course
  double height = 0;
  std::vector<size_t> sinkers;  ///< where stitches begin
  double first_middle = 0;      ///< x of the middle of the stitch that begins at sinkers[0]
};

/// Bottoms of a closed curve between its heads, where it has exactly `wanted` heads that stand out by half a course.
std::vector<size_t> sinkers(const std::vector<dvec2>& at, int wanted) {
  const size_t count = at.size();
  const auto y = [&](size_t i) { return at[i % count].y; };
  size_t lowest = 0;
  for (size_t i = 1; i < count; ++i)
    if (y(i) < y(lowest)) lowest = i;
  std::vector<size_t> lows{lowest};
  size_t top = lowest, bottom = lowest;
  bool rising = true;
  int heads = 0;
  for (size_t i = lowest; i <= lowest + count; ++i) {
    if (rising) {
      if (y(i) > y(top)) top = i;
      if (y(top) - y(lows.back()) > 0.5 && y(top) - y(i) > 0.5) {
        ++heads;
        rising = false;
        bottom = i;
      }
    } else {
      if (y(i) < y(bottom)) bottom = i;
      if (y(i) - y(bottom) > 0.5) {
        lows.push_back(bottom);
        rising = true;
        top = i;
      }
    }
  }
  if (heads != wanted || int(lows.size()) != wanted) return {};
  for (size_t& i : lows) i %= count;
  std::sort(lows.begin(), lows.end());
  return lows;
}

/// Mean of values modulo 1.
double mean_phase(const std::vector<double>& values) {
  double c = 0, s = 0;
  for (const double v : values) {
    c += std::cos(2 * std::numbers::pi * v);
    s += std::sin(2 * std::numbers::pi * v);
  }
  if (std::hypot(c, s) < 1e-6 * double(values.size()) || values.empty()) return 0.5;
  const double phase = std::atan2(s, c) / (2 * std::numbers::pi);
  return phase < -1e-9 ? phase + 1 : std::max(phase, 0.0);
}

Course trace(const YarnChain& chain, const TileSamples& tile, const StitchPlaces& places) {
  Course course;
  course.chain = &chain;
  const CycleSamples& cycle = tile.cycles[tile.of_curve[chain.links[0].curve].cycle];
  double sum = 0;
  for (const Link& link : chain.links) {
    const LinkSamples& samples = tile.of_curve[link.curve];
    for (size_t i = 0; i < samples.centre.size(); ++i) {
      course.at.push_back(dvec2(samples.centre[i]) / places.size + dvec2(link.instance * places.per_tile));
      course.share.push_back(samples.arc[i] / cycle.length);
      sum += course.at.back().y;
    }
  }
  course.height = sum / double(course.at.size());
  if (chain.shift.x <= 0 || chain.shift.y != 0) return course;
  course.stitches = chain.shift.x * places.per_tile.x;
  course.sinkers = sinkers(course.at, course.stitches);
  if (course.sinkers.empty())
    for (int k = 0; k < course.stitches; ++k)
      course.sinkers.push_back(
          size_t(std::lower_bound(course.share.begin(), course.share.end(), double(k) / course.stitches - 1e-9) -
                 course.share.begin()));
  const size_t begin = course.sinkers[0];
  const bool wraps = course.sinkers.size() == 1;
  const dvec2 end = wraps ? course.at[begin] + dvec2(course.stitches, 0) : course.at[course.sinkers[1]];
  course.first_middle = 0.5 * (course.at[begin].x + end.x);
  return course;
}

}  // namespace

StitchPlaces stitch_places(const Pattern& pattern, const PartnerMap& partners, const TileSamples& tile, dvec3 scale) {
  StitchPlaces places;
  places.per_tile = glm::max(pattern.stitches, ivec2(1));
  places.size = pattern.period * dvec2(scale) / dvec2(places.per_tile);
  places.of_curve.resize(pattern.curves.size());
  const std::vector<YarnChain> yarns = tile_yarns(pattern, partners);
  std::vector<Course> courses;
  std::vector<double> middles, heights;
  for (const YarnChain& yarn : yarns) {
    courses.push_back(trace(yarn, tile, places));
    if (courses.back().stitches == 0) continue;
    middles.push_back(courses.back().first_middle);
    heights.push_back(courses.back().height);
  }
  places.phase = {mean_phase(middles), mean_phase(heights)};

  for (const Course& course : courses) {
    const int row = int(std::lround(course.height - places.phase.y));
    const int column = int(std::lround(course.first_middle - places.phase.x));
    size_t i = 0;
    for (const Link& link : course.chain->links)
      for (size_t k = 0; k < tile.of_curve[link.curve].centre.size(); ++k, ++i) {
        ivec2 stitch(glm::floor(course.at[i]));
        if (course.stitches > 0) {
          const auto after = std::upper_bound(course.sinkers.begin(), course.sinkers.end(), i);
          // What comes before the first sinker is the end of the cycle's last stitch, one cycle back.
          stitch = {column + int(after - course.sinkers.begin()) - 1, row};
        }
        places.of_curve[link.curve].push_back(stitch - link.instance * places.per_tile);
      }
  }
  return places;
}

}  // namespace wale
