// Explicit fibres and flyaways of a knitted fabric: where they lie, how finely they are sampled, how many there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geom/base_mesh_generators.h"
#include "geom/error.h"
#include "geom/fabric.h"
#include "geom/fabric_map.h"
#include "geom/fibre_bundle.h"
#include "geom/mesh_edges.h"
#include "geom/ply_frames.h"
#include "geom/stored_length.h"
#include "geom/warp.h"
#include "shared/wale_types.h"

namespace wale {
namespace {

FabricSpec spec_of(Detail detail) {
  FabricSpec spec;
  spec.name = "fibrous";
  spec.scale.kind = FabricScale::Kind::uv_metres;
  spec.detail = detail;
  spec.fibres.fibres = 23;
  spec.fibres.twist = 0.35;
  return spec;
}

BaseMesh cloth() { return make_swatch(0.012, 0.01, 4, 4); }

std::string refusal(const FabricSpec& spec) {
  try {
    knit_fabric(cloth(), stockinette_pattern(), spec);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::user);
    return error.what();
  }
  return "nothing was refused";
}

dvec3 place(const Fabric& fabric, const Anchor& a) {
  return warp_point(fabric.mesh, {a.triangle, a.b1, a.b2, 0}, a.height);
}

TEST(Fibres, EveryPlyBecomesItsFibresInFullGroups) {
  const Fabric plies = knit_fabric(cloth(), stockinette_pattern(), spec_of(Detail::maps));
  const Fabric fibres = knit_fabric(cloth(), stockinette_pattern(), spec_of(Detail::fibres));
  EXPECT_EQ(plies.report.fibres, 0u);
  EXPECT_EQ(plies.fibre_radius, 0);
  EXPECT_EQ(fibres.report.plies, 0u);
  EXPECT_EQ(fibres.report.fibres, 23 * plies.report.plies);
  EXPECT_NEAR(fibres.fibre_radius, std::sqrt(0.5 / 23) * fibres.ply_radius, 1e-12);
  size_t short_groups = 0, vertices = 0, segments = 0;
  for (const PlyRun& run : fibres.runs) {
    EXPECT_EQ(run.kind, PlyRun::Kind::fibre);
    EXPECT_FLOAT_EQ(run.radius, float(fibres.fibre_radius));
    EXPECT_LE(run.plies, kFibreGroup);
    short_groups += run.plies < kFibreGroup;
    vertices += size_t(run.plies) * run.count;
    segments += size_t(run.plies) * (run.count - 1);
  }
  EXPECT_EQ(short_groups, plies.report.plies);  // 23 = 5 * 4 + 3
  EXPECT_EQ(vertices, fibres.anchors.size());
  EXPECT_EQ(segments, fibres.report.segments);
  const double estimate = double(estimate_segments(cloth(), stockinette_pattern(), spec_of(Detail::fibres)));
  EXPECT_NEAR(estimate / double(segments), 1, 0.25);
}

TEST(Fibres, GroupsHoldNeighbours) {
  FibreRecipe recipe;
  recipe.fibres = 75;
  const FibreBundle bundle(recipe, 1);
  std::vector<uint32_t> order, first;
  bundle.groups(4, order, first);
  ASSERT_EQ(first.front(), 0u);
  ASSERT_EQ(first.back(), 75u);
  EXPECT_EQ(first.size(), 20u);  // 18 of four and one of three
  std::vector<uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t i = 0; i < 75; ++i) EXPECT_EQ(sorted[i], i);
  double widest = 0;
  for (size_t g = 0; g + 1 < first.size(); ++g)
    for (uint32_t i = first[g]; i < first[g + 1]; ++i)
      for (uint32_t j = first[g]; j < i; ++j)
        widest = std::max(widest, glm::length(bundle.offset(order[i], 0, 0) - bundle.offset(order[j], 0, 0)));
  EXPECT_LT(widest, 1.0);  // of a section 2 wide
}

