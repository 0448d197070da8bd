// The search for the edit that cannot be shown, with exposures for versions: a version can be shown unless a list of
// bad ones holds what it sets.
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "host/serve/tried_edits.h"
#include "tests/property.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

struct ServeTriedEdits : testing::Test {
  TemporaryFolder folder;
  TriedEdits edits{{EditedScene(folder.write("scene.json", R"({"wale": 1,
    "camera": {"position": [0, 0, 1]}, "fabrics": [{"mesh": {"generator": "swatch"}, "pattern": {"builtin": "stockinette"}, "repeats": [8, 8]}]})"),
                                {}),
                    {}}};
  std::set<std::string> bad;        // edits that no version can be shown with
  bool nothing = false;             // no version can be shown
  std::vector<std::string> trials;  // what was tried, "" for the opened one

  static std::string text_of(const std::vector<std::string>& list) {
    std::string out;
    for (const std::string& one : list) out += (out.empty() ? "" : " ") + one;
    return out;
  }
  static std::string text_of(const EditorState& state) { return text_of(state.scene.edits()); }
  std::string now() const { return text_of(edits.newest()); }

  void edit(const std::string& set, const std::string& stroke = "") {
    edits.change({[=](EditorState& state) { return state.scene.edit({set}, stroke), true; }, "of " + set, stroke});
  }
  void undo() { edits.change(undo_of(edits.newest())); }
  void redo() { edits.change(redo_of(edits.newest())); }
  void end(const TriedEdits::Trial& trial) {
    for (const std::string& one : trial.state.scene.edits())
      if (nothing || bad.count(one)) return edits.refused(trial, "no " + one);
    nothing ? edits.refused(trial, "no scene") : edits.shown(trial);
  }
  bool try_one() {
    if (!edits.pending()) return false;
    const TriedEdits::Trial trial = edits.next();
    trials.push_back(text_of(trial.state));
    end(trial);
    return true;
  }
  /// Begins a trial, or ends the one that is under way.
  void try_half(std::optional<TriedEdits::Trial>& under_way) {
    if (under_way)
      end(*std::exchange(under_way, {}));
    else if (edits.pending())
      under_way = edits.next();
  }
  void try_all() {
    for (int i = 0; try_one(); ++i) ASSERT_LT(i, 1000) << "it does not end";
  }
  std::string refusal() const { return edits.refusal() ? edits.refusal()->control + ": " + edits.refusal()->line : ""; }
};

TEST_F(ServeTriedEdits, TheNewestIsShownAndThoseBetweenAreSkipped) {
  try_all();
  for (const char* set : {"film.exposure=1", "film.exposure=2", "camera.fov=30"}) edit(set);
  try_all();
  EXPECT_EQ(trials, (std::vector<std::string>{"", "film.exposure=2 camera.fov=30"}));
  EXPECT_EQ(refusal(), "");
}

TEST_F(ServeTriedEdits, OneThatIsBadAlone) {
  try_all();
  bad = {"film.exposure=9"};
  edit("film.exposure=9");
  const uint64_t refused = edits.revision();
  try_all();
  EXPECT_EQ(now(), "");
  EXPECT_EQ(refusal(), "of film.exposure=9: no film.exposure=9");
  EXPECT_GT(edits.revision(), refused) << "another version";
  EXPECT_FALSE(edits.newest().scene.can_undo());
  edit("film.exposure=1");
  EXPECT_EQ(refusal(), "");
  try_all();
  EXPECT_EQ(now(), "film.exposure=1");
}

// Any of many edits, or several: those alone go back, in few trials.
TEST_F(ServeTriedEdits, ThoseThatAreBadAmongManyGoBackAlone) {
  try_all();
  for (const std::set<int>& wrong : {std::set<int>{0}, {7}, {15}, {0, 1}, {3, 12}, {14, 15}, {5, 6, 7, 8}}) {
    bad.clear(), trials.clear();
    edits.change({[](EditorState& state) { return state.scene.reset(); }});
    try_all();
    const size_t before = trials.size();
    std::vector<std::string> good;
    for (int i = 0; i < 16; ++i) {
      const std::string one = fmt::format("materials.m{}={{\"type\":\"ply\"}}", i);
      (wrong.count(i) ? bad.insert(one), void() : good.push_back(one));
      edit(one);
    }
    try_all();
    EXPECT_EQ(now(), text_of(good));
    EXPECT_LE(trials.size() - before, 7 * wrong.size()) << "the newest, the good one, four by halving, the rest";
    for (size_t i = 0; i < good.size(); ++i) undo();
    EXPECT_EQ(now(), "") << "as many steps of undo";
  }
}

