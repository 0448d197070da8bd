// Edits that pass the schema and cannot be shown: what goes back, what stays, and what viewers are told.
#include <unistd.h>

#include "host/json_document.h"
#include "host/serve/http_server.h"
#include "tests/host/serve_client.h"

namespace wale::test {
namespace {

constexpr const char* kMesh = "v -9 -9 -2\nv 9 -9 -2\nv 0 9 -2\nf 1 2 3\n";
constexpr const char* kBad = "fabrics.0.gauge.wales=0.1";  // not one wale across the cloth

class ServeRefusal : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    if (!has_http_library()) GTEST_SKIP() << "built without cpp-httplib";
    folder_.write("prop.obj", kMesh);
    write_scene(R"({"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4})",
                R"({"builtin": "stockinette"})", R"("gauge": {"wales": 30})",
                R"(, "objects": [{"type": "mesh", "mesh": "prop.obj"}],
 "lights": [{"type": "sphere", "position": [0, 0, 50], "radius": 5, "radiance": 50}])");
    served_ = std::make_unique<Served>(folder_.path(), std::vector<std::string>{scene_, "--quiet", "--size", "32x32"});
    ASSERT_TRUE(served_->up()) << served_->process().err();
    ASSERT_EQ(post("/control", R"({"control": "view.goal", "value": "0.01"})"), 200);  // it goes on refining
    ASSERT_NE(served_->watch("image/jpeg", 120), "");
  }
  void TearDown() override {
    if (!served_ || !served_->up()) return;
    EXPECT_EQ(post("/stop", "{}"), 200);
    EXPECT_EQ(served_->process().wait(30), 0) << served_->process().err();
  }

  int post(const std::string& path, const std::string& body) { return served_->post(path, body).status; }
  int edit(const std::string& set, const std::string& gesture = "") {
    return post("/edit",
                "{\"set\": [\"" + set + "\"], \"gesture\": \"" + gesture + "\", \"control\": \"" + set + "\"}");
  }
  JsonNode state() { return parse_json(served_->ask("GET", "/state").body, "state"); }
  std::string edits() {
    const JsonNode now = state();
    std::string out;
    for (const JsonNode& one : now["edits"].items) out += (out.empty() ? "" : " ") + one.text;
    return out;
  }
  // The newest version is on the device.
  bool shown() {
    for (int i = 0; i < 600; ++i, ::usleep(50000)) {
      const std::string version = fmt::format("\"revision\": {},", state()["revision"].number);
      const std::string stream = served_->watch(version + " \"samples\"", 2);
      for (const char* status : {"rendering", "done"})
        if (contains(stream, fmt::format("\"status\": \"{}\", {}", status, version))) return true;
    }
    return false;
  }
  // The line that is told, and the control that it is told at; empty when none is.
  std::string told(const std::string& text) {
    for (int i = 0; i < 600; ++i, ::usleep(50000)) {
      const JsonNode fault = state()["fault"];
      if (fault.kind == JsonNode::Kind::object && contains(fault["line"].text, text))
        return fault["control"].text + ": " + fault["line"].text;
    }
    return "";
  }

  std::unique_ptr<Served> served_;
};

TEST_F(ServeRefusal, LeavesTheHistoryOfAStrokeThatWasRefusedInItsMiddle) {
  for (const char* wales : {"31", "32"}) {
    ASSERT_EQ(edit(std::string("fabrics.0.gauge.wales=") + wales), 200);
    ASSERT_TRUE(shown());
  }
  ASSERT_EQ(edit("fabrics.0.gauge.wales=33", "stroke"), 200);
  ASSERT_TRUE(shown());
  ASSERT_EQ(edit(kBad, "stroke"), 200);
  EXPECT_NE(told("cloth"), "");
  EXPECT_EQ(edits(), "fabrics.0.gauge.wales=33");
  for (const char* before : {"fabrics.0.gauge.wales=32", "fabrics.0.gauge.wales=31", ""}) {
    ASSERT_EQ(post("/undo", "{}"), 200);
    EXPECT_EQ(edits(), before);
  }
  EXPECT_FALSE(state()["can_undo"].boolean);
  EXPECT_TRUE(shown());
}

