#include "geom/stitch.h"

#include <algorithm>
#include <limits>

#include "geom/error.h"
#include "geom/near_points.h"

namespace wale {
namespace {

// Yarns have a thickness: nowhere do so many end within one radius. It keeps a damaged file from taking for ever.
constexpr size_t kMostNear = 64;

const char* end_name(int end) { return end == 0 ? "first" : "last"; }

const dvec3& point_at(const Pattern& pattern, Endpoint e) {
  const auto& points = pattern.curves[e.curve].points;
  return e.end == 0 ? points.front() : points.back();
}

/// Where a curve, walked in its yarn's direction, goes on.
struct Successor {
  int curve = -1;
  ivec2 shift{0, 0};
};

/// The degree-2 graph of one tile with a direction chosen for every curve.
struct DirectedTile {
  std::vector<bool> reversed;
  std::vector<Successor> next, previous;
};

DirectedTile direct(const Pattern& pattern, const PartnerMap& partners) {
  const size_t count = pattern.curves.size();
  DirectedTile tile{std::vector<bool>(count, false), std::vector<Successor>(count), std::vector<Successor>(count)};
  for (const YarnChain& yarn : tile_yarns(pattern, partners))
    for (const Link& link : yarn.links) tile.reversed[link.curve] = link.reversed;
  for (size_t c = 0; c < count; ++c) {
    if (pattern.curves[c].closed) continue;
    const Partner& after = partners.of[c][tile.reversed[c] ? 0 : 1];
    const Partner& before = partners.of[c][tile.reversed[c] ? 1 : 0];
    tile.next[c] = {after.to.curve, after.shift};
    tile.previous[c] = {before.to.curve, before.shift};
  }
  return tile;
}

int wrapped(int value, int lo, int wrap) {
  if (wrap <= 0) return value;
  const int rest = (value - lo) % wrap;
  return lo + (rest < 0 ? rest + wrap : rest);
}

/// (instance, curve) numbered row by row inside the rectangle.
class Nodes {
 public:
  Nodes(const InstanceRect& rect, size_t curves) : rect_(rect), curves_(curves) {
    const ivec2 size = rect.hi - rect.lo;
    if (size.x < 0 || size.y < 0) bug("stitch: rectangle {} x {} tiles", size.x, size.y);
    for (const int axis : {0, 1})
      if (rect.wrap[axis] > 0 && size[axis] > rect.wrap[axis])
        bug("stitch: {} tiles laid where {} close the ring", size[axis], rect.wrap[axis]);
    visited_.assign(static_cast<size_t>(size.x) * size.y * curves, false);
  }

  /// Number of the node, or -1 outside the rectangle.
  long find(ivec2 instance, int curve) const {
    const int x = wrapped(instance.x, rect_.lo.x, rect_.wrap.x), y = wrapped(instance.y, rect_.lo.y, rect_.wrap.y);
    if (x < rect_.lo.x || x >= rect_.hi.x || y < rect_.lo.y || y >= rect_.hi.y) return -1;
    const long row = y - rect_.lo.y, width = rect_.hi.x - rect_.lo.x;
    return (row * width + (x - rect_.lo.x)) * static_cast<long>(curves_) + curve;
  }
  Link link(size_t node) const {
    const long width = rect_.hi.x - rect_.lo.x, cell = static_cast<long>(node / curves_);
    return {rect_.lo + ivec2(cell % width, cell / width), static_cast<int>(node % curves_), false};
  }
  size_t size() const { return visited_.size(); }
  bool visited(size_t node) const { return visited_[node]; }
  void visit(size_t node) { visited_[node] = true; }

 private:
  InstanceRect rect_;
  size_t curves_;
  std::vector<bool> visited_;
};

YarnChain walk(size_t first, const DirectedTile& tile, Nodes& nodes) {
  YarnChain yarn;
  Link link = nodes.link(first);
  const ivec2 origin = link.instance;
  for (long node = static_cast<long>(first);;) {
    nodes.visit(node);
    link.reversed = tile.reversed[link.curve];
    yarn.links.push_back(link);
    const Successor& next = tile.next[link.curve];
    if (next.curve < 0) {  // a closed curve is a yarn by itself
      yarn.closed = true;
      return yarn;
    }
    link = {link.instance + next.shift, next.curve, false};
    node = nodes.find(link.instance, link.curve);
    if (node < 0) return yarn;
    if (nodes.visited(node)) {
      if (node != static_cast<long>(first)) bug("stitch: a yarn runs into another one");
      yarn.closed = true;
      yarn.shift = link.instance - origin;
      return yarn;
    }
  }
}

double distance_to(const Pattern& pattern, Endpoint f, ivec2 shift, Endpoint e) {
  const dvec3 by(shift.x * pattern.period.x, shift.y * pattern.period.y, 0);
  return glm::length(point_at(pattern, f) + by - point_at(pattern, e));
}

/// The nearest other end within the tolerance; of several at one distance the first, by number, then by shift.
Partner nearest_end(const Pattern& pattern, const std::vector<Endpoint>& ends, const NearPoints& places, size_t i,
                    double tolerance) {
  Partner best;
  best.distance = std::numeric_limits<double>::infinity();
  size_t best_end = 0, near = 0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const dvec3 by(x * pattern.period.x, y * pattern.period.y, 0);
      places.visit_near(point_at(pattern, ends[i]) - by, [&](int number) {
        const auto j = static_cast<size_t>(number);
        if (j == i) return;  // a whole period away at best
        const double distance = distance_to(pattern, ends[j], {x, y}, ends[i]);
        if (!(distance <= tolerance)) return;
        if (++near > kMostNear)
          user_error(
              "pattern '{}': curve {}, {} end: more than {} ends lie within {:.4g} m of it; check the yarn radius and "
              "the period ({:.6g} x {:.6g} m)",
              pattern.name, ends[i].curve, end_name(ends[i].end), kMostNear, tolerance, pattern.period.x,
              pattern.period.y);
        if (distance < best.distance || (distance == best.distance && j < best_end)) {
          best = {ends[j], {x, y}, distance};
          best_end = j;
        }
      });
    }
  return best;
}

/// However far it is; for the message.
double nearest_distance(const Pattern& pattern, const std::vector<Endpoint>& ends, Endpoint e) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Endpoint& f : ends)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (f != e) nearest = std::min(nearest, distance_to(pattern, f, {x, y}, e));
  return nearest;
}