// Steps of undo among them are made again, without the one that was taken back.
TEST_F(ServeTriedEdits, UndoAndRedoAreMadeAgainWithoutIt) {
  edit("film.exposure=1");
  try_all();
  bad = {"camera.fov=9"};
  edit("camera.fov=9");
  edit("film.exposure=2");
  undo();
  redo();
  edit("integrator.seed=3");
  try_all();
  EXPECT_EQ(now(), "film.exposure=2 integrator.seed=3");
  for (const char* before : {"film.exposure=2", "film.exposure=1", ""}) {
    undo();
    EXPECT_EQ(now(), before);
  }
  for (int i = 0; i < 3; ++i) redo();
  EXPECT_EQ(now(), "film.exposure=2 integrator.seed=3");
}

TEST_F(ServeTriedEdits, AnUndoThatCannotBeShownLeavesTheHistory) {
  for (const char* set : {"film.exposure=1", "film.exposure=2", "film.exposure=3"}) edit(set), try_all();
  bad = {"film.exposure=2"};
  undo();
  try_all();
  EXPECT_EQ(now(), "film.exposure=3");
  EXPECT_FALSE(edits.newest().scene.can_redo());
  bad.clear();
  for (const char* before : {"film.exposure=2", "film.exposure=1"}) {
    undo();
    EXPECT_EQ(now(), before);
  }
  try_all();
  bad = {"film.exposure=2"};
  redo();
  try_all();
  EXPECT_EQ(now(), "film.exposure=1");
  bad.clear();
  redo(), redo();
  EXPECT_EQ(now(), "film.exposure=3");
}

TEST_F(ServeTriedEdits, AStrokeGoesBackToWhatOfItWasShown) {
  edit("film.exposure=1");
  edit("film.exposure=2", "s");
  try_all();
  bad = {"film.exposure=4"};
  edit("film.exposure=3", "s");
  edit("film.exposure=4", "s");
  try_all();
  EXPECT_EQ(now(), "film.exposure=2");
  // The stroke goes on: no new step.
  edit("film.exposure=5", "s");
  try_all();
  undo();
  EXPECT_EQ(now(), "film.exposure=1");
}

// What the stroke was when it was tried is not what it is now.
TEST_F(ServeTriedEdits, AStrokeThatGoesOnMeanwhileIsTriedAgain) {
  try_all();
  bad = {"film.exposure=9"};
  edit("film.exposure=9", "s");
  const TriedEdits::Trial trial = edits.next();
  edit("film.exposure=1", "s");
  edits.refused(trial, "no");
  try_all();
  EXPECT_EQ(now(), "film.exposure=1");
  EXPECT_EQ(refusal(), "");
}

// That it could not be shown is not the fault of the change before it.
TEST_F(ServeTriedEdits, AStrokeThatGoesOnBadMeanwhileTakesNothingElseWithIt) {
  try_all();
  bad = {"film.exposure=8", "film.exposure=9"};
  edit("camera.fov=30");
  edit("film.exposure=9", "s");
  const TriedEdits::Trial trial = edits.next();
  edit("film.exposure=8", "s");
  edits.refused(trial, "no");
  try_all();
  EXPECT_EQ(now(), "camera.fov=30");
  EXPECT_EQ(refusal(), "of film.exposure=8: no film.exposure=8");
}

// What is edited while the search goes on is tried first, and ends it where it puts things right.
TEST_F(ServeTriedEdits, EditsInTheMiddleOfTheSearch) {
  try_all();
  bad = {"film.exposure=9"};
  edit("camera.fov=30");
  edit("film.exposure=9");
  edit("integrator.seed=3");
  for (int i = 0; i < 2; ++i) try_one();
  edit("film.exposure=1");
  trials.clear();
  try_all();
  EXPECT_EQ(trials, (std::vector<std::string>{"camera.fov=30 integrator.seed=3 film.exposure=1"}));
  EXPECT_EQ(refusal(), "");
}

