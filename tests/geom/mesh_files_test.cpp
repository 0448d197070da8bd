// Reading meshes: good files in three formats, and every kind of bad file with the message that it earns.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "geom/base_mesh.h"
#include "geom/base_mesh_generators.h"
#include "geom/charts.h"
#include "geom/error.h"

namespace wale {
namespace {

class MeshFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("wale_mesh_") + test->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const char* name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The message of the user error that `action` throws; fails the test when it throws none.
  template <typename Action>
  std::string message(Action&& action) {
    try {
      action();
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::user);
      return error.what();
    }
    ADD_FAILURE() << "no error was raised";
    return "";
  }

  std::filesystem::path folder_;
};

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(MeshFiles, ObjKeepsEveryDigitOfDouble) {
  BaseMesh mesh = make_tube(0.1, 0.2, 7, 3);
  write_obj(mesh, folder_ / "tube.obj");
  const BaseMesh back = read_mesh(folder_ / "tube.obj");
  ASSERT_EQ(back.position.size(), mesh.position.size());
  ASSERT_EQ(back.triangle, mesh.triangle);
  for (size_t i = 0; i < mesh.position.size(); ++i) EXPECT_EQ(back.position[i], mesh.position[i]);
  for (size_t t = 0; t < mesh.uv.size(); ++t)
    for (size_t c = 0; c < 3; ++c) EXPECT_EQ(back.uv[t][c], mesh.uv[t][c]);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "tube.obj.part"));
}

TEST_F(MeshFiles, ObjWithNegativeIndicesUnknownKeywordsAndCarriageReturns) {
  const auto file =
      write("a.obj",
            "# c\r\nmtllib x\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nny 0 0 1\r\nnv 1 2 3\r\nvt 0 0\r\nvt 1 0\r\n"
            "vt 1 1\r\ng x\r\nf -3/-3 -2/-2 \\\r\n-1/-1\r\n");
  const auto plain = write("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf -3/-3 -2/-2 \\\n-1/-1\n");
  EXPECT_EQ(read_mesh(plain).triangle.size(), 1u);
  EXPECT_EQ(read_mesh(plain).uv[0][2], dvec2(1, 1));
  EXPECT_EQ(read_mesh(file).triangle.size(), 1u);
}

TEST_F(MeshFiles, QuadsAndPolygonsAreFannedWithTheirUv) {
  const auto file = write("n.obj",
                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0.5 0\nv 2 1 0\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 3 0.5\nvt 2 1\n"
                          "f 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 7/7 3/3\n");
  const BaseMesh mesh = read_mesh(file);
  const MeshReport report = validate(mesh);
  EXPECT_EQ(report.triangles, 5u);
  EXPECT_EQ(report.polygons_split, 2u);
  EXPECT_EQ(report.zero_area_uv, 0u);
  for (size_t t = 0; t < mesh.triangle.size(); ++t)
    for (size_t c = 0; c < 3; ++c) EXPECT_EQ(mesh.uv[t][c], dvec2(mesh.position[mesh.triangle[t][c]]));
  EXPECT_EQ(find_charts(mesh).size(), 1u);
}

TEST_F(MeshFiles, PlyWithVertexUv) {
  const std::string body = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
  for (const std::string names : {"u v", "s t"}) {
    const size_t blank = names.find(' ');
    const auto file = write("q.ply",
                            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float " +
                                names.substr(0, blank) + "\nproperty float " + names.substr(blank + 1) +
                                "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" + body);
    const BaseMesh mesh = read_mesh(file);
    ASSERT_EQ(mesh.triangle.size(), 2u);
    ASSERT_EQ(mesh.uv.size(), 2u) << names;
    EXPECT_EQ(mesh.uv[0][2], dvec2(1, 1)) << names;
  }
}

TEST_F(MeshFiles, PlyWithUnknownPropertiesIsRead) {
  const auto file =
      write("p.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property float quality\nelement face 1\nproperty list uchar int vertex_indices\n"
            "property int material\nend_header\n0 0 0 5\n1 0 0 6\n0 1 0 7\n3 0 1 2 9\n");
  EXPECT_EQ(read_mesh(file).triangle.size(), 1u);
}

TEST_F(MeshFiles, OffIsRead) {
  const BaseMesh mesh = read_mesh(write("t.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n"));
  EXPECT_EQ(mesh.triangle.size(), 3u);
  EXPECT_TRUE(mesh.uv.empty());
}

TEST_F(MeshFiles, MissingFile) {
  expect_contains(message([&] { read_mesh(folder_ / "none.obj"); }), "no such file");
}

TEST_F(MeshFiles, FolderInsteadOfFile) {
  expect_contains(message([&] { read_mesh(folder_); }), "no such file");
}