/// The same cycle walked the other way, beginning with the same curve in the same instance.
YarnChain turned(const YarnChain& yarn) {
  YarnChain result{{}, yarn.closed, -yarn.shift};
  const size_t count = yarn.links.size();
  for (size_t i = 0; i < count; ++i) {
    Link link = yarn.links[(count - i) % count];
    if (i > 0) link.instance -= yarn.shift;
    link.reversed = !link.reversed;
    result.links.push_back(link);
  }
  return result;
}

}  // namespace

PartnerMap match_partners(const Pattern& pattern, double tolerance) {
  if (!(tolerance > 0)) tolerance = pattern.yarn_radius;
  std::vector<Endpoint> ends;
  for (int c = 0; c < static_cast<int>(pattern.curves.size()); ++c)
    if (!pattern.curves[c].closed) ends.push_back({c, 0}), ends.push_back({c, 1});

  NearPoints places(tolerance);
  for (size_t i = 0; i < ends.size(); ++i) places.add(point_at(pattern, ends[i]), static_cast<int>(i));

  PartnerMap map;
  map.of.resize(pattern.curves.size());
  for (size_t i = 0; i < ends.size(); ++i) {
    const Endpoint& e = ends[i];
    const Partner best = nearest_end(pattern, ends, places, i, tolerance);
    if (best.to.curve < 0)
      user_error(
          "pattern '{}': curve {}, {} end: no partner within {:.4g} m, the nearest end is {:.4g} m away; check the "
          "period ({:.6g} x {:.6g} m)",
          pattern.name, e.curve, end_name(e.end), tolerance, nearest_distance(pattern, ends, e), pattern.period.x,
          pattern.period.y);
    map.of[e.curve][e.end] = best;
    map.worst_distance = std::max(map.worst_distance, best.distance);
  }
  for (const Endpoint& e : ends) {
    const Partner& partner = map.of[e.curve][e.end];
    const Partner& back = map.of[partner.to.curve][partner.to.end];
    if (back.to != e || back.shift != -partner.shift)
      user_error(
          "pattern '{}': curve {}, {} end: its nearest end, {:.4g} m away (tolerance {:.4g} m), is the {} end of curve "
          "{}, which another curve claims too; each end needs one partner",
          pattern.name, e.curve, end_name(e.end), partner.distance, tolerance, end_name(partner.to.end),
          partner.to.curve);
  }
  return map;
}

std::vector<YarnChain> tile_yarns(const Pattern& pattern, const PartnerMap& partners) {
  std::vector<YarnChain> yarns;
  std::vector<bool> visited(pattern.curves.size(), false);
  for (int first = 0; first < static_cast<int>(pattern.curves.size()); ++first) {
    if (visited[first]) continue;
    YarnChain yarn{{}, true, {0, 0}};
    Link link{{0, 0}, first, false};
    do {
      visited[link.curve] = true;
      yarn.links.push_back(link);
      if (pattern.curves[link.curve].closed) break;
      const Partner& on = partners.of[link.curve][link.reversed ? 0 : 1];
      link = {link.instance + on.shift, on.to.curve, on.to.end == 1};
    } while (!visited[link.curve]);
    yarn.shift = pattern.curves[first].closed ? ivec2(0, 0) : link.instance;
    const bool backwards = yarn.shift.x < 0 || (yarn.shift.x == 0 && yarn.shift.y < 0);
    yarns.push_back(backwards ? turned(yarn) : yarn);
  }
  return yarns;
}

// Every curve is walked in the direction that its yarn has in the tile, so the graph is directed: an open yarn starts
// at a node whose predecessor is outside the rectangle, and whatever is left over is closed.
std::vector<YarnChain> stitch(const Pattern& pattern, const PartnerMap& partners, const InstanceRect& rect) {
  const DirectedTile tile = direct(pattern, partners);
  Nodes nodes(rect, pattern.curves.size());
  std::vector<YarnChain> yarns;
  for (size_t node = 0; node < nodes.size(); ++node) {
    const Link link = nodes.link(node);
    const Successor& before = tile.previous[link.curve];
    if (before.curve >= 0 && nodes.find(link.instance + before.shift, before.curve) < 0)
      yarns.push_back(walk(node, tile, nodes));
  }
  for (size_t node = 0; node < nodes.size(); ++node)
    if (!nodes.visited(node)) yarns.push_back(walk(node, tile, nodes));
  return yarns;
}

}  // namespace wale