// A file has gone: no edit is to blame, and all are there when it is back.
TEST_F(ServeTriedEdits, NothingCanBeShown) {
  edit("camera.fov=30");
  try_all();
  nothing = true;
  edit("film.exposure=1");
  edit("film.exposure=2");
  try_all();
  EXPECT_EQ(now(), "camera.fov=30 film.exposure=2");
  EXPECT_EQ(refusal(), ": no camera.fov=30");
  trials.clear();
  try_all();
  EXPECT_TRUE(trials.empty()) << "not again and again";
  nothing = false;
  bad = {"film.exposure=1"};
  edit("film.exposure=3");
  try_all();
  EXPECT_EQ(now(), "camera.fov=30 film.exposure=3");
  EXPECT_EQ(refusal(), "");
}

// Found while a version is shown: what is on the device is read anew.
TEST_F(ServeTriedEdits, WhatIsShownCannotBeAnyMore) {
  edit("camera.fov=30");
  const TriedEdits::Trial trial = edits.next();
  edits.shown(trial);
  edits.refused(trial, "no file");
  EXPECT_EQ(refusal(), ": no file");
  EXPECT_FALSE(edits.pending());
  edit("camera.fov=31");
  try_all();
  EXPECT_EQ(refusal(), "");
}

// A hundred before one can be shown: they are not kept one by one.
TEST_F(ServeTriedEdits, OfVeryManyTheOldestGoBackTogether) {
  try_all();
  bad = {"materials.m0={\"type\":\"ply\"}"};
  for (int i = 0; i < 100; ++i) edit(fmt::format("materials.m{}={{\"type\":\"ply\"}}", i));
  try_all();
  EXPECT_EQ(edits.newest().scene.edits().size(), 63u);
  EXPECT_NE(refusal(), "");
}

TEST_F(ServeTriedEdits, AnUndoOfWhatIsTakenBackGoesWithIt) {
  try_all();
  bad = {"camera.fov=9", "film.exposure=9"};
  edit("integrator.seed=3");
  edit("camera.fov=9");
  undo();
  edit("film.exposure=9");
  edit("camera.up=[1,0,0]");
  try_all();
  EXPECT_EQ(now(), "integrator.seed=3 camera.up=[1,0,0]");
  for (const char* before : {"integrator.seed=3", ""}) {
    undo();
    EXPECT_EQ(now(), before);
  }
}

TEST_F(ServeTriedEdits, ARedoOfAnUndoThatIsTakenBackGoesWithIt) {
  for (const char* set : {"film.exposure=1", "film.exposure=2", "camera.fov=30"}) edit(set), try_all();
  undo(), try_all();
  bad = {"film.exposure=1", "integrator.seed=9"};
  undo(), redo();
  edit("integrator.seed=9");
  try_all();
  EXPECT_EQ(now(), "film.exposure=2");
}

TEST_F(ServeTriedEdits, WhatChangesNothingIsNoVersion) {
  const uint64_t before = edits.revision();
  undo(), redo();
  edits.change({[](EditorState& state) { return state.scene.reset(); }});
  EXPECT_EQ(edits.revision(), before);
}

// So many that the oldest count as one while a trial of one of them is under way: none is made twice.
TEST_F(ServeTriedEdits, ATrialOfWhatHasBecomeOneWithOthers) {
  for (const char* set : {"camera.fov=30", "film.exposure=1", "film.exposure=2"}) edit(set), try_all();
  undo();
  const TriedEdits::Trial trial = edits.next();
  std::string good = "camera.fov=30 film.exposure=1";
  for (int i = 0; i < 70; ++i) {
    edit(fmt::format("materials.m{}={{\"type\":\"ply\"}}", i));
    if (i < 69) good += fmt::format(" materials.m{}={{\"type\":\"ply\"}}", i);
  }
  bad = {"materials.m69={\"type\":\"ply\"}"};
  edits.shown(trial);
  try_all();
  EXPECT_EQ(now(), good);
  for (int i = 0; i < 69; ++i) undo();
  EXPECT_EQ(now(), "camera.fov=30 film.exposure=1");
  redo(), undo(), undo(), undo();
  EXPECT_EQ(now(), "");
}

constexpr const char* kProp = R"(objects=[{"type":"mesh","mesh":"prop.obj"}])";

