// Base meshes frame by frame: every file that holds them, and every way in which a frame can be wrong.
#include "geom/mesh_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "geom/base_mesh_generators.h"
#include "tests/geom/sequence_fixtures.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

using test::bin_file;
using test::pc2_file;

BaseMesh lifted(double height, int n = 3) {
  BaseMesh mesh = make_swatch(0.1, 0.1, n, n);
  for (dvec3& p : mesh.position) p.z += height;
  return mesh;
}

class Sequences : public testing::Test {
 protected:
  void write(const char* name, const BaseMesh& mesh) { write_obj(mesh, folder_ / name); }
  SequenceSource numbered(const std::string& pattern = "c_##.obj") const {
    SequenceSource source;
    source.frames = folder_ / pattern;
    return source;
  }
  static MeshSequence open(const SequenceSource& source) {
    return {source, [](const auto& f) { return read_mesh(f); }};
  }
  std::string without_folder(std::string line) const {
    const std::string folder = folder_.path().string() + "/";
    for (size_t i; (i = line.find(folder)) != std::string::npos;) line.erase(i, folder.size());
    return line;
  }
  std::string refusal(const SequenceSource& source, double frame) const {
    return without_folder(user_message([&] { open(source).at(frame); }));
  }
  TemporaryFolder folder_;
};

TEST_F(Sequences, NumberedFilesAreFoundWhateverTheirStep) {
  for (const int n : {10, 12, 14, 16}) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n));
  write("c_7.obj", lifted(7));     // too few digits
  write("c_012.obj", lifted(99));  // another number of digits
  SequenceSource source = numbered();
  source.first = 10, source.step = 2;
  const MeshSequence s = open(source);
  EXPECT_EQ(s.rest().position[0].z, 10);
  EXPECT_EQ(s.at(0).position[0].z, 10);
  EXPECT_EQ(s.at(3).position[0].z, 16);
  EXPECT_NEAR(s.at(0.25).position[0].z, 10.5, 1e-12);
  source.first = 16, source.step = -2;
  EXPECT_EQ(open(source).at(1).position[0].z, 14);
}

// A shutter looks at the same two again and again, and what a frame is called hashes the bytes that were read.
TEST_F(Sequences, EveryFileIsReadOnce) {
  for (int n = 0; n < 6; ++n) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n));
  folder_.write("c_03.obj", "no mesh");
  for (const bool changing : {false, true}) {
    SequenceSource source = numbered();
    source.hold = true;
    source.changing = changing;
    std::map<std::string, int> read;
    const MeshSequence s(source, [&](const auto& file) {
      ++read[file.filename().string()];
      return read_mesh(file);
    });
    for (int frame = 0; frame < 5; ++frame) {
      for (int k = 0; k < 4; ++k) s.at(frame + 0.25 * k);
      s.hash(frame);
      s.hash(frame + 0.5);
    }
    EXPECT_EQ(read.size(), changing ? 5u : 6u);
    for (const auto& [file, times] : read) EXPECT_EQ(times, 1) << file << changing;
  }
}

TEST_F(Sequences, TheFilesOfAFrameAreNamed) {
  for (int n = 0; n < 6; ++n) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n));
  folder_.write("c_03.obj", "no mesh");
  SequenceSource source = numbered();
  source.rest = 5;
  source.hold = true;
  const auto files = [&](double frame) {
    std::set<std::string> names;
    for (const auto& file : open(source).files(frame)) names.insert(without_folder(file.string() + "/"));
    return names;
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(files(1.5), (Names{"c_01.obj/", "c_02.obj/", "c_03.obj/", "c_05.obj/"})) << "one more than it is between";
  EXPECT_EQ(files(3), (Names{"c_02.obj/", "c_03.obj/", "c_04.obj/", "c_05.obj/"})) << "what is held instead";
  EXPECT_EQ(files(8), (Names{"", "c_05.obj/", "c_08.obj/", "c_09.obj/"})) << "any that comes up in the folder";
  source.frames = folder_.write("a.bin", bin_file({lifted(0), lifted(1)}));
  EXPECT_EQ(files(1), (Names{"a.bin/"}));
}

