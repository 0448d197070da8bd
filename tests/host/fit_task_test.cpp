// What `wale fit` is asked for, and when an earlier run of it is another fit.
#include "host/fit/task.h"
#include "tests/host/fit_pictures.h"
#include "tests/temporary_folder.h"

namespace wale::fit {
namespace {

class FitTaskTest : public testing::Test {
 protected:
  FitTaskTest() {
    args_.scene = folder_.write("s.json", R"({"wale": 1, "film": {"size": [64, 64]},
 "fabrics": [{"name": "cloth", "mesh": "cloth.obj", "pattern": "tile.json", "gauge": {"wales": 40}, "material": "yarn"},
             {"name": "hem", "mesh": {"generator": "swatch", "width": 0.1, "height": 0.1},
              "pattern": {"builtin": "rib_1x1"}, "gauge": {"wales": 40}, "material": "other",
              "color_image": {"file": "colors.png"}}],
 "objects": [{"name": "table", "type": "mesh", "mesh": {"frames": "table_###.obj", "first": 3}}],
 "materials": {"yarn": {"type": "ply", "file": "yarn.json"}, "other": {"type": "ply", "file": "other.json"}},
 "lights": [{"name": "front", "type": "sphere", "position": [0, 1, 1], "radius": 0.1, "radiance": 60},
            {"name": "back", "type": "mesh", "mesh": "lamp.obj", "radiance": 60},
            {"name": "sky", "type": "environment", "file": "sky.hdr"}]})");
    // A fit is told apart before any of these but the materials is read.
    for (const char* file : {"cloth.obj", "tile.json", "colors.png", "table_003.obj", "lamp.obj", "sky.hdr"})
      folder_.write(file, "as it was");
    folder_.write("yarn.json", R"({"type": "ply", "preset": "wool", "color": [0.5, 0.5, 0.5]})");
    folder_.write("other.json", R"({"type": "ply", "preset": "wool", "heather": {"yarn": 0.1}})");
    args_.material = "yarn";
    args_.resolution = 1;
    args_.front = folder_.write("front.ppm", photograph(0.4));
    args_.back = folder_.write("back.ppm", photograph(0.2));
  }
  static std::string photograph(double shade) {
    const Picture cloth = stitches(64, 64, 0, shade);
    return ppm(64, 64, 16, [&](int x, int y, int c) { return int(65535 * double(cloth.at(x, y)[c])); });
  }
  std::string identity() const { return identity_of(args_, read_task(args_)); }

  FitArgs args_;
  TemporaryFolder folder_;
};

TEST_F(FitTaskTest, EveryFileThatIsReadTellsFitsApart) {
  const std::string before = identity();
  EXPECT_EQ(identity(), before);
  for (const char* name : {"cloth.obj", "tile.json", "colors.png", "table_003.obj", "lamp.obj", "sky.hdr"}) {
    folder_.write(name, "as it is");
    EXPECT_NE(identity(), before) << name;
    folder_.write(name, "as it was");
    EXPECT_EQ(identity(), before) << name;
  }
  const auto changed = [&](const std::string& name, const std::string& text) {
    const std::string was = file_text(folder_ / name);
    folder_.write(name, text);
    EXPECT_NE(identity(), before) << name;
    folder_.write(name, was);
  };
  changed("yarn.json", R"({"type": "ply", "preset": "silk", "color": [0.5, 0.5, 0.5]})");
  changed("other.json", R"({"type": "ply", "preset": "wool", "heather": {"yarn": 0.2}})");
  changed("front.ppm", photograph(0.41));
  EXPECT_EQ(identity(), before);
}

TEST_F(FitTaskTest, EveryAccuracySettingTellsFitsApart) {
  const std::string before = identity();
  for (const char* text : {"integrator.max_depth=4", "integrator.ply_lobes=paper", "fabrics.0.detail=none",
                           "fabrics.1.tolerance=0.2", "fabrics.0.lattice=2"}) {
    args_.set = {text};
    EXPECT_NE(identity(), before) << text;
  }
  // Two fabrics that differ from each other, this way or that.
  args_.set = {"fabrics.0.tolerance=0.2"};
  const std::string one = identity();
  args_.set = {"fabrics.1.tolerance=0.2"};
  EXPECT_NE(identity(), one);
  // What serves speed alone does not.
  args_.set = {"integrator.lanes=8", "integrator.pool=4096"};
  EXPECT_EQ(identity(), before);
}

TEST_F(FitTaskTest, TwistOfYarnWithoutAnyIsRefused) {
  args_.parameters = "twist_pitch";
  args_.set = {"fabrics.0.yarn.twist_pitch=0"};
  EXPECT_NE(user_message([&] { identity(); }).find("fabrics.0.yarn.twist_pitch: 0 is"), std::string::npos);
  args_.set = {"fabrics.0.yarn.twist_pitch=-8"};
  EXPECT_NO_THROW(identity());
}

}  // namespace
}  // namespace wale::fit
