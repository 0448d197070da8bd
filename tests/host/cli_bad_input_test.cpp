// What the program says about files that cannot be used.
#include <cmath>
#include <limits>

#include "cli_fixture.h"
#include "host/image.h"

namespace wale::test {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

std::string tile(const std::string& period, const std::string& radius, const std::string& last_point) {
  return "{\"wale_tile\": 1, \"period\": " + period + ", \"yarn_radius\": " + radius +
         ", \"stitches\": [1, 1], \"curves\": [{\"points\": [[0, 0.001, 0], [0.001, 0.001, 0], " + last_point + "]}]}";
}
const std::string kPeriod = "[0.002, 0.002]", kRadius = "0.0003", kEnd = "[0.002, 0.001, 0]";

class CliBadInput : public Cli {
 protected:
  // A scene lit by a 4 x 2 image with one odd value in pixel (2, 1), green.
  std::string environment_scene(float value) {
    Image image{4, 2, {"R", "G", "B"}, std::vector<float>(24, 0.5f)};
    image.at(2, 1)[1] = value;
    write_image(image, folder_ / "sky.exr");
    return write_scene(R"({"generator": "swatch", "width": 20, "height": 20})", R"({"builtin": "stockinette"})",
                       R"("gauge": {"wales": 30})", R"(, "lights": [{"type": "environment", "file": "sky.exr"}])");
  }
};

TEST_F(CliBadInput, MissingScene) {
  EXPECT_TRUE(contains(render_refused(at("none.json")), "none.json: cannot read this file"));
}

TEST_F(CliBadInput, SceneThatIsNotJson) {
  EXPECT_TRUE(
      render_refused(folder_.write("broken.json", "{\"wale\": 1,,").string()).starts_with("wale: broken.json:1:"));
}

TEST_F(CliBadInput, MissingMeshFile) {
  EXPECT_TRUE(contains(render_refused(write_scene("\"none.obj\"")), "fabrics.0.mesh: no file \"none.obj\""));
}

TEST_F(CliBadInput, NotAMesh) {
  EXPECT_TRUE(contains(render_refused(mesh_scene("m.obj", "Dear diary,\n")), "m.obj: not a mesh: no faces"));
}

TEST_F(CliBadInput, MeshFileThatEndsEarly) {
  EXPECT_TRUE(contains(render_refused(mesh_scene("m.off", "OFF\n2000000000 1 0\n0 0 0\n")), "m.off:3: the file ends"));
  EXPECT_LT(seconds_, 20);
}

TEST_F(CliBadInput, MeshWithoutUv) {
  EXPECT_TRUE(contains(render_refused(mesh_scene("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")),
                       "m.obj: the mesh has no UV coordinates"));
}

TEST_F(CliBadInput, MeshWithUvAllZero) {
  EXPECT_TRUE(contains(render_refused(mesh_scene("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n")),
                       "m.obj: every UV triangle has zero area"));
}

TEST_F(CliBadInput, MeshWithNanVertex) {
  EXPECT_TRUE(contains(render_refused(mesh_scene("m.obj", "v 0 0 0\nv 1 nan 0\nv 1 1 0\nf 1 2 3\n")),
                       "m.obj: vertex 2: position is NaN or infinite"));
}

TEST_F(CliBadInput, QuadsAndLargerPolygonsAreAccepted) {
  const Outcome run = run_wale({"build",
                                mesh_scene("m.obj", kSquare + "v 2 0 0\nv 2.5 0.5 0\nv 2 1 0\nvt 2 0\nvt 2.5 0.5\n"
                                                              "vt 2 1\nf 1/1 2/2 3/3 4/4\n"
                                                              "f 2/2 5/5 6/6 7/7 3/3\n"),
                                "--json", "-"},
                               {kNoDevice});  // knitting needs no device
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "\"polygons_split\": 2"));
  EXPECT_TRUE(contains(run.out, "\"triangles\": 5"));
}

