// Samples that are not finite are counted, told and end the editor with a fault; a picture without them is still shown.
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

}  // namespace
}  // namespace wale::test