// What moves up to the end is as blurred there as before.
TEST_F(Sequences, MotionGoesOnBehindTheLastFrame) {
  for (const int n : {0, 1, 2}) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n * n));
  EXPECT_NEAR(open(numbered()).at(2.5).position[0].z, 4 + 0.5 * 3, 1e-12);
}

// Where there is no way from one mesh to the next, the one before stays: at the end and before a gap too.
TEST_F(Sequences, OfChangingTopologyTheMeshBeforeStays) {
  for (const int n : {0, 1, 3}) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n, 3 + n));
  SequenceSource source = numbered();
  source.changing = true;
  const MeshSequence s = open(source);
  EXPECT_EQ(s.at(0.75).position[0].z, 0);
  EXPECT_EQ(s.at(1.25).position[0].z, 1);
  EXPECT_EQ(s.at(3.25).position[0].z, 3);
  EXPECT_NO_THROW(s.require(1.25));
  EXPECT_NE(user_message([&] { s.require(2.25); }), "");
}

TEST_F(Sequences, GapsAreFoundAndNamed) {
  for (const int n : {0, 1, 3, 7, 8}) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n));
  EXPECT_EQ(refusal(numbered(), 2), "frame 2: c_02.obj is not there; there are 0 to 8 without 2, 4 to 6");
  EXPECT_EQ(refusal(numbered(), 9), "frame 9: c_09.obj is not there; there are 0 to 8 without 2, 4 to 6");
  EXPECT_EQ(without_folder(user_message([&] { open(numbered()).require(5); })),
            "frame 5: c_05.obj is not there; there are 0 to 8 without 2, 4 to 6");
  SequenceSource source = numbered();
  source.last = 1;
  EXPECT_EQ(refusal(source, 3), "frame 3: c_03.obj is not there; there are 0 to 1");
  source.hold = true;
  std::vector<std::string> notes;
  EXPECT_EQ(open(source).at(3, &notes).position[0].z, 1);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(without_folder(notes[0]), "frame 3: c_03.obj is not there; there are 0 to 1; c_01.obj is held");
  EXPECT_EQ(open(source).at(-5).position[0].z, 0);
}

TEST_F(Sequences, NoFilesAtAllAreRefused) {
  EXPECT_EQ(refusal(numbered(), 0), "c_##.obj: no such files; for example c_00.obj is not there");
  EXPECT_EQ(refusal(numbered("cloth.obj"), 0),
            "cloth.obj: names no frames; write # for each digit of the number, for example cloth_####.obj");
  EXPECT_EQ(refusal(numbered("a#_b#.obj"), 0),
            "a#_b#.obj: # stands in several places; the number can stand in one only");
  EXPECT_EQ(refusal(numbered("##########.obj"), 0), "##########.obj: numbers of 10 digits; at most 9");
  write("c_03.obj", lifted(3));
  SequenceSource source = numbered();
  source.first = 5;
  EXPECT_EQ(refusal(source, 0), "c_05.obj: no frames from number 5 on; there are 3 to 3");
}

