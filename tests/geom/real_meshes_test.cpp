// Figures of real base meshes, against an independent measurement of the same files.
#include <gtest/gtest.h>

#include <cstdlib>

#include "geom/base_mesh.h"
#include "geom/charts.h"
#include "geom/error.h"

namespace wale {
namespace {

class RealMeshes : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("WALE_REAL_DATA");
    if (!folder) GTEST_SKIP() << "real data not present";
    meshes_ = std::filesystem::path(folder) / "meshes";
  }
  std::filesystem::path meshes_;
};

TEST_F(RealMeshes, SockHasThreePanelsAndAlmostMetricUv) {
  const BaseMesh mesh = read_mesh(meshes_ / "madypg/sock_cloth.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.vertices, 2409u);
  EXPECT_EQ(report.triangles, 4772u);
  EXPECT_EQ(report.boundary_edges, 44u);
  EXPECT_EQ(report.non_manifold_edges, 0u);
  EXPECT_EQ(report.seam_edges, 141u);
  EXPECT_EQ(find_charts(mesh).size(), 3u);
  EXPECT_LT(report.overlap, 1e-3);
  EXPECT_NEAR(report.stretch_median.x, 1.11, 0.01);
  EXPECT_NEAR(report.stretch_median.y, 0.99, 0.01);
}

TEST_F(RealMeshes, SpotIsClosedWithThirteenChartsAndFlips) {
  const BaseMesh mesh = read_mesh(meshes_ / "spot/spot_triangulated.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.vertices, 2930u);
  EXPECT_EQ(report.triangles, 5856u);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.seam_edges, 288u);
  EXPECT_EQ(find_charts(mesh).size(), 13u);
  EXPECT_NEAR(report.stretch_median.x, 4.8, 0.1);
  EXPECT_NEAR(report.stretch_median.y, 3.2, 0.1);
  EXPECT_GT(report.flipped_uv, 0u);
}

TEST_F(RealMeshes, QuadsOfSpotFanIntoTriangles) {
  const MeshReport report = validate(read_mesh(meshes_ / "spot/spot_quadrangulated.obj"));
  EXPECT_EQ(report.polygons_split, 2928u);
  EXPECT_EQ(report.triangles, 5856u);
  EXPECT_EQ(report.seam_edges, 288u);
}

TEST_F(RealMeshes, PlaneIsOneChartWithUnitStretch) {
  const BaseMesh mesh = read_mesh(meshes_ / "materialx/mtlx_plane.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.triangles, 1800u);
  EXPECT_EQ(report.seam_edges, 0u);
  EXPECT_EQ(find_charts(mesh).size(), 1u);
  EXPECT_NEAR(report.stretch_median.x, 1, 1e-3);
  EXPECT_NEAR(report.stretch_median.y, 1, 1e-3);
}

TEST_F(RealMeshes, SphereJoinsAcrossItsSeam) {
  const BaseMesh mesh = read_mesh(meshes_ / "materialx/mtlx_sphere.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.triangles, 7080u);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.seam_edges, 178u);
  const auto charts = find_charts(mesh);
  ASSERT_EQ(charts.size(), 1u);
  ASSERT_EQ(charts[0].joins.size(), 1u);
  EXPECT_NEAR(charts[0].joins[0].x, 1, 1e-5);
  EXPECT_EQ(charts[0].joins[0].y, 0);
  EXPECT_NEAR(report.stretch_median.x, 4.4, 0.1);
  EXPECT_NEAR(report.stretch_median.y, 3.1, 0.1);
}

TEST_F(RealMeshes, CubeHasUvOutsideTheUnitSquare) {
  const BaseMesh mesh = read_mesh(meshes_ / "materialx/mtlx_cube.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.seam_edges, 12u);
  const auto charts = find_charts(mesh);
  ASSERT_EQ(charts.size(), 6u);
  dvec2 hi(0);
  for (const Chart& chart : charts) hi = glm::max(hi, chart.uv_max);
  EXPECT_NEAR(hi.x, 2.99, 0.01);
  EXPECT_NEAR(hi.y, 2.01, 0.02);
  EXPECT_EQ(report.overlap, 0);
}

TEST_F(RealMeshes, TeapotOverlapsInHalfOfItsUv) {
  const BaseMesh mesh = read_mesh(meshes_ / "materialx/mtlx_teapot.obj");
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.triangles, 25200u);
  EXPECT_EQ(report.boundary_edges, 360u);
  EXPECT_EQ(report.seam_edges, 210u);
  EXPECT_EQ(find_charts(mesh).size(), 3u);
  EXPECT_NEAR(report.overlap, 0.48, 0.01);
}

TEST_F(RealMeshes, BigEndianPlyWithoutUvIsReadButRefusedAsCloth) {
  const BaseMesh mesh = read_mesh(meshes_ / "ipc-toolkit/cloth_ball92.ply");
  EXPECT_EQ(mesh.position.size(), 46598u);
  EXPECT_EQ(mesh.triangle.size(), 92230u);
  try {
    require_uv(mesh);
    FAIL() << "a mesh without UV was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::user);
    EXPECT_NE(std::string(error.what()).find("no UV"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace wale
