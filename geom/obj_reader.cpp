#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "geom/error.h"
#include "geom/polygon_soup.h"

namespace wale {
namespace {

/// One line of the file, eaten from the left.
struct Line {
  const char* at;
  const char* end;
  size_t number;
  const std::string& file;

  bool skip_blank() {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    return at != end;
  }

  double number_or_fail(const char* what) {
    if (!skip_blank()) user_error("{}:{}: {} is missing; write a number", file, number, what);
    if (*at == '+') ++at;
    double value = 0;
    const auto [rest, error] = std::from_chars(at, end, value);
    const std::string_view text(at, static_cast<size_t>(rest - at));
    if (error == std::errc::result_out_of_range) {
      // Too small counts as 0; too large is refused later, with the vertex number.
      value =
          text.find("e-") != text.npos || text.find("E-") != text.npos ? 0.0 : std::numeric_limits<double>::infinity();
    } else if (error != std::errc{} ||
               (rest != end && *rest != ' ' && *rest != '\t' && *rest != '\r' && *rest != '#')) {
      user_error("{}:{}: {} is not a number: '{}'", file, number, what,
                 std::string(at, std::min<size_t>(static_cast<size_t>(end - at), 20)));
    }
    at = rest;
    return value;
  }

  /// A 1-based or negative (relative) index into `count` items, as 0-based.
  int64_t index_or_fail(const char* what, size_t count) {
    int64_t value = 0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc{}) user_error("{}:{}: face corner needs a {} number", file, number, what);
    at = rest;
    const int64_t n = static_cast<int64_t>(count);
    const int64_t i = value < 0 ? n + value : value - 1;
    if (value == 0 || i < 0 || i >= n)
      user_error("{}:{}: face names {} {}, but {} precede it; valid are 1 to {}", file, number, what, value, n, n);
    return i;
  }
};

void parse_face(Line& line, PolygonSoup& soup) {
  const size_t begin = soup.vertex.size();
  while (line.skip_blank() && *line.at != '#') {
    soup.vertex.push_back(static_cast<uint32_t>(line.index_or_fail("vertex", soup.position.size())));
    int64_t uv = -1;
    if (line.at != line.end && *line.at == '/') {
      ++line.at;
      if (line.at != line.end && *line.at != '/' && *line.at != ' ' && *line.at != '\r')
        uv = line.index_or_fail("texture coordinate", soup.uv.size());
    }
    soup.uv_index.push_back(uv);
    while (line.at != line.end && *line.at != ' ' && *line.at != '\t') ++line.at;  // the normal
  }
  if (soup.vertex.size() - begin >= 3) {
    soup.face_begin.push_back(static_cast<uint32_t>(begin));
  } else {
    soup.vertex.resize(begin);
    soup.uv_index.resize(begin);
  }
}

}  // namespace

PolygonSoup parse_obj(std::string_view original, const std::string& file) {
  std::string text(original);
  // A backslash at the end of a line (LF or CR LF) joins the next one to it.
  for (size_t at = 0; (at = text.find('\\', at)) != std::string::npos; ++at) {
    const size_t feed = text.compare(at + 1, 1, "\r") == 0 ? at + 2 : at + 1;
    if (feed < text.size() && text[feed] == '\n') text[at] = text[feed] = ' ';
  }

  PolygonSoup soup;
  size_t number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    Line line{text.data() + begin, text.data() + end, ++number, file};
    begin = end + 1;
    if (!line.skip_blank()) continue;
    const char* word = line.at;
    while (line.at != line.end && *line.at != ' ' && *line.at != '\t' && *line.at != '\r') ++line.at;
    const std::string_view key(word, static_cast<size_t>(line.at - word));
    if (key == "v") {
      const double x = line.number_or_fail("x"), y = line.number_or_fail("y"), z = line.number_or_fail("z");
      soup.position.emplace_back(x, y, z);
    } else if (key == "vt") {
      const double u = line.number_or_fail("u");
      const double v = line.skip_blank() ? line.number_or_fail("v") : 0;
      soup.uv.emplace_back(u, v);
    } else if (key == "f") {
      parse_face(line, soup);
    }
  }
  return soup;
}

}  // namespace wale
