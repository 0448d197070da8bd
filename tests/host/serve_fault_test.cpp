// Samples that are not finite are counted, told and end the editor with a fault; a picture without them is still shown.
#include <unistd.h>

#include "host/json_document.h"
#include "host/serve/http_server.h"
#include "tests/host/serve_client.h"

namespace wale::test {
namespace {

class ServeFault : public Cli {
 protected:
  // The newest message `cost` that has come when `text` has; null when there is none.
  static JsonNode cost(const Served& served, const std::string& text) {
    const std::string stream = served.watch(text, 120);
    const size_t begin = stream.rfind("{\"status\": \""), end = stream.find('}', begin);
    EXPECT_NE(end, std::string::npos) << stream.size();
    return end == std::string::npos ? JsonNode{} : parse_json(stream.substr(begin, end + 1 - begin), "cost");
  }
};

TEST_F(ServeFault, SamplesThatAreNotFiniteAreTold) {
  if (!has_http_library()) GTEST_SKIP() << "built without cpp-httplib";
  // Kernels with a fault: seen from beyond 50 mm, one pixel in eight has samples that are not finite.
  std::filesystem::copy(std::filesystem::path(WALE_SOURCE_DIR) / "kernels", folder_ / "kernels",
                        std::filesystem::copy_options::recursive);
  const std::string file = at("kernels/stages/accumulate.cl"), place = "    value.w = 1.0f;\n";
  std::string text = file_text(file);
  ASSERT_NE(text.find(place), std::string::npos);
  text.insert(text.find(place) + place.size(), "    if (camera.origin.z > 0.05f && x % 8 == 0) value.x = NAN;\n");
  folder_.write("kernels/stages/accumulate.cl", text);
  Served served(folder_.path(), {scene_, "--quiet", "--size", "32x32", "--kernel-dir", at("kernels")});
  ASSERT_TRUE(served.up()) << served.process().err();
  const JsonNode first = cost(served, "\"status\": \"rendering\", \"revision\": 1, \"samples\": 2,");
  ASSERT_TRUE(first.has("not_finite"));
  EXPECT_GT(first["not_finite"].number, 0);
  EXPECT_EQ(first["not_finite_since_start"].number, first["not_finite"].number);
  EXPECT_TRUE(contains(served.process().err(), "wale: render: "));
  EXPECT_TRUE(contains(served.process().err(), "samples so far were not finite; the pictures are without them"));
  // A version without any: those of the one before, which has left the device, are not forgotten.
  ASSERT_EQ(served.post("/edit", R"({"set": ["camera.position=[0, 0, 40]"]})").status, 200);
  const JsonNode second = cost(served, "\"status\": \"rendering\", \"revision\": 2, \"samples\": 2,");
  ASSERT_TRUE(second.has("not_finite"));
  EXPECT_EQ(second["not_finite"].number, 0);
  EXPECT_GE(second["not_finite_since_start"].number, first["not_finite"].number);
  EXPECT_EQ(served.post("/stop", "{}").status, 200);
  EXPECT_EQ(served.process().wait(30), 3);
  EXPECT_TRUE(contains(served.process().err(), "samples were not finite; the pictures were shown without them"));
}

// A file of the scene is damaged while the editor runs: the fault is told, the editor stays, and when the file is whole
// again an edit goes on.
TEST_F(ServeFault, ADamagedFileIsToldAndSurvived) {
  if (!has_http_library()) GTEST_SKIP() << "built without cpp-httplib";
  const std::string whole = "v -9 -9 -2\nv 9 -9 -2\nv 0 9 -2\nf 1 2 3\n";
  folder_.write("prop.obj", whole);
  write_scene(R"({"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4})",
              R"({"builtin": "stockinette"})", R"("gauge": {"wales": 30})",
              R"(, "objects": [{"type": "mesh", "mesh": "prop.obj"}],
 "lights": [{"type": "sphere", "position": [0, 0, 50], "radius": 5, "radiance": 50}])");
  Served served(folder_.path(), {scene_, "--quiet", "--size", "32x32"});
  ASSERT_TRUE(served.up()) << served.process().err();
  const auto revision = [&] {
    const std::string state = served.ask("GET", "/state").body;
    const size_t begin = state.find("\"revision\": ");
    return begin == std::string::npos ? -1 : std::stoi(state.substr(begin + 12));
  };
  const auto rendering = [&] {  // a goal that takes long keeps it at that
    return !served.watch(fmt::format("\"status\": \"rendering\", \"revision\": {},", revision()), 60).empty();
  };
  const auto state_has = [&](const std::string& text) {
    for (int i = 0; i < 600; ++i, ::usleep(50000))
      if (served.ask("GET", "/state").body.find(text) != std::string::npos) return true;
    return false;
  };
  const std::string fault = "prop.obj: not a mesh";
  ASSERT_EQ(served.post("/control", R"({"control": "view.goal", "value": "0.01"})").status, 200);
  ASSERT_EQ(served.post("/edit", R"({"set": ["film.exposure=1"]})").status, 200);
  ASSERT_TRUE(rendering());
  // While two views take turns on the device.
  ASSERT_EQ(served.post("/control", R"({"control": "view.lit", "value": "both"})").status, 200);
  ASSERT_TRUE(rendering());
  folder_.write("prop.obj", "no mesh");
  EXPECT_TRUE(state_has(fault)) << served.ask("GET", "/state").body << served.process().err();
  // An edit waits for the file, as it is not to blame, and nothing is tried again and again.
  const std::string more = "\"edits\": [\"film.exposure=1\", \"camera.fov=30\"]";
  const int then = revision();
  EXPECT_EQ(served.post("/edit", R"({"set": ["film.exposure=1", "camera.fov=30"]})").status, 200);
  EXPECT_TRUE(state_has(fault));
  ::usleep(300000);
  EXPECT_EQ(revision(), then + 1);
  EXPECT_TRUE(contains(served.ask("GET", "/state").body, more));
  EXPECT_TRUE(contains(served.ask("GET", "/state").body, "\"can_undo\": true"));
  std::filesystem::remove(folder_ / "prop.obj");  // now the schema misses it
  EXPECT_EQ(served.post("/edit", R"({"set": ["camera.fov=31"]})").status, 400);
  EXPECT_EQ(served.post("/control", R"({"control": "view.lit", "value": "back"})").status, 200);
  EXPECT_TRUE(state_has("no file"));
  folder_.write("prop.obj", whole);
  EXPECT_EQ(served.post("/edit", R"({"set": ["camera.fov=32"]})").status, 200);
  EXPECT_TRUE(rendering());
  EXPECT_TRUE(state_has("\"fault\": null"));
  EXPECT_EQ(served.post("/stop", "{}").status, 200);
  EXPECT_EQ(served.process().wait(30), 0);
}

}  // namespace
}  // namespace wale::test
