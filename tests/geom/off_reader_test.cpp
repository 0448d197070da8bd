// OFF: what stands behind a place or a face, and is not meant for the next one.
#include <gtest/gtest.h>

#include "geom/polygon_soup.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

BaseMesh read(const std::string& text) { return triangulate(parse_off(text, "a.off"), "a.off"); }

// Colours and comments behind a face belong to it alone.
TEST(Off, FacesKeepTheirColoursToThemselves) {
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  for (const char* more : {"", " 255 0 0", " 0.5 0.5 0.5 1", " 4", " 0 0 -2", " # red", " #4 0 1 2 3"}) {
    const BaseMesh mesh = read("OFF\n4 2 0\n" + points + "3 0 1 2" + more + "\n3 0 2 3" + more + "\n");
    ASSERT_EQ(mesh.triangle.size(), 2u) << more;
    EXPECT_EQ(mesh.triangle[1], (std::array<uint32_t, 3>{0, 2, 3})) << more;
  }
  // A colour is not the number of the next face's corners: OpenMesh took -2 for four thousand million of them.
  EXPECT_NE(user_message([&] { read("OFF\n4 2 0\n" + points + "0 0 -2\n1 0 0 -2\n"); }).find("no faces"),
            std::string::npos);
}

TEST(Off, NormalsColoursAndTexture) {
  const BaseMesh mesh =
      read("STCNOFF\n3 1 0\n0 0 0.1 0 0 1 255 0 0 0.25 0\n1 0 0.1 0 0 1 7 1 0.5\n0 1 0.1 0 0 1 0 0.75\n3 0 1 2\n");
  ASSERT_EQ(mesh.uv.size(), 1u);
  EXPECT_EQ(mesh.uv[0][0], dvec2(0.25, 0));
  EXPECT_EQ(mesh.uv[0][1], dvec2(1, 0.5));
  EXPECT_EQ(mesh.uv[0][2], dvec2(0, 0.75));
  EXPECT_EQ(mesh.position[1], dvec3(1, 0, 0.1)) << "read in double";
  for (const char* magic : {"-OFF", "4OFF", "nOFF", "CSTOFF", "COFFF"})
    EXPECT_EQ(user_message([&] { read(std::string(magic) + "\n0 0 0\n"); }),
              "a.off: not a mesh that can be read; give a complete OBJ, PLY or OFF file");
}

}  // namespace
}  // namespace wale