// The curve of a fibre between two samples, made from a knit sixteen times as fine.
TEST(Fibres, PolylinesKeepToTheirTolerance) {
  for (const double twist : {0.0, 0.35, -0.8})
    for (const double migration : {1.0, 0.5}) {
      const Pattern pattern = stockinette_pattern();
      FabricSpec spec = spec_of(Detail::fibres);
      spec.fibres.twist = twist;
      spec.fibres.migration_min = migration;
      const BaseMesh mesh = cloth();
      const FabricMap map = map_fabric(mesh, find_charts(mesh), pattern, spec);
      YarnSpec fine = map.yarn;
      fine.tolerance /= 256;
      const FibreBundle bundle(spec.fibres, map.yarn.ply_radius);
      // Chords are shorter than arcs: lengths are brought to those of the coarse knit, so that both wind alike.
      double whole = 0;
      const auto fibre = [&](const YarnSpec& yarn_spec) {
        std::vector<dvec3> points;
        bool done = false;
        knit_flat(pattern, match_partners(pattern), yarn_spec, map.charts[0].scale, map.charts[0].rect,
                  [&](FlatYarn&& yarn) {
                    if (std::exchange(done, true)) return;
                    const size_t count = yarn.centre.size();
                    if (whole == 0) whole = yarn.length[count - 1];
                    for (size_t k = 0; k < count; ++k) {
                      const double l = yarn.length[k] * whole / yarn.length[count - 1];
                      const dvec2 at = bundle.offset(3, l, bundle.migration_per_metre(0));
                      const dvec3 n = yarn.normal[k];
                      points.push_back(yarn.position[k] + at.x * n + at.y * glm::cross(ply_tangent(yarn, 0, k), n));
                    }
                  });
        return points;
      };
      const std::vector<dvec3> coarse = fibre(map.yarn), curve = fibre(fine);
      ASSERT_GT(curve.size(), 8 * coarse.size());
      double worst = 0;
      for (size_t i = curve.size() / 4; i < curve.size() / 2; i += 3) {
        double nearest = 1e9;
        for (size_t k = 0; k + 1 < coarse.size(); ++k) {
          const dvec3 ab = coarse[k + 1] - coarse[k], d = curve[i] - coarse[k];
          const double t = std::clamp(glm::dot(d, ab) / glm::dot(ab, ab), 0.0, 1.0);
          nearest = std::min(nearest, glm::length(d - t * ab));
        }
        worst = std::max(worst, nearest);
      }
      EXPECT_LE(worst, kFibreTolerance * bundle.fibre_radius()) << twist << " " << migration;
    }
}

TEST(Fibres, OfClosedYarnsMeetTheirStart) {
  for (const double migration : {1.0, 0.6}) {
    FabricSpec spec = spec_of(Detail::fibres);
    spec.fibres.migration_min = migration;
    const Fabric fabric = knit_fabric(make_tube(0.006, 0.012, 48, 12), stockinette_pattern(), spec);
    size_t closed = 0;
    for (const PlyRun& run : fabric.runs) {
      if (!run.ghost_ends) continue;
      for (uint32_t p = 0; p < run.plies; ++p, ++closed) {
        const Anchor* a = fabric.anchors.data() + run.first_vertex + p * run.count;
        double longest = 0, rest = 0;
        for (uint32_t k = 1; k + 2 < run.count; ++k) {
          rest = std::max(rest, length_between(a[k].length, a[k + 1].length, fabric.ply_radius));
          longest = std::max(longest, glm::length(place(fabric, a[k + 1]) - place(fabric, a[k])));
        }
        const double seam = glm::length(place(fabric, a[run.count - 2]) - place(fabric, a[run.count - 3]));
        EXPECT_LE(seam, longest);
        EXPECT_LT(longest, 1.6 * rest);
      }
    }
    EXPECT_GT(closed, 100u);
  }
}

double ply_metres(const Fabric& fabric) {
  double sum = 0;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; run.kind == PlyRun::Kind::ply && p < run.plies; ++p)
      for (uint32_t k = run.ghost_ends ? 1 : 0; k + 1 + run.ghost_ends < run.count; ++k) {
        const Anchor* a = fabric.anchors.data() + run.first_vertex + p * run.count + k;
        sum += length_between(a[0].length, a[1].length, fabric.ply_radius);
      }
  return sum;
}

TEST(Flyaways, AreAsManyAsTheirDensitySays) {
  for (const BaseMesh& mesh : {cloth(), make_tube(0.006, 0.012, 48, 12)})
    for (const auto& [hairs, loops] : {std::pair(3000.0, 0.0), std::pair(0.0, 2500.0), std::pair(1000.0, 777.0)}) {
      FabricSpec spec = spec_of(Detail::maps);
      spec.flyaways.hairs = hairs;
      spec.flyaways.loops = loops;
      const Fabric fabric = knit_fabric(mesh, stockinette_pattern(), spec);
      const double wanted = (hairs + loops) * ply_metres(fabric);
      // Each piece of a ply rounds once for each kind, and closed plies are measured up to 2 % longer or shorter.
      const double pieces = double(fabric.report.plies) * ((hairs > 0) + (loops > 0));
      EXPECT_NEAR(double(fabric.report.flyaways), wanted, pieces + 0.02 * wanted);
      EXPECT_EQ(fabric.report.fibres, fabric.report.flyaways);
      const size_t estimate = estimate_segments(mesh, stockinette_pattern(), spec);
      EXPECT_NEAR(double(estimate) / double(fabric.report.segments), 1, 0.5);
    }
}