// Both policies, for every way in which a frame is wrong.
TEST_F(Sequences, WrongFramesStopOrHold) {
  write("c_00.obj", lifted(0));
  write("c_01.obj", lifted(1));
  write("c_02.obj", lifted(2, 4));
  folder_.write("c_03.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
  folder_.write("c_04.obj", "");
  BaseMesh turned = lifted(5);
  std::swap(turned.triangle[0][1], turned.triangle[0][2]);
  write("c_05.obj", turned);
  SequenceSource source = numbered();
  EXPECT_EQ(refusal(source, 2),
            "frame 2: c_02.obj has 25 vertices and 32 triangles, the rest frame 16 and 18; write \"topology\": "
            "\"changing\" where every frame is a mesh of its own");
  EXPECT_TRUE(refusal(source, 3).starts_with("frame 3: c_03.obj:")) << refusal(source, 3);
  EXPECT_TRUE(refusal(source, 4).starts_with("frame 4: c_04.obj: not a mesh: no faces")) << refusal(source, 4);
  EXPECT_NE(refusal(source, 5).find("18 triangles between other corners"), std::string::npos);
  source.hold = true;
  for (const int n : {2, 3, 4, 5, 6}) {
    std::vector<std::string> notes;
    EXPECT_EQ(open(source).at(n, &notes).position[0].z, 1) << n;
    ASSERT_EQ(notes.size(), 1u) << n;
    EXPECT_TRUE(notes[0].ends_with("c_01.obj is held")) << notes[0];
  }
  source.changing = true;
  EXPECT_EQ(open(source).at(2).triangle.size(), 32u);
  EXPECT_EQ(open(source).at(2.5).triangle.size(), 32u);  // nothing lies between two meshes
}

// What a picture shows of a frame that is held is the frame before it, whatever the damage.
TEST_F(Sequences, TheHashOfAHeldFrameIsThatOfWhatIsHeld) {
  for (const int n : {0, 1, 2, 3}) write(fmt::format("c_{:02}.obj", n).c_str(), lifted(n));
  SequenceSource source = numbered();
  source.hold = true;
  const auto hash = [&](double frame) { return open(source).hash(frame); };
  const uint64_t whole = hash(2);
  folder_.write("c_02.obj", "v 0 0 nan\n");
  const uint64_t held = hash(2);
  EXPECT_NE(held, whole);
  EXPECT_EQ(held, hash(1));
  folder_.write("c_02.obj", "");
  EXPECT_EQ(hash(2), held) << "another damage, the same picture";
  EXPECT_NE(hash(2.5), hash(1)) << "half way from frame 1 to frame 3";
  write("c_01.obj", lifted(1.5));
  EXPECT_NE(hash(2), held) << "another picture";
  EXPECT_EQ(hash(2), hash(1));
}

TEST_F(Sequences, TheRestIsNeverHeld) {
  write("c_01.obj", lifted(1));
  SequenceSource source = numbered();
  source.hold = true;
  EXPECT_EQ(without_folder(user_message([&] { open(source).rest(); })),
            "the rest, frame 0: c_00.obj is not there; there is 1");
  source.rest = 1;
  EXPECT_EQ(open(source).rest().position[0].z, 1);
}

TEST_F(Sequences, UvIsThatOfTheRest) {
  write("c_00.obj", lifted(0));
  BaseMesh moved = lifted(1);
  for (auto& t : moved.uv)
    for (dvec2& uv : t) uv += 0.5;
  write("c_01.obj", moved);
  const MeshSequence s = open(numbered());
  EXPECT_EQ(s.at(1).uv, s.rest().uv);
}

TEST_F(Sequences, BinaryFramesKeepWhatTheyDoNotRepeat) {
  const BaseMesh a = lifted(0), b = lifted(1);
  folder_.write("c.bin", bin_file({a, b}, 2));
  const MeshSequence s = open(numbered("c.bin"));
  EXPECT_EQ(s.at(1).position[0].z, 1);
  EXPECT_EQ(s.at(1).triangle, a.triangle);
  for (size_t t = 0; t < a.uv.size(); ++t)
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(glm::length(s.at(1).uv[t][k] - a.uv[t][k]), 0, 1e-7);
  EXPECT_NE(s.hash(0), s.hash(1));
  EXPECT_NE(s.hash(0), s.hash(0.5));
}

TEST_F(Sequences, BinaryFramesThatAreCutOffAreRefused) {
  const std::string whole = bin_file({lifted(0), lifted(1)}, 1);
  for (const size_t length : {size_t(0), size_t(1), size_t(5), whole.size() / 2, whole.size() - 1}) {
    folder_.write("c.bin", whole.substr(0, length));
    const std::string line = refusal(numbered("c.bin"), 0);
    EXPECT_TRUE(line.starts_with("c.bin: ")) << line;
  }
  folder_.write("c.bin", whole + "x");
  EXPECT_EQ(refusal(numbered("c.bin"), 0), "c.bin: 1 bytes behind the last of its 2 frames; is it another format?");
  folder_.write("c.bin", whole);
  EXPECT_EQ(refusal(numbered("c.bin"), 2), "frame 2: c.bin, frame 2 is not there; there are 0 to 1");
}

TEST_F(Sequences, PointCachesMoveTheirMesh) {
  write("base.obj", lifted(0));
  folder_.write("c.pc2", pc2_file({lifted(0), lifted(1), lifted(2)}, 0.5f));
  SequenceSource source;
  source.base = folder_ / "base.obj", source.cache = folder_ / "c.pc2";
  const MeshSequence s = open(source);
  EXPECT_EQ(s.at(1).position[0].z, 2);  // two samples a frame
  EXPECT_NEAR(s.at(0.25).position[0].z, 0.5, 1e-7);
  EXPECT_EQ(s.at(1).uv, read_mesh(source.base).uv);
  folder_.write("c.pc2", pc2_file({lifted(0, 4)}, 1));
  EXPECT_EQ(refusal(source, 0),
            "c.pc2: a cache of 25 points for base.obj, which has 16 vertices; both must have as many");
  folder_.write("c.pc2", "POINTCACHE");
  EXPECT_EQ(refusal(source, 0), "c.pc2: ends within its header; is the file cut off?");
  std::string bytes = pc2_file({lifted(0), lifted(1)}, 1);
  const float nan = NAN;
  std::memcpy(bytes.data() + 32 + 16 * 12, &nan, 4);
  folder_.write("c.pc2", bytes);
  EXPECT_EQ(refusal(source, 1),
            "frame 1: c.pc2, sample 1: vertex 1: position is NaN or infinite; write a finite number");
  source.hold = true;
  EXPECT_EQ(open(source).at(1).position[0].z, 0);
}

// Frames of shared data as OBJ are what their .bin holds, to the digits of the text.
TEST_F(Sequences, RealBinaryFramesAreTheObjFramesMadeOfThem) {
  const char* data = std::getenv("WALE_REAL_DATA");
  if (!data) GTEST_SKIP() << "skipped: real data not present";
  const std::filesystem::path folder = std::filesystem::path(data) / "cloth-anim";
  SequenceSource bin, obj;
  bin.frames = folder / "madypg/stock_stretchX.bin";
  obj.frames = folder / "madypg-obj-frames/stock_stretchX_####.obj";
  obj.step = 15;  // 0, 15, 30, 45; 59 is beside the steps
  const MeshSequence a = open(bin), b = open(obj);
  for (const int n : {0, 1, 2, 3}) {
    const BaseMesh x = a.at(15 * n), y = b.at(n);
    ASSERT_EQ(x.position.size(), y.position.size());
    EXPECT_EQ(x.triangle, y.triangle);
    for (size_t i = 0; i < x.position.size(); ++i)
      EXPECT_LT(glm::length(x.position[i] - y.position[i]), 1e-5) << n << " " << i;
  }
  EXPECT_EQ(without_folder(user_message([&] { a.at(60); })).substr(0, 9), "frame 60:");
  for (const char* name : {"shear_grid_x.bin", "sx.bin"}) {
    bin.frames = folder / "madypg" / name;
    const MeshSequence s = open(bin);
    EXPECT_GT(s.at(1).triangle.size(), 1u) << name;
  }
}

}  // namespace
}  // namespace wale
