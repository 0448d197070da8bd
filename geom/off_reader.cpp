#include <limits>

#include "geom/polygon_soup.h"
#include "geom/word_lines.h"

namespace wale {
namespace {

/// What the first word, [ST][C][N]OFF, says of each vertex.
struct OffVertex {
  bool texture = false, colors = false, normals = false;
};

OffVertex read_magic(WordLines& lines, const std::string& file) {
  if (!lines.next('#')) user_error("{}: not a mesh that can be read: the file is empty", file);
  std::string_view letters = lines.word();
  const auto has = [&](std::string_view what) {
    const bool found = letters.starts_with(what);
    if (found) letters.remove_prefix(what.size());
    return found;
  };
  OffVertex vertex;
  vertex.texture = has("ST"), vertex.colors = has("C"), vertex.normals = has("N");
  if (letters != "OFF") user_error("{}: not a mesh that can be read; give a complete OBJ, PLY or OFF file", file);
  if (lines.rest().find("BINARY") != std::string_view::npos)
    user_error("{}: a binary OFF is not read; save it as text, or as PLY", file);
  if (lines.rest().find_first_of("0123456789") != std::string_view::npos)
    user_error("{}: not a mesh that can be read: put the counts on a line of their own, below the word OFF", file);
  return vertex;
}

}  // namespace

PolygonSoup parse_off(std::string_view text, const std::string& file) {
  WordLines lines(text, file);
  const OffVertex vertex = read_magic(lines, file);
  lines.element("line", 0, 1, '#');
  const size_t vertices = lines.count("vertices"), faces = lines.count("faces");
  lines.count("edges");
  lines.end("count");
  PolygonSoup soup;
  for (size_t i = 0; i < vertices; ++i) {
    lines.element("vertex", i, vertices, '#');
    // In a row: place, normal, colour of any length, texture coordinates.
    std::vector<double> values = lines.numbers(3 + (vertex.normals ? 3 : 0) + (vertex.texture ? 2 : 0), "a vertex");
    while (vertex.colors && lines.more()) values.push_back(lines.numbers(1, "a vertex")[0]);
    lines.end("vertex");
    soup.position.emplace_back(values[0], values[1], values[2]);
    if (vertex.texture) soup.uv.emplace_back(values[values.size() - 2], values[values.size() - 1]);
  }
  for (size_t i = 0; i < faces; ++i) {
    lines.element("face", i, faces, '#');
    const auto corners = lines.whole_numbers(lines.count("corners"), 0, std::numeric_limits<int32_t>::max(), "a face");
    if (corners.size() < 3) continue;
    soup.face_begin.push_back(static_cast<uint32_t>(soup.vertex.size()));
    for (const int64_t corner : corners) {
      if (static_cast<size_t>(corner) >= vertices)
        user_error("{}:{}: a face names a vertex that is not there: {}; valid are 0 to {}", file, lines.number(),
                   corner, int64_t(vertices) - 1);
      soup.vertex.push_back(static_cast<uint32_t>(corner));
    }
  }
  if (vertex.texture) soup.uv_index.assign(soup.vertex.begin(), soup.vertex.end());
  return soup;
}

}  // namespace wale
