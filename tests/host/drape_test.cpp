// The generator of the drape's frames: cloth that falls, hangs, and goes neither through the ball nor through itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "scenes/drape/cloth.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

using drape::Cloth;

/// Layers are kept apart at particles: no nearer to each other than cloth is thick.
drape::Setup coarse() {
  drape::Setup setup;
  setup.cells = 60;
  setup.thickness = 1.5 * setup.size / setup.cells;
  return setup;
}

bool crosses(const dvec3& from, const dvec3& to, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 d = to - from, ab = b - a, ac = c - a, n = glm::cross(ab, ac);
  const double det = -glm::dot(d, n);
  if (det == 0) return false;
  const dvec3 ao = from - a, dao = glm::cross(ao, d);
  const double t = glm::dot(ao, n) / det, u = glm::dot(ac, dao) / det, v = -glm::dot(ab, dao) / det;
  return t >= 0 && t <= 1 && u >= 0 && v >= 0 && u + v <= 1;
}

/// Edges that go through a triangle with which they share no corner.
size_t crossings(const BaseMesh& mesh, const std::vector<dvec3>& x) {
  const double size = 0.01;
  const auto cell = [&](const dvec3& p) {
    return std::array{int(std::floor(p.x / size)), int(std::floor(p.y / size)), int(std::floor(p.z / size))};
  };
  std::map<std::array<int, 3>, std::vector<uint32_t>> cells;
  const auto each_cell = [&](const std::array<uint32_t, 3>& t, const auto& visit) {
    const auto lo = cell(glm::min(x[t[0]], glm::min(x[t[1]], x[t[2]]))),
               hi = cell(glm::max(x[t[0]], glm::max(x[t[1]], x[t[2]])));
    for (int i = lo[0]; i <= hi[0]; ++i)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int k = lo[2]; k <= hi[2]; ++k) visit(cells[{i, j, k}]);
  };
  for (uint32_t t = 0; t < mesh.triangle.size(); ++t)
    each_cell(mesh.triangle[t], [&](auto& list) { list.push_back(t); });
  size_t found = 0;
  for (const auto& t : mesh.triangle)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[size_t(k)], b = t[size_t(k + 1) % 3];
      bool meets = false;
      each_cell({a, b, b}, [&](const auto& list) {
        for (const uint32_t other : list) {
          const auto& o = mesh.triangle[other];
          if (std::count(o.begin(), o.end(), a) + std::count(o.begin(), o.end(), b)) continue;
          meets |= crosses(x[a], x[b], x[o[0]], x[o[1]], x[o[2]]);
        }
      });
      found += meets;
    }
  return found;
}

TEST(Drape, ComesToRestAndNothingGoesThroughAnything) {
  const drape::Setup setup = coarse();
  Cloth cloth(setup);
  const BaseMesh mesh = cloth.rest();
  const double reach = setup.radius + 0.5 * setup.thickness, spacing = setup.size / setup.cells;
  std::vector<dvec3> before;
  for (int frame = 0; frame < 80; ++frame, cloth.advance()) {
    const std::vector<dvec3>& x = cloth.positions();
    if (frame % 2 == 0) {
      EXPECT_EQ(crossings(mesh, x), 0u) << "frame " << frame;
    }
    double nearest = 1, longest = 0;  // of the middles of triangles, and of threads
    for (const auto& t : mesh.triangle) {
      nearest = std::min(nearest, glm::length((x[t[0]] + x[t[1]] + x[t[2]]) / 3.0));
      if (glm::length(mesh.position[t[1]] - mesh.position[t[0]]) < 1.2 * spacing)
        longest = std::max(longest, glm::length(x[t[1]] - x[t[0]]) / spacing);
    }
    EXPECT_GT(nearest, reach - 0.1 * setup.thickness) << "frame " << frame;
    EXPECT_LT(longest, 1.1) << "frame " << frame;
    before = x;
  }
  double fastest = 0, highest = -1, lowest = 1;
  for (size_t i = 0; i < before.size(); ++i) {
    fastest = std::max(fastest, glm::length(cloth.positions()[i] - before[i]) / setup.frame_seconds);
    highest = std::max(highest, before[i].z), lowest = std::min(lowest, before[i].z);
  }
  EXPECT_LT(fastest, 0.15) << "metres per second";
  EXPECT_NEAR(highest, reach, 0.1 * setup.thickness);
  EXPECT_LT(lowest, -0.5 * setup.radius) << "corners hang";
}

TEST(Drape, ClothSinkingIntoItselfWouldBeSeen) {
  Cloth cloth(coarse());
  const BaseMesh mesh = cloth.rest();
  std::vector<dvec3> folded = cloth.positions();
  for (dvec3& p : folded)
    if (p.x > 0) p = dvec3(-p.x + 0.01, p.y, p.z - 0.3 * p.x + 0.01);
  EXPECT_GT(crossings(mesh, folded), 10u);
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int run_drape(const std::filesystem::path& out, const std::string& args) {
  return std::system(("\"" WALE_DRAPE_PROGRAM "\" \"" + out.string() + "\" " + args + " 2> /dev/null").c_str());
}

TEST(Drape, ProgramWritesTheSameFramesAgain) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) ASSERT_EQ(run_drape(folder / name, "6 20"), 0);
  EXPECT_EQ(bytes_of(folder / "a.pc2").size(), 32u + 6 * 21 * 21 * 12);
  EXPECT_EQ(bytes_of(folder / "a.pc2"), bytes_of(folder / "b.pc2"));
  EXPECT_EQ(bytes_of(folder / "a.obj"), bytes_of(folder / "b.obj"));
  EXPECT_NE(run_drape(folder / "c", "0"), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "c.obj"));
}

}  // namespace
}  // namespace wale::test
