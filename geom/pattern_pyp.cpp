// Periodic yarn patterns of Sperl et al. 2020 (MADYPG/HYLC), `.pyp`: vertices and directed edges on a torus.
#include <map>

#include "geom/pattern_readers.h"
#include "geom/text_lines.h"

namespace wale {
namespace {

struct Block {
  int line = 0;
  std::vector<TextLine> rows;
};

struct Edge {
  int to = -1;
  ivec2 shift{0, 0};
};

class PypFile {
 public:
  PypFile(std::string_view text, const std::filesystem::path& file) : file_(file) {
    Block* block = nullptr;
    for (TextLine& line : text_lines(text, '#')) {
      if (line.words[0][0] == '*') {
        block = &blocks_[line.words[0]];
        block->line = line.number;
        block->rows.clear();
      } else if (block) {
        block->rows.push_back(std::move(line));
      } else {
        user_error("{}:{}: expected a block such as '*pattern', found '{}'", file.string(), line.number, line.words[0]);
      }
    }
  }

  const Block& block(std::string_view name, size_t rows, size_t columns) const {
    const auto found = blocks_.find(name);
    if (found == blocks_.end()) user_error("{}: block '{}' is missing; is the file cut off?", file_.string(), name);
    const Block& result = found->second;
    if (result.rows.size() != rows)
      user_error("{}:{}: block '{}' has {} rows; {} are expected", file_.string(), result.line, name,
                 result.rows.size(), rows);
    for (const TextLine& row : result.rows)
      if (row.words.size() < columns)
        user_error("{}:{}: a row of '{}' has {} numbers; {} are needed", file_.string(), row.number, name,
                   row.words.size(), columns);
    return result;
  }

  double number(const TextLine& row, size_t column) const {
    return finite_number(file_, row.number, row.words[column]);
  }
  long whole(const TextLine& row, size_t column) const { return whole_number(file_, row.number, row.words[column]); }
  const std::filesystem::path& path() const { return file_; }

 private:
  const std::filesystem::path& file_;
  std::map<std::string_view, Block> blocks_;
};

/// Every vertex has exactly one edge out and one in, so the edges are a permutation: cycles on the torus.
std::vector<Edge> read_edges(const PypFile& file, size_t count) {
  std::vector<Edge> edges(count);
  std::vector<bool> entered(count, false);
  for (const TextLine& row : file.block("*E", count, 4).rows) {
    const long from = file.whole(row, 0), to = file.whole(row, 1), dx = file.whole(row, 2), dy = file.whole(row, 3);
    for (const long v : {from, to})
      if (v < 0 || v >= static_cast<long>(count))
        user_error("{}:{}: vertex {} does not exist; vertices are 0 to {}", file.path().string(), row.number, v,
                   count - 1);
    if (dx < -1 || dx > 1 || dy < -1 || dy > 1)
      user_error("{}:{}: edge crosses by {}, {} periods; only -1, 0 and 1 are possible", file.path().string(),
                 row.number, dx, dy);
    if (edges[from].to >= 0)
      user_error("{}:{}: a second edge leaves vertex {}; a yarn does not branch", file.path().string(), row.number,
                 from);
    if (entered[to])
      user_error("{}:{}: a second edge enters vertex {}; a yarn does not branch", file.path().string(), row.number, to);
    edges[from] = {static_cast<int>(to), ivec2(dx, dy)};
    entered[to] = true;
  }
  return edges;
}

dvec3 displaced(const dvec3& p, ivec2 shift, dvec2 period) {
  return p + dvec3(shift.x * period.x, shift.y * period.y, 0);
}

/// Cuts one cycle after each edge that crosses a border. The far vertex is repeated, displaced, as the last point of
/// the curve, so that partner ends coincide exactly.
void cut_cycle(int first, const std::vector<Edge>& edges, const std::vector<dvec3>& vertices, Pattern& pattern) {
  int v = first;
  do {
    if (edges[v].shift != ivec2(0, 0)) {
      first = edges[v].to;
      break;
    }
    v = edges[v].to;
  } while (v != first);

  PatternCurve curve;
  v = first;
  do {
    curve.points.push_back(vertices[v]);
    const Edge& edge = edges[v];
    if (edge.shift != ivec2(0, 0)) {
      curve.points.push_back(displaced(vertices[edge.to], edge.shift, pattern.period));
      pattern.curves.push_back(std::move(curve));
      curve = {};
    }
    v = edge.to;
  } while (v != first);
  if (!curve.points.empty()) {
    curve.closed = true;  // no border crossed: a ring in space
    pattern.curves.push_back(std::move(curve));
  }
}

}  // namespace

Pattern parse_pyp(std::string_view text, const std::filesystem::path& path, const PatternHints& hints) {
  const PypFile file(text, path);
  const TextLine& head = file.block("*pattern", 1, 4).rows[0];
  Pattern pattern;
  for (const int axis : {0, 1}) {
    pattern.period[axis] = hints.period[axis] > 0 ? hints.period[axis] : file.number(head, axis);
    if (!(pattern.period[axis] > 0))
      user_error("{}:{}: the period is {} m; it must be positive", path.string(), head.number, pattern.period[axis]);
  }
  pattern.yarn_radius = hints.yarn_radius > 0 ? hints.yarn_radius : file.number(head, 2);
  if (!(pattern.yarn_radius > 0))
    user_error("{}:{}: the yarn radius is {} m; it must be positive", path.string(), head.number, pattern.yarn_radius);
  const long count = file.whole(head, 3);
  if (count < 1) user_error("{}:{}: the tile has {} vertices; it needs some", path.string(), head.number, count);

  std::vector<dvec3> vertices;
  for (const TextLine& row : file.block("*Q", count, 3).rows)
    vertices.emplace_back(file.number(row, 0), file.number(row, 1), file.number(row, 2));
  const std::vector<Edge> edges = read_edges(file, count);

  std::vector<bool> seen(count, false);
  for (int v = 0; v < count; ++v) {
    if (seen[v]) continue;
    for (int w = v; !seen[w]; w = edges[w].to) seen[w] = true;
    cut_cycle(v, edges, vertices, pattern);
  }
  return pattern;
}

}  // namespace wale
