#include <cstring>

#include "tests/geom/tile_fixtures.h"

namespace wale {
namespace {

using namespace test;

struct BccCurve {
  std::vector<std::array<float, 3>> points;
  bool closed = false;
};

template <typename T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string bcc(const std::string& type, char up, const std::vector<BccCurve>& curves, long extra_points = 0) {
  std::string bytes = "BCC\x44" + type + '\x03' + up;
  uint64_t points = extra_points;
  for (const BccCurve& curve : curves) points += curve.points.size();
  append<uint64_t>(bytes, curves.size());
  append<uint64_t>(bytes, points);
  bytes.resize(64, '\0');
  for (const BccCurve& curve : curves) {
    const int32_t count = static_cast<int32_t>(curve.points.size());
    append<int32_t>(bytes, curve.closed ? -count : count);
    for (const auto& p : curve.points)
      for (const float v : p) append<float>(bytes, v);
  }
  return bytes;
}

const BccCurve kRow{{{0, 0, 1}, {0.5f, 0.25f, 2}, {1, 0, 1}}, false};
const BccCurve kRing{{{0.2f, 0.2f, 1}, {0.4f, 0.2f, 1.5f}, {0.3f, 0.4f, 1.2f}}, true};

PatternHints hints() {
  PatternHints h;
  h.period = {0.01, 0.01};
  h.yarn_radius = 0.0005;
  return h;
}

void expect_refused(const std::string& bytes, const std::vector<std::string>& texts, const PatternHints& h = hints()) {
  ScratchFolder folder;
  const auto file = folder.write("t.bcc", bytes);
  expect_user_error([&] { read_pattern(file, h); }, texts);
}

TEST(BccReader, OpenAndClosedCurvesInCentimetres) {
  ScratchFolder folder;
  const Pattern tile = read_pattern(folder.write("t.bcc", bcc("C0", 2, {kRow, kRing})), hints());
  EXPECT_EQ(tile.kind, CurveKind::interpolating);
  ASSERT_EQ(tile.curves.size(), 2u);
  EXPECT_FALSE(tile.curves[0].closed);
  EXPECT_TRUE(tile.curves[1].closed);
  EXPECT_LT(glm::distance(tile.curves[0].points[1], dvec3(0.005, 0.0025, 0.005)), 1e-12);  // z 1..2 is centred
  EXPECT_EQ(tile_yarns(tile, match_partners(tile)).size(), 2u);
}

TEST(BccReader, KindsAndUnit) {
  ScratchFolder folder;
  PatternHints h = hints();
  h.unit = 2e-2;
  h.period = {0.02, 0.02};
  const Pattern tile = read_pattern(folder.write("t.bcc", bcc("BS", 2, {kRow})), h);
  EXPECT_EQ(tile.kind, CurveKind::bspline);
  EXPECT_NEAR(tile.curves[0].points[2].x, 0.02, 1e-12);
  EXPECT_EQ(read_pattern(folder.write("p.bcc", bcc("PL", 2, {kRow})), hints()).kind, CurveKind::interpolating);
}

TEST(BccReader, UpAxisGoesThroughTheFabric) {
  ScratchFolder folder;
  // The same curve lying in the xz plane with y up, and in the yz plane with x up.
  BccCurve y_up, x_up;
  for (const auto& p : kRow.points)
    y_up.points.push_back({p[0], p[2], -p[1]}), x_up.points.push_back({p[2], p[0], p[1]});
  const Pattern z = read_pattern(folder.write("z.bcc", bcc("C0", 2, {kRow})), hints());
  const Pattern y = read_pattern(folder.write("y.bcc", bcc("C0", 1, {y_up})), hints());
  const Pattern x = read_pattern(folder.write("x.bcc", bcc("C0", 0, {x_up})), hints());
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(glm::distance(z.curves[0].points[i], y.curves[0].points[i]), 1e-12);
    EXPECT_LT(glm::distance(z.curves[0].points[i], x.curves[0].points[i]), 1e-12);
  }
}

TEST(BccReader, PeriodMustBeGiven) {
  PatternHints h = hints();
  h.period = {0.01, 0};
  expect_refused(bcc("C0", 2, {kRow}), {"no period", "give the period"}, h);
}
TEST(BccReader, RadiusMustBeGiven) {
  PatternHints h = hints();
  h.yarn_radius = 0;
  expect_refused(bcc("C0", 2, {kRow}), {"give the yarn radius"}, h);
}
TEST(BccReader, NotBcc) { expect_refused(std::string(80, 'x'), {"'BCC'"}); }
TEST(BccReader, EmptyFile) { expect_refused("", {"cut off"}); }
TEST(BccReader, UnknownType) { expect_refused(bcc("BZ", 2, {kRow}), {"'BZ'", "C0, BS and PL"}); }
TEST(BccReader, UpAxisOutOfRange) { expect_refused(bcc("C0", 3, {kRow}), {"up axis 3"}); }
TEST(BccReader, TruncatedPoints) {
  const std::string bytes = bcc("C0", 2, {kRow, kRing});
  expect_refused(bytes.substr(0, bytes.size() - 8), {"curve 1 has 3 points, but only 2"});
  expect_refused(bytes.substr(0, 66), {"ends inside a curve's point count"});
}
TEST(BccReader, CountMismatch) { expect_refused(bcc("C0", 2, {kRow}, 5), {"says 8 points, the curves have 3"}); }
TEST(BccReader, BytesLeftOver) { expect_refused(bcc("C0", 2, {kRow}) + "zz", {"2 bytes follow"}); }
TEST(BccReader, NaN) {
  BccCurve bad = kRow;
  bad.points[1][2] = NAN;
  expect_refused(bcc("C0", 2, {bad}), {"curve 0", "point 1 is not finite"});
}
TEST(BccReader, NoCurves) { expect_refused(bcc("C0", 2, {}), {"no curves"}); }
TEST(BccReader, RingOfTwoPoints) {
  BccCurve bad = kRing;
  bad.points.pop_back();
  expect_refused(bcc("C0", 2, {kRow, bad}), {"curve 1", "2 points", "3 are needed"});
}
TEST(BccReader, SwatchEndsWithoutPartner) {
  BccCurve swatch = kRow;
  swatch.points.push_back({1.0f, 0.5f, 1.0f});
  expect_refused(bcc("C0", 2, {swatch}), {"no partner within"});
}

}  // namespace
}  // namespace wale