// The other files of an older version may have gone bad meanwhile.
TEST_F(ServeRefusal, LeavesTheHistoryOfAnUndoThatWasRefused) {
  ASSERT_EQ(edit("film.exposure=1"), 200);
  folder_.write("other.obj", kMesh);
  ASSERT_EQ(edit("objects.0.mesh=other.obj"), 200);
  ASSERT_TRUE(shown());
  folder_.write("prop.obj", "no mesh");
  ASSERT_EQ(post("/undo", "{}"), 200);
  EXPECT_NE(told("prop.obj: not a mesh"), "");
  EXPECT_EQ(edits(), "film.exposure=1 objects.0.mesh=other.obj");
  EXPECT_TRUE(shown());
  EXPECT_FALSE(state()["can_redo"].boolean);
  folder_.write("prop.obj", kMesh);
  ASSERT_EQ(post("/undo", "{}"), 200);
  EXPECT_TRUE(shown());
  EXPECT_EQ(edits(), "film.exposure=1");
  ASSERT_EQ(post("/undo", "{}"), 200);
  EXPECT_EQ(edits(), "");
  ASSERT_EQ(post("/redo", "{}"), 200);
  ASSERT_EQ(post("/redo", "{}"), 200);
  EXPECT_EQ(edits(), "film.exposure=1 objects.0.mesh=other.obj");
}

// They come so close after each other that most are not shown one by one.
TEST_F(ServeRefusal, TakesNoEditsBackThatCameBeforeOrAfter) {
  for (const char* set :
       {"fabrics.0.gauge.wales=33", "materials.wool.gloss=0.7", kBad, "film.exposure=1", "camera.fov=30"})
    ASSERT_EQ(edit(set), 200);
  EXPECT_TRUE(shown());
  EXPECT_EQ(edits(), "fabrics.0.gauge.wales=33 materials.wool.gloss=0.7 film.exposure=1 camera.fov=30");
  for (int i = 0; i < 4; ++i) ASSERT_EQ(post("/undo", "{}"), 200);
  EXPECT_EQ(edits(), "") << "what was taken back is no step of undo";
}

TEST_F(ServeRefusal, IsToldAtTheControlThatAskedForIt) {
  for (const char* set : {"camera.fov=30", kBad, "film.exposure=1"}) ASSERT_EQ(edit(set), 200);
  EXPECT_TRUE(told("cloth").starts_with(kBad)) << told("cloth");
}

// Two views take turns on the device, and what they need is read anew.
TEST_F(ServeRefusal, OfAFileThatIsDamagedStopsThePictureAndSaysSo) {
  ASSERT_EQ(edit("film.exposure=1"), 200);
  ASSERT_EQ(post("/control", R"({"control": "view.lit", "value": "both"})"), 200);
  ASSERT_TRUE(shown());
  folder_.write("prop.obj", "no mesh");
  ASSERT_EQ(edit("camera.fov=30"), 200);
  EXPECT_NE(served_->watch("\"status\": \"stopped\"", 30), "");
  EXPECT_TRUE(told("prop.obj: not a mesh").starts_with(": ")) << "no control is to blame";
  // Nothing is tried again and again, and what was edited is not lost by it.
  const double revision = state()["revision"].number;
  ::usleep(300000);
  EXPECT_EQ(state()["revision"].number, revision);
  EXPECT_EQ(edits(), "film.exposure=1 camera.fov=30");
  folder_.write("prop.obj", kMesh);
  ASSERT_EQ(edit("camera.fov=31"), 200);
  EXPECT_TRUE(shown());
  EXPECT_EQ(state()["fault"].kind, JsonNode::Kind::null);
}

}  // namespace
}  // namespace wale::test
