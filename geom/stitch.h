#pragma once
#include <array>
#include <vector>

#include "geom/pattern.h"

namespace wale {

/// One end of a tile curve: `end` 0 is the first point, 1 the last.
struct Endpoint {
  int curve = -1;
  int end = 0;
  bool operator==(const Endpoint&) const = default;
};

/// Where a curve goes on: endpoint `to` of the tile displaced by `shift` periods.
struct Partner {
  Endpoint to;
  ivec2 shift{0, 0};
  double distance = 0;  ///< metres between the two ends
};

/// Partner of every endpoint of the open curves; an involution: partner(partner(e)) == e with opposite shifts.
struct PartnerMap {
  std::vector<std::array<Partner, 2>> of;  ///< [curve][end]; closed curves have to.curve == -1
  double worst_distance = 0;               ///< metres
};

/// Nearest endpoint among the tile itself and its neighbours (KNIT21 section 3.1). Throws a user error that names an
/// endpoint without a partner within `tolerance` metres (0 = yarn radius), or one claimed twice.
PartnerMap match_partners(const Pattern& pattern, double tolerance = 0);

/// A curve of one tile instance inside a yarn, walked backwards where `reversed`.
struct Link {
  ivec2 instance{0, 0};
  int curve = 0;
  bool reversed = false;
};

/// A yarn as a chain of links. `closed` yarns return to their first link displaced by `shift` periods (0,0 when it is a
/// ring in space, a multiple of the wrap on a tube).
struct YarnChain {
  std::vector<Link> links;
  bool closed = false;
  ivec2 shift{0, 0};
};

/// The yarns of one tile, each walked once round the torus: `shift` says by how many periods it advances.
/// Directions are chosen so that a yarn advances in +x (or +y when its x shift is 0); links walked against the file's
/// direction are marked reversed.
std::vector<YarnChain> tile_yarns(const Pattern& pattern, const PartnerMap& partners);

/// A rectangle of tile instances, lo inclusive, hi exclusive. wrap.x > 0 identifies columns modulo wrap.x (a tube).
struct InstanceRect {
  ivec2 lo{0, 0}, hi{1, 1};
  ivec2 wrap{0, 0};
};

/// Traverses the degree-2 graph over (instance, curve) into full yarns; every (instance, curve) is in exactly one.
/// Open yarns start at an end without a partner inside the rectangle. Same direction rule as tile_yarns.
std::vector<YarnChain> stitch(const Pattern& pattern, const PartnerMap& partners, const InstanceRect& rect);

}  // namespace wale