TEST_F(MeshFiles, UnknownSuffix) {
  const auto file = write("mesh.stl", "solid");
  expect_contains(message([&] { read_mesh(file); }), "use .obj, .ply or .off");
}

TEST_F(MeshFiles, NotAMesh) {
  for (const char* name : {"x.obj", "x.ply", "x.off"}) {
    const char rubbish[] = "\x89PNG\r\n\x1a\n\0\0 binary rubbish \xff\xfe";
    const auto file = write(name, std::string(rubbish, sizeof rubbish));
    expect_contains(message([&] { read_mesh(file); }), "not a mesh");
  }
}

TEST_F(MeshFiles, EmptyFile) {
  for (const char* name : {"x.obj", "x.ply", "x.off"}) {
    const auto file = write(name, "");
    expect_contains(message([&] { read_mesh(file); }), "not a mesh");
  }
}

TEST_F(MeshFiles, TruncatedPly) {
  const auto file =
      write("x.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 1000000\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1000000\nproperty list uchar int vertex_indices\nend_header\nabc");
  EXPECT_THROW(read_mesh(file), Error);
}

// OpenMesh takes words one after the other, whatever the line says, and loops where one is not what it expects.
TEST_F(MeshFiles, TextPlyWithWordsOfAnotherKindIsRefused) {
  const std::string types = "property float x\nproperty float y\nproperty float z\n";
  const auto refused = [&](const std::string& format, const std::string& point, const std::string& face) {
    return message([&] {
      read_mesh(
          write("p.ply", "ply\nformat " + format + "\nelement vertex 3\n" + types +
                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n" +
                             point + "\n" + face + "\n"));
    });
  };
  expect_contains(refused("ascii 1.0", "0 1 x", "3 0 1 2"), "'x' is not a number");
  expect_contains(refused("ascii 1.0", "0 1 1e300", "3 0 1 2"), "'1e300' is not a number that a float holds");
  expect_contains(refused("ascii 1.0", "0 1 nan", "3 0 1 2"), "'nan' is not a number");
  expect_contains(refused("ascii 1.0", "0 1 0 7", "3 0 1 2"), "'7' is one word too many");
  expect_contains(refused("ascii 1.0", "0 1 0", "3 0 1 2.5"), "'2.5' is not a whole number");
  expect_contains(refused("binary_little_endian endian 1.0", "0 1 0", "3 0 1 2"), "not a PLY format");
  expect_contains(refused("ascii 1.0\nelement", "0 1 0", "3 0 1 2"), "a number of elements is needed");
  expect_contains(refused("ascii 1.0\nrubbish", "0 1 0", "3 0 1 2"), "'rubbish' does not belong");
}

// A word too many shifts all that follow: a number of a vertex becomes the number of a face's corners.
TEST_F(MeshFiles, OffWithWordsTooManyIsRefused) {
  const auto refused = [&](const std::string& text) { return message([&] { read_mesh(write("w.off", text)); }); };
  const std::string face = "3 0 1 2\n";
  expect_contains(refused("OFF\n3 1 0 9\n0 0 0\n1 0 0\n0 1 0\n" + face), "'9' is one word too many in this count line");
  expect_contains(refused("OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n" + face), "a number of edges is needed");
  expect_contains(refused("OFF\n3 1 0\n0 0 0\n1 0 0 -9\n0 1 0\n" + face), "'-9' is one word too many");
  expect_contains(refused("STOFF\n3 1 0\n0 0 0 0 0\n1 0 0\n0 1 0 0 1\n" + face), "5 numbers has only 3");
}

// OpenMesh reads stale numbers, or loops for minutes, where a text file ends early.
TEST_F(MeshFiles, TextPlyThatEndsEarly) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(read_mesh(write("whole.ply", head + "3 0 1 2\n")).triangle.size(), 1u);
  expect_contains(message([&] { read_mesh(write("a.ply", head)); }), "a.ply:12: the file ends before face 1 of the 1");
  expect_contains(message([&] { read_mesh(write("b.ply", head + "3 0\n")); }),
                  "b.ply:13: face of 3 numbers has only 1");
  expect_contains(message([&] { read_mesh(write("c.ply", head + "2000000000 0 1 2\n")); }), "has only 3");
}

TEST_F(MeshFiles, OffThatEndsEarly) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(read_mesh(write("whole.off", "OFF\n3 1 0\n" + points + "3 0 1 2\n")).triangle.size(), 1u);
  expect_contains(message([&] { read_mesh(write("e.off", "OFF 3 1 0\n" + points + "3 0 1 2\n")); }),
                  "line of their own");
  expect_contains(message([&] { read_mesh(write("a.off", "OFF\n2000000000 1 0\n0 0 0\n")); }), "before vertex 2 of");
  expect_contains(message([&] { read_mesh(write("b.off", "OFF\n3 2000000000 0\n" + points + "3 0 1 2\n")); }),
                  "before face 2 of");
  expect_contains(message([&] { read_mesh(write("c.off", "OFF\n3 1 0\n" + points + "2000000000 0 1 2\n")); }),
                  "c.off:6: a face of 2000000000 numbers has only 3");
  expect_contains(message([&] { read_mesh(write("d.off", "OFF BINARY\n3 1 0\n")); }), "binary OFF");
}