TEST(Flyaways, AreThinCurvesOnTheClothThatCellsKnow) {
  FabricSpec spec = spec_of(Detail::maps);
  spec.flyaways.hairs = spec.flyaways.loops = 2000;
  spec.flyaways.length = 0.0015;
  spec.flyaways.radius = 6e-6;
  const Fabric fabric = knit_fabric(cloth(), stockinette_pattern(), spec);
  const double half = 0.5 * std::min(fabric.report.stitch_metres.x, fabric.report.stitch_metres.y);
  double length = 0;
  size_t hairs = 0;
  for (const PlyRun& run : fabric.runs) {
    if (run.kind == PlyRun::Kind::ply) continue;
    EXPECT_EQ(run.plies, 1u);
    EXPECT_FLOAT_EQ(run.radius, 6e-6f);
    EXPECT_FALSE(run.ghost_ends);
    EXPECT_GE(run.count, 2u);
    const Anchor* a = fabric.anchors.data() + run.first_vertex;
    const dvec3 first = place(fabric, a[0]), last = place(fabric, a[run.count - 1]);
    ++hairs;
    length += glm::length(last - first);
    for (uint32_t k = 0; k < run.count; ++k) {
      const dvec3 p = place(fabric, a[k]);
      ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
      if (k < 2) continue;
      EXPECT_GT(p.x, -0.006 - 1.001 * half - 0.012);
      const dvec2 over = glm::max(glm::abs(dvec2(p)) - dvec2(0.012, 0.01), dvec2(0));
      EXPECT_LE(glm::length(over), 1.001 * half);
    }
  }
  EXPECT_EQ(hairs, fabric.report.flyaways);
  EXPECT_GT(length / double(hairs), 2e-4);
  std::vector<bool> listed(fabric.anchors.size());
  for (const uint32_t id : fabric.cell_segments.item) listed[id] = true;
  for (const PlyRun& run : fabric.runs)
    for (uint32_t p = 0; p < run.plies; ++p)
      for (uint32_t k = 0; k + 1 < run.count; ++k) ASSERT_TRUE(listed[run.first_vertex + p * run.count + k]);
}

TEST(Flyaways, HairsHaveTheLengthThatIsAskedFor) {
  PlyPiece piece;
  for (int i = 0; i <= 1000; ++i) {
    piece.position.push_back(dvec3(1e-3 * i, 0, 0));
    piece.normal.push_back(dvec3(0, 0, 1));
    piece.tangent.push_back(dvec3(1, 0, 0));
    piece.length.push_back(1e-3 * i);
  }
  piece.radius = 2e-4;
  for (const double length : {0.0, 2.2 * 2e-4, 0.003}) {
    const std::vector<Flyaway> hairs = make_flyaways(piece, {5000, 0, length, 0}, 1e-6);
    EXPECT_EQ(hairs.size(), 5000u);
    double mean = 0;
    for (const Flyaway& hair : hairs) {
      for (size_t k = 1; k < hair.points.size(); ++k)
        mean += glm::distance(hair.points[k - 1], hair.points[k]) / double(hairs.size());
      const dvec3 root = hair.points[0];
      EXPECT_LE(std::hypot(root.y, root.z), 1.0001 * piece.radius);  // it grows from inside the ply
    }
    EXPECT_NEAR(mean / (length > 0 ? length : 2.2 * piece.radius), 1, 0.1) << length;
  }
}

TEST(Flyaways, DoNotDependOnHowThePlyIsCut) {
  PlyPiece whole;
  for (int i = 0; i <= 400; ++i) {
    whole.position.push_back(dvec3(1e-4 * i, 0, 0));
    whole.normal.push_back(dvec3(0, 0, 1));
    whole.tangent.push_back(dvec3(1, 0, 0));
    whole.length.push_back(1e-4 * i);
  }
  whole.radius = 2e-4;
  whole.key = 99;
  PlyPiece left = whole, right = whole;
  for (auto* part : {&left.position, &left.normal, &left.tangent}) part->resize(151);
  left.length.resize(151);
  for (auto* part : {&right.position, &right.normal, &right.tangent}) part->erase(part->begin(), part->begin() + 150);
  right.length.erase(right.length.begin(), right.length.begin() + 150);
  const FlyawaySpec spec{2000, 0, 0, 0};
  const auto all = make_flyaways(whole, spec, 1e-6);
  auto parts = make_flyaways(left, spec, 1e-6);
  const size_t in_left = parts.size();
  for (auto& f : make_flyaways(right, spec, 1e-6)) parts.push_back(f);
  ASSERT_EQ(all.size(), parts.size());
  EXPECT_GT(in_left, 10u);
  for (size_t i = 0; i < all.size(); ++i) EXPECT_LT(glm::distance(all[i].points.back(), parts[i].points.back()), 1e-12);
}

TEST(Fibres, SenselessRecipesAreRefused) {
  const auto with = [](auto&& change) {
    FabricSpec spec = spec_of(Detail::fibres);
    change(spec);
    return refusal(spec);
  };
  EXPECT_NE(with([](auto& s) { s.fibres.fibres = 0; }).find("count is 0; give 1 to 4096"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.fibres.packing = 0.9; }).find("packing is 0.9"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.fibres.migration_min = 0; }).find("migration"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.flyaways.hairs = -1; }).find("'fibrous': flyaways: hairs per metre is -1"),
            std::string::npos);
  EXPECT_NE(with([](auto& s) { s.flyaways.loops = NAN; }).find("loops per metre is nan"), std::string::npos);
  EXPECT_NE(with([](auto& s) { s.flyaways.length = 1; }).find("length in metres is 1; give 0 to 0.1"),
            std::string::npos);
  EXPECT_NE(with([](auto& s) { s.flyaways.radius = -1e-6; }).find("radius in metres"), std::string::npos);
}

}  // namespace
}  // namespace wale