TEST_F(CliBadInput, NonManifoldMeshIsAcceptedWithAReport) {
  const Outcome run =
      run_wale({"build", mesh_scene("m.obj", kSquare + "v 0.5 -1 1\nvt 0.5 -1\nv 0.5 -1 -1\nvt 0.5 -2\n"
                                                       "f 1/1 2/2 3/3 4/4\nf 1/1 2/2 5/5\nf 1/1 2/2 6/6\n")},
               {kNoDevice});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "warning    1 non-manifold edges"));
}

TEST_F(CliBadInput, PatternWithAnUnmatchedEndpoint) {
  EXPECT_TRUE(contains(render_refused(tile_scene(tile(kPeriod, kRadius, "[0.0015, 0.0014, 0]"))),
                       "curve 0, first end: no partner within"));
}

TEST_F(CliBadInput, RadiusOfTheTileIsZeroOrNegative) {
  for (const char* radius : {"0", "-0.0003"})
    EXPECT_TRUE(contains(render_refused(tile_scene(tile(kPeriod, radius, kEnd))),
                         "tile.json: yarn_radius: the yarn radius must be positive"));
}

TEST_F(CliBadInput, PeriodOfTheTileIsZeroOrNegative) {
  for (const char* period : {"[0, 0.002]", "[-1, 0.002]"})
    EXPECT_TRUE(contains(render_refused(tile_scene(tile(period, kRadius, kEnd))),
                         "tile.json: period[0]: the period must be positive"));
}

TEST_F(CliBadInput, TileLargerThanTheCloth) {
  EXPECT_TRUE(contains(render_refused(write_scene(R"({"generator": "swatch", "width": 2, "height": 2})",
                                                  R"({"builtin": "stockinette"})", R"("gauge": {"wales": 1})")),
                       "is larger than the cloth of 0.002 x 0.002 m; make it at least"));
}

TEST_F(CliBadInput, MoreSegmentsThanMemoryAreCountedBeforeTheyAreMade) {
  folder_.write("m.obj", kSquare + "f 1/1 2/2 3/3 4/4\n");
  for (const char* repeats : {"\"repeats\": [5000, 5000]", "\"repeats\": [100000, 100000]"}) {
    const std::string line = render_refused(write_scene("\"m.obj\"", R"({"builtin": "stockinette"})", repeats));
    EXPECT_TRUE(contains(line, "fabric \"cloth\": about "));
    EXPECT_TRUE(contains(line, " ply segments would need "));
    EXPECT_TRUE(contains(line, " GB, this machine has "));
    EXPECT_LT(seconds_, 2);
  }
}

TEST_F(CliBadInput, EnvironmentImageWithNan) {
  EXPECT_EQ(render_refused(environment_scene(std::numeric_limits<float>::quiet_NaN())),
            "wale: sky.exr: pixel (2, 1), channel G: nan is not a finite number");
}

TEST_F(CliBadInput, EnvironmentImageWithInfinity) {
  EXPECT_EQ(render_refused(environment_scene(std::numeric_limits<float>::infinity())),
            "wale: sky.exr: pixel (2, 1), channel G: inf is not a finite number");
}

TEST_F(CliBadInput, NegativeValuesOfAnEnvironmentImageAreNamed) {
  const Outcome run = run_wale({"build", environment_scene(-1)}, {kNoDevice});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "sky.exr: 1 negative values (lowest -1) count as 0"));
}

TEST_F(CliBadInput, ImagesOfDifferentSizes) {
  write_image({4, 2, {"R", "G", "B"}, std::vector<float>(24, 0.5f)}, folder_ / "a.exr");
  write_image({2, 4, {"R", "G", "B"}, std::vector<float>(24, 0.5f)}, folder_ / "b.exr");
  EXPECT_EQ(refused({"compare", at("a.exr"), at("b.exr")}),
            "wale: a.exr is 4 x 2, b.exr is 2 x 4: images of one size are needed");
}

TEST_F(CliBadInput, ImageThatIsNone) {
  EXPECT_TRUE(contains(refused({"compare", at("old.png"), at("old.png")}), "old.png: cannot be read as an image"));
  EXPECT_TRUE(contains(refused({"compare", at("none.exr"), at("none.exr")}), "none.exr: no such image file"));
}

}  // namespace
}  // namespace wale::test
