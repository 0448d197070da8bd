#include "tests/fuzz/patterns.h"

#include "geom/stitch.h"
#include "tests/fuzz/expect.h"

namespace wale::fuzz {
namespace {

void expect_consistent(const Pattern& pattern) {
  expect(finite(pattern.period) && pattern.period.x > 0 && pattern.period.y > 0, "the period is not positive");
  expect(std::isfinite(pattern.yarn_radius) && pattern.yarn_radius > 0, "the yarn radius is not positive");
  expect(pattern.stitches.x > 0 && pattern.stitches.y > 0, "the stitches are not positive");
  expect(!pattern.curves.empty(), "no curves");
  for (const PatternCurve& curve : pattern.curves) {
    expect(curve.points.size() >= (curve.closed ? 3u : 2u), "a curve has too few points");
    for (const dvec3& p : curve.points) expect(finite(p), "a point is not finite");
  }
  const PartnerMap partners = match_partners(pattern);  // refuses ends without a partner
  size_t links = 0;
  for (const YarnChain& yarn : tile_yarns(pattern, partners)) links += yarn.links.size();
  expect(links == pattern.curves.size(), "a curve is not in exactly one yarn");
}

}  // namespace

bool read_tile(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints) {
  return accepted([&] { expect_consistent(parse_pattern(bytes, file, hints)); });
}

}  // namespace wale::fuzz
