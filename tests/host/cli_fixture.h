#pragma once
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/run_program.h"
#include "tests/temporary_folder.h"

namespace wale::test {

inline const std::string kNoDevice = "OCL_ICD_VENDORS=/nonexistent-empty-dir";

/// A folder with a small scene (scene.json) and an older picture (old.png) that no failure may touch.
class Cli : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = write_scene(R"({"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4})");
    folder_.write("old.png", kOld);
  }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  std::string write_scene(const std::string& mesh, const std::string& pattern = R"({"builtin": "stockinette"})",
                          const std::string& scale = R"("gauge": {"wales": 30})", const std::string& more = "") {
    return folder_
        .write("scene.json", R"({"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60], "look_at": [0, 0, 0]},
 "film": {"size": [16, 16]},
 "fabrics": [{"name": "cloth", "mesh": )" +
                                 mesh + R"(, "pattern": )" + pattern + ", " + scale + "}]" + more + "}\n")
        .string();
  }

  /// The scene over a mesh file of this text.
  std::string mesh_scene(const std::string& name, const std::string& text) {
    folder_.write(name, text);
    return write_scene("\"" + name + "\"", R"({"builtin": "stockinette"})", R"("repeats": [8, 8])");
  }
  /// The scene with a tile file of this text.
  std::string tile_scene(const std::string& tile) {
    folder_.write("tile.json", tile);
    return write_scene(R"({"generator": "swatch", "width": 20, "height": 20})", "\"tile.json\"", "\"uv_metres\": true");
  }

  /// Runs the program, which must refuse: the status, one line of complaint, no new file, the old picture untouched.
  /// Returns that line without the folder's name.
  std::string refused(const std::vector<std::string>& args, int status = 1,
                      const std::vector<std::string>& environment = {}) {
    const size_t files = folder_.files();
    const Outcome run = run_wale(args, environment);
    seconds_ = run.seconds;
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_EQ(folder_.files(), files) << "something was left behind";
    EXPECT_EQ(file_text(folder_ / "old.png"), kOld);
    const auto lines = run.complaints();
    if (lines.size() != 1 || !lines[0].starts_with("wale: ")) {
      ADD_FAILURE() << "one line was expected, not:\n" << run.err;
      return "";
    }
    std::string line = lines[0];
    const std::string folder = folder_.path().string() + "/";
    for (size_t i; (i = line.find(folder)) != std::string::npos;) line.erase(i, folder.size());
    return line;
  }
  std::string render_refused(const std::string& scene) { return refused({"render", scene, "-o", at("old.png")}); }

  static constexpr const char* kOld = "an older picture";
  TemporaryFolder folder_;
  std::string scene_;
  double seconds_ = 0;  ///< of the last refused()
};

inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

}  // namespace wale::test