TEST_F(MeshFiles, FaceNamesMissingVertex) {
  const auto obj = write("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
  expect_contains(message([&] { read_mesh(obj); }), "x.obj:4: face names vertex 7");
  const auto off = write("x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  expect_contains(message([&] { read_mesh(off); }), "vertex that is not there");
  const auto uv = write("y.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/2\n");
  expect_contains(message([&] { read_mesh(uv); }), "texture coordinate 2");
}

TEST_F(MeshFiles, WordInsteadOfNumber) {
  const auto file = write("x.obj", "v 0 zero 0\n");
  expect_contains(message([&] { read_mesh(file); }), "x.obj:1: y is not a number");
}

TEST_F(MeshFiles, NanVertex) {
  const auto file = write("x.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_contains(message([&] { read_mesh(file); }), "vertex 2: position is NaN");
  const auto huge = write("y.obj", "v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n");
  expect_contains(message([&] { read_mesh(huge); }), "vertex 3");
  const auto ply =
      write("z.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n");
  EXPECT_THROW(read_mesh(ply), Error);
}

TEST_F(MeshFiles, NoUv) {
  const auto file = write("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n");
  const BaseMesh mesh = read_mesh(file);
  EXPECT_TRUE(mesh.uv.empty());
  EXPECT_TRUE(find_charts(mesh).empty());
  expect_contains(message([&] { require_uv(mesh); }), "no UV");
}

TEST_F(MeshFiles, AllUvZero) {
  const auto file = write("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  const BaseMesh mesh = read_mesh(file);
  EXPECT_EQ(validate(mesh).zero_area_uv, 1u);
  expect_contains(message([&] { require_uv(mesh); }), "zero area");
}

TEST_F(MeshFiles, NonManifoldEdgesAreCountedAndNothingIsDuplicated) {
  const std::string faces = "f 1/1 2/2 3/3\nf 1/1 2/2 4/4\nf 1/1 2/2 5/5\nf 1/1 2/2 3/3\n";
  const auto file = write("x.obj",
                          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0 -1\n"
                          "vt 1 1\n" +
                              faces);
  const BaseMesh mesh = read_mesh(file);
  EXPECT_EQ(mesh.position.size(), 5u);
  EXPECT_EQ(mesh.triangle.size(), 4u);
  EXPECT_EQ(validate(mesh).non_manifold_edges, 1u);
  const auto ply = write("x.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n");
  const BaseMesh off = read_mesh(ply);
  EXPECT_EQ(off.position.size(), 5u);
  EXPECT_EQ(validate(off).non_manifold_edges, 1u);
}

std::string binary_ply(const std::string& vertices, const std::string& list, const std::string& body) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices + "element face 1\nproperty list " + list +
         " vertex_indices\nend_header\n" + body;
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

// A header costs nothing and may promise anything: what it promises has to be there before anything is reserved for it.
TEST_F(MeshFiles, BinaryPlyThatPromisesTooMuchIsRefused) {
  const std::string three(36, '\0'), face("\x03\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  const auto refused = [&](const std::string& text) { return message([&] { read_mesh(write("b.ply", text)); }); };
  EXPECT_EQ(read_mesh(write("b.ply", binary_ply("3\n" + kXyz, "uchar int", three + face))).triangle.size(), 1u);
  expect_contains(refused(binary_ply("4000000000\n" + kXyz, "uchar int", three + face)),
                  "the file ends before vertex 5 of the 4000000000");
  expect_contains(refused(binary_ply("400000000\n", "uchar int", three + face)), "without a property");
  expect_contains(refused(binary_ply("3\n" + kXyz, "uchar int", three + face.substr(0, 12))), "before face 1 of the 1");
  expect_contains(refused(binary_ply("3\n" + kXyz, "char int", three + "\x83" + face.substr(1))), "before face 1");
  expect_contains(refused(binary_ply("3\n" + kXyz, "float int", three + face)), "'float'; a whole number is needed");
  expect_contains(refused(binary_ply("3\n" + kXyz, "uchar long", three + face)), "'long' is no type of a PLY");
}

TEST_F(MeshFiles, DegenerateTrianglesAreKeptAndCounted) {
  const auto file = write("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 1/1 2/2\n");
  const MeshReport report = validate(read_mesh(file));
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_EQ(report.degenerate_triangles, 1u);
  EXPECT_EQ(report.zero_area_uv, 1u);
}

}  // namespace
}  // namespace wale
