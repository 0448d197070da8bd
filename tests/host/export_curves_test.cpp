// Exported curves are parsed back by small readers of the four formats.
#include "host/export_curves.h"

#include <cmath>
#include <sstream>

#include "tests/temporary_folder.h"

namespace wale {
namespace {

const std::vector<ExportCurve> kCurves = {
    {{{0.1f, 0.2f, 0.3f}, {1.0f / 3, -2e-7f, 5}, {1, 2, 3}, {1.5f, 2, 3}}, 0.01f},
    {{{-1, 0, 0}, {123456.789f, 0, 1e-3f}}, 0.5f / 3},
};

std::string exported(const std::string& suffix) {
  TemporaryFolder folder;
  export_curves(kCurves, folder / ("c" + suffix));
  EXPECT_EQ(folder.files(), 1u);
  return file_text(folder / ("c" + suffix));
}

// Every number between the next `open` and `close` at or after `from`, which moves behind it.
std::vector<float> numbers(const std::string& text, const std::string& key, const std::string& close, size_t& from) {
  from = text.find(key, from);
  EXPECT_NE(from, std::string::npos) << key;
  from += key.size();
  const size_t end = text.find(close, from);
  std::string part = text.substr(from, end - from);
  for (char& c : part)
    if (c == '(' || c == ')' || c == ',') c = ' ';
  std::istringstream in(part);
  std::vector<float> out;
  for (std::string word; in >> word;) out.push_back(std::stof(word));
  from = end;
  return out;
}

TEST(ExportCurves, ObjLinesReadBack) {
  std::istringstream in(exported(".obj"));
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::vector<size_t>> lines;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      auto& v = vertices.emplace_back();
      std::string x, y, z;
      words >> x >> y >> z;
      v = {std::stof(x), std::stof(y), std::stof(z)};
    } else if (kind == "l") {
      auto& l = lines.emplace_back();
      for (size_t i; words >> i;) l.push_back(i);
    }
  }
  ASSERT_EQ(lines.size(), kCurves.size());
  for (size_t c = 0; c < lines.size(); ++c) {
    ASSERT_EQ(lines[c].size(), kCurves[c].points.size());
    for (size_t i = 0; i < lines[c].size(); ++i) EXPECT_EQ(vertices.at(lines[c][i] - 1), kCurves[c].points[i]);
  }
}

TEST(ExportCurves, PbrtControlPointsPassThroughThePoints) {
  const std::string text = exported(".pbrt");
  size_t from = 0;
  for (const auto& curve : kCurves) {
    const auto width = numbers(text, "\"float width\" [", "]", from);
    ASSERT_EQ(width.size(), 1u);
    EXPECT_EQ(width[0], 2 * curve.radius);
    const auto p = numbers(text, "\"point3 P\" [", "]", from);
    ASSERT_EQ(p.size(), 3 * (3 * (curve.points.size() - 1) + 1)) << "3n+1 control points";
    for (size_t i = 0; i < curve.points.size(); ++i)
      for (int k = 0; k < 3; ++k) EXPECT_EQ(p[9 * i + k], curve.points[i][k]);
    for (size_t i = 0; i + 1 < curve.points.size(); ++i)  // straight: the inner control points are at the thirds
      for (int k = 0; k < 3; ++k)
        EXPECT_FLOAT_EQ(p[9 * i + 3 + k], float((2.0 * curve.points[i][k] + curve.points[i + 1][k]) / 3));
  }
}

TEST(ExportCurves, MitsubaLinesReadBack) {
  std::istringstream in(exported(".txt"));
  std::vector<std::vector<std::array<float, 4>>> curves(1);
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) {
      curves.emplace_back();
      continue;
    }
    std::istringstream words(line);
    auto& v = curves.back().emplace_back();
    for (float& x : v) {
      std::string word;
      words >> word;
      x = std::stof(word);
    }
  }
  ASSERT_EQ(curves.size(), kCurves.size());
  for (size_t c = 0; c < curves.size(); ++c) {
    ASSERT_EQ(curves[c].size(), kCurves[c].points.size());
    for (size_t i = 0; i < curves[c].size(); ++i) {
      for (int k = 0; k < 3; ++k) EXPECT_EQ(curves[c][i][k], kCurves[c].points[i][k]);
      EXPECT_EQ(curves[c][i][3], kCurves[c].radius);
    }
  }
}

TEST(ExportCurves, UsdArraysReadBack) {
  const std::string text = exported(".usda");
  EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
  size_t from = 0;
  EXPECT_EQ(numbers(text, "curveVertexCounts = [", "]", from), (std::vector<float>{4, 2}));
  const auto points = numbers(text, "points = [", "]", from);
  size_t at = 0;
  ASSERT_EQ(points.size(), 18u);
  for (const auto& curve : kCurves)
    for (const auto& p : curve.points)
      for (float v : p) EXPECT_EQ(points[at++], v);
  EXPECT_EQ(numbers(text, "widths = [", "]", from), (std::vector<float>{0.02f, 2 * kCurves[1].radius}));
}

TEST(ExportCurves, BadInputIsRefusedAndLeavesNothing) {
  TemporaryFolder folder;
  const auto file = folder / "c.obj";
  EXPECT_EQ(user_message([&] { export_curves(kCurves, folder / "c.fbx"); }),
            (folder / "c.fbx").string() +
                ": no export format has the suffix \".fbx\"; valid: .obj, .pbrt, .txt (Mitsuba), .usda");
  EXPECT_EQ(user_message([&] {
              export_curves({{{{0, 0, 0}}, 1}}, file);
            }),
            file.string() + ": curve 0 has fewer than 2 points");
  EXPECT_EQ(user_message([&] {
              export_curves({{{{0, 0, 0}, {NAN, 0, 0}}, 1}}, file);
            }),
            file.string() + ": curve 0, point 1: nan is not a finite number");
  EXPECT_EQ(user_message([&] {
              export_curves({{{{0, 0, 0}, {1, 0, 0}}, 0}}, file);
            }),
            file.string() + ": curve 0: radius 0 is not positive");
  EXPECT_NE(user_message([&] { export_curves(kCurves, "/no/such/c.obj"); }).find("does not exist"), std::string::npos);
  EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace wale