TEST_F(ServeTriedEdits, AFileThatGoesInTheMiddleOfTheSearchIsTheFaultOfItsEdit) {
  folder.write("prop.obj", "a mesh");
  try_all();
  bad = {"film.exposure=9"};
  edit(kProp), edit("film.exposure=9"), edit("camera.fov=30");
  try_one();
  std::filesystem::remove(folder / "prop.obj");
  bad.insert(kProp);
  try_all();
  EXPECT_EQ(now(), "camera.fov=30");
}

TEST_F(ServeTriedEdits, AFileOfTheGoodVersionThatGoesTakesNoEditsWithIt) {
  folder.write("prop.obj", "a mesh");
  edit(kProp);
  try_all();
  bad = {"film.exposure=9"};
  edit("film.exposure=9"), edit("camera.fov=30"), edit("integrator.seed=3");
  const std::string all = now();
  try_one(), try_one();
  std::filesystem::remove(folder / "prop.obj");
  try_all();
  EXPECT_EQ(now(), all);
  EXPECT_TRUE(edits.stopped());
  EXPECT_TRUE(refusal().starts_with(": ")) << refusal();
  EXPECT_NE(refusal().find("prop.obj"), std::string::npos) << refusal();
  folder.write("prop.obj", "a mesh");
  edit("camera.fov=31");
  try_all();
  EXPECT_EQ(now(), std::string(kProp) + " integrator.seed=3 camera.fov=31");
  EXPECT_FALSE(edits.stopped());
}

TEST_F(ServeTriedEdits, WhatNeedsTheEditThatIsTakenBackIsTold) {
  folder.write("prop.obj", "a mesh");
  try_all();
  bad = {kProp};
  edit(kProp), edit("objects.0.transform={\"scale\":2}"), edit("camera.fov=30");
  try_all();
  EXPECT_EQ(now(), "camera.fov=30");
  EXPECT_NE(refusal().find("; one edit after it went with it: --set objects.0.transform"), std::string::npos)
      << refusal();
}

// Whenever trials come between: what stays are the edits that are good and not undone.
TEST_F(ServeTriedEdits, AnyRowLeavesTheEditsThatAreGood) {
  const TriedEdits opened = edits;
  test::check_property(300, [&] {
    edits = opened;
    bad.clear();
    std::vector<std::string> made;
    std::set<std::string> there;
    std::optional<TriedEdits::Trial> under_way;
    const auto listed = [&] {
      const auto& list = edits.newest().scene.edits();
      return std::set<std::string>(list.begin(), list.end());
    };
    const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 12));
    for (const int step : steps) {
      const std::set<std::string> before = listed();
      if (step < 5) {
        made.push_back(fmt::format("materials.m{}={{\"type\":\"ply\"}}", made.size()));
        if (step < 2) bad.insert(made.back());
        edit(made.back());
      } else if (step < 9) {
        step < 7 ? undo() : redo();
      } else {
        try_half(under_way);
        continue;
      }
      const std::set<std::string> after = listed();
      for (const std::string& one : before)
        if (!after.count(one)) there.erase(one);
      for (const std::string& one : after)
        if (!before.count(one)) there.insert(one);
    }
    if (under_way) end(*under_way);
    try_all();
    std::vector<std::string> good;
    for (const std::string& one : made)
      if (there.count(one) && !bad.count(one)) good.push_back(one);
    RC_ASSERT(now() == text_of(good));
  });
}

// Any row of edits, undo, redo and trials between them ends in a version that can be shown.
TEST_F(ServeTriedEdits, AnyRowEndsInWhatCanBeShown) {
  const TriedEdits opened = edits;
  test::check_property(200, [&] {
    edits = opened;
    const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 12));
    bad = {"film.exposure=2", "camera.fov=32"};
    std::optional<TriedEdits::Trial> under_way;
    for (const int step : steps) {
      if (step < 4)
        edit(fmt::format("film.exposure={}", step), step % 2 ? "" : "e");
      else if (step < 7)
        edit(fmt::format("camera.fov={}", 26 + step));
      else if (step < 9)
        try_half(under_way);
      else if (step == 9)
        undo();
      else
        redo();
    }
    if (under_way) end(*under_way);
    try_all();
    for (const std::string& one : edits.newest().scene.edits()) RC_ASSERT(!bad.count(one));
    RC_ASSERT(!edits.pending());
  });
}

}  // namespace
}  // namespace wale
