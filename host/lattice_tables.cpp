#include "host/lattice_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "geom/error.h"
#include "geom/stored_length.h"

namespace wale {
namespace {

constexpr size_t kRowAlign = 16;  // words: rows are loaded as whole vectors

// Lengths as 2^-32 of their period.
uint32_t fixed_length(double metres, const StoredLength& stored) {
  const double periods = stored.stretch * metres / stored.period;
  return uint32_t(uint64_t(std::llround((periods - std::floor(periods)) * 4294967296.0)));
}

int lattice_offset(const Lattice& lattice, ivec2 cell) { return W_LATTICE_WORDS * (cell.x + cell.y * lattice.size.x); }

bool is_open(const Lattice& lattice, const TileYarn& yarn) { return lattice.wrap[yarn.axis] == 0; }

}  // namespace

uint32_t patches_of(const TileYarn& yarn, uint32_t plies) {
  const uint32_t most = W_LEAF_LANES / plies;
  return (yarn.samples + most - 1) / most;
}

LatticeTables::LatticeTables(std::span<const LatticeInput> inputs, dvec3 origin, Joints joints) : joints_(joints) {
  for (const LatticeInput& input : inputs) {
    uint32_t vertices = input.first_vertex, plies = input.first_ply;
    for (const LatticeChart& chart : input.fabric->lattice) add_chart(input, chart, vertices, plies, origin);
  }
  if (pieces_.empty()) return;
  const size_t entries = pieces_.back().first_entry + pieces_.back().entries.size();
  patch_bits_ = uint32_t(std::bit_width(entries - 1));
  if (lattice_.size() / W_LATTICE_WORDS << patch_bits_ > W_LEAF_PROCEDURAL)
    user_error(
        "fabrics: {} tile patches at {} lattice vertices cannot be numbered; use fewer repeats or a coarser lattice",
        entries, lattice_.size() / W_LATTICE_WORDS);
  words_.resize(entries * W_PATCH_WORDS, 0);
  for (Piece& piece : pieces_) {
    for (size_t y = 0; y < piece.runs.size(); ++y) {
      const TileYarn& yarn = piece.chart->tile.yarns[y];
      WLatticeRun& run = piece.runs[y];
      run.table = uint32_t(words_.size());
      for (uint32_t p = 0; p < run.plies; ++p) {
        const double lap = is_open(piece.chart->lattice, yarn) ? 0 : yarn.lap[p] * run.tiles;
        const StoredLength stored =
            stored_length(0, p, piece.input.fabric->ply_radius, piece.input.fabric->fibre_twist, lap);
        for (uint32_t k = 0; k <= yarn.samples; ++k) {
          const TileVertex& v = yarn.at(p, int(k));
          WTileVertex out{lattice_offset(piece.chart->lattice, v.cell),
                          fixed_length(v.length, stored),
                          fixed_length(yarn.lap[p], stored),
                          lattice_offset(piece.chart->lattice, {0, 1}),
                          {},
                          {},
                          {},
                          {}};
          std::copy_n(v.w, 4, out.w), std::copy_n(v.h, 4, out.h);
          std::copy_n(v.a, 4, out.a), std::copy_n(v.b, 4, out.b);
          const auto raw = std::bit_cast<std::array<uint32_t, sizeof(WTileVertex) / 4>>(out);
          words_.insert(words_.end(), raw.begin(), raw.end());
        }
      }
    }
    for (size_t i = 0; i < piece.entries.size(); ++i) write_entry(piece, i);
  }
  words_.resize(words_.size() + 2 * W_PATCH_POINTS, 0);  // lanes that are masked read past the last row
}

void LatticeTables::add_chart(const LatticeInput& input, const LatticeChart& chart, uint32_t& vertices, uint32_t& plies,
                              dvec3 origin) {
  Piece piece{input, &chart, 0, uint32_t(lattice_.size() / W_LATTICE_WORDS), {}, {}};
  if (!pieces_.empty()) piece.first_entry = pieces_.back().first_entry + uint32_t(pieces_.back().entries.size());
  const Lattice& lattice = chart.lattice;
  for (size_t i = 0; i < lattice.position.size(); ++i) {
    for (int k = 0; k < 3; ++k) lattice_.push_back(float(lattice.position[i][k] - origin[k]));
    for (int k = 0; k < 3; ++k) lattice_.push_back(float(lattice.normal[i][k]));
  }
  const uint32_t n = uint32_t(chart.tile.plies);
  std::vector<Entry> at_ends;
  for (size_t y = 0; y < chart.tile.yarns.size(); ++y) {
    const TileYarn& yarn = chart.tile.yarns[y];
    const bool open = is_open(lattice, yarn);
    WLatticeRun run{};
    run.first_vertex = vertices;
    run.tiles = uint32_t(lattice.tiles[yarn.axis]);
    run.count = run.tiles * yarn.samples + (open ? 1 : 3);
    run.plies = n;
    run.ghosts = !open;
    run.samples = yarn.samples;
    run.axis = uint32_t(yarn.axis);
    run.first_ply = plies;
    run.stride = yarn.samples + 1;
    run.corner = piece.first_corner + lattice.corner({0, 0});
    run.pitch = uint32_t(lattice.size.x);
    run.cells = uint32_t(lattice.cells);
    run.radius = float(chart.tile.ply_radius);
    piece.runs.push_back(run);
    const uint32_t lines = uint32_t(lattice.tiles[1 - yarn.axis]);
    vertices += lines * n * run.count;
    plies += lines * n;
    // As even as can be: a short rest would leave lanes empty.
    const uint32_t patches = patches_of(yarn, n);
    for (uint32_t i = 0; i < patches; ++i) {
      const uint32_t first = i * yarn.samples / patches, last = (i + 1) * yarn.samples / patches;
      const bool starts = open && i == 0, ends = open && i + 1 == patches;
      piece.entries.push_back({y, first, last - first, false, false});
      if (starts) at_ends.push_back({y, first, last - first, true, false});
      if (ends) at_ends.push_back({y, first, last - first, false, true});
      if (starts && ends) at_ends.push_back({y, first, last - first, true, true});
    }
  }
  piece.entries.insert(piece.entries.end(), at_ends.begin(), at_ends.end());
  pieces_.push_back(std::move(piece));
}

void LatticeTables::write_entry(Piece& piece, size_t number) {
  const Entry& entry = piece.entries[number];
  const WLatticeRun& run = piece.runs[entry.yarn];
  const uint32_t n = run.plies, lanes = n * entry.intervals;
  std::array<uint32_t, W_PATCH_WORDS> head{};
  head[W_LEAF_RADIUS] = std::bit_cast<uint32_t>(run.radius);
  head[W_LEAF_SEGMENT] = run.first_vertex + run.ghosts + entry.first;
  head[W_LEAF_STRIDE] = run.count;
  head[W_LEAF_MATERIAL] = piece.input.material;
  head[W_LEAF_LAYOUT] = n | lanes << 8;
  head[W_LEAF_TAU] = std::bit_cast<uint32_t>(piece.input.tau);
  head[W_LEAF_FABRIC] = piece.input.number;
  head[W_PATCH_ENDS] = (entry.open_start ? 1u : 0u) | (entry.open_end ? 2u : 0u);
  head[W_LEAF_PLY] = run.first_ply;
  for (uint32_t p = 0; p < n; ++p) {
    if (entry.open_start) head[W_LEAF_CUTS] |= 1u << p;
    if (entry.open_end) head[W_LEAF_CUTS] |= 1u << (16 + lanes - n + p);
  }
  head[W_LEAF_SPHERES] = joints_ == Joints::open ? 0 : head[W_LEAF_CUTS];
  const uint32_t all = (1u << lanes) - 1u;
  if (joints_ != Joints::mitre) head[W_LEAF_CUTS] = all | all << 16;
  if (joints_ == Joints::capsule) {
    head[W_LEAF_SPHERES] |= all;
    head[W_LEAF_LAYOUT] |= W_LAYOUT_CAPSULES;
  }
  head[W_PATCH_VERTEX] = run.table + entry.first * uint32_t(sizeof(WTileVertex) / 4);
  head[W_PATCH_VERTEX_STRIDE] = run.stride;
  head[W_PATCH_CORNER] = run.corner;
  head[W_PATCH_PITCH] = run.pitch;
  head[W_PATCH_CELLS] = run.cells;
  head[W_PATCH_AXIS] = run.axis;
  const uint32_t along = run.samples, across = n * run.count;
  head[W_PATCH_SEGMENT_COLUMN] = run.axis ? across : along;
  head[W_PATCH_SEGMENT_ROW] = run.axis ? along : across;
  head[W_PATCH_PLY_COLUMN] = run.axis ? n : 0;
  head[W_PATCH_PLY_ROW] = run.axis ? 0 : n;
  write_rows(piece, entry, head.data());
  std::copy(head.begin(), head.end(), words_.begin() + std::ptrdiff_t((piece.first_entry + number) * W_PATCH_WORDS));
}

void LatticeTables::write_rows(const Piece& piece, const Entry& entry, uint32_t* head) {
  const TileYarn& yarn = piece.chart->tile.yarns[entry.yarn];
  const uint32_t n = piece.runs[entry.yarn].plies;
  struct Rows {
    std::array<float, W_PATCH_POINTS> w{}, h{};
  };
  std::map<int, Rows> controls;  // ascending by offset: row by row of the lattice, as each vertex's own corners
  for (int k = 0; k < int(entry.intervals) + 3; ++k)
    for (uint32_t p = 0; p < n; ++p) {
      int sample = int(entry.first) + k - 1;
      if (entry.open_start) sample = std::max(sample, 0);
      if (entry.open_end) sample = std::min(sample, int(yarn.samples));
      const TileVertex& v = yarn.at(p, sample);
      for (int c = 0; c < 4; ++c) {
        if (v.w[c] == 0 && v.h[c] == 0) continue;
        Rows& rows = controls[lattice_offset(piece.chart->lattice, v.cell + ivec2(c & 1, c >> 1))];
        rows.w[size_t(k) * n + p] = v.w[c];
        rows.h[size_t(k) * n + p] = v.h[c];
      }
    }
  head[W_PATCH_CONTROLS] = uint32_t(words_.size());
  head[W_PATCH_CONTROL_COUNT] = uint32_t(controls.size());
  for (const auto& [offset, rows] : controls) words_.push_back(std::bit_cast<uint32_t>(offset));
  words_.resize((words_.size() + kRowAlign - 1) / kRowAlign * kRowAlign, 0);
  head[W_PATCH_ROWS] = uint32_t(words_.size());
  for (const auto& [offset, rows] : controls)
    for (const auto& row : {rows.w, rows.h})
      for (const float x : row) words_.push_back(std::bit_cast<uint32_t>(x));
}

void LatticeTables::for_each(uint32_t fabric, const std::function<void(const Piece&, size_t, ivec2)>& visit) const {
  for (const Piece& piece : pieces_) {
    if (piece.input.number != fabric) continue;
    const Lattice& lattice = piece.chart->lattice;
    for (int y = 0; y < lattice.tiles.y; ++y)
      for (int x = 0; x < lattice.tiles.x; ++x)
        for (size_t i = 0; i < piece.entries.size(); ++i) {
          const Entry& entry = piece.entries[i];
          const WLatticeRun& run = piece.runs[entry.yarn];
          const uint32_t along = uint32_t(run.axis ? y : x);
          const bool starts = !run.ghosts && along == 0 && entry.first == 0;
          const bool ends = !run.ghosts && along + 1 == run.tiles && entry.first + entry.intervals == run.samples;
          if (starts == entry.open_start && ends == entry.open_end) visit(piece, i, {x, y});
        }
  }
}

std::vector<uint32_t> LatticeTables::leaves(uint32_t fabric) const {
  std::vector<uint32_t> out;
  for_each(fabric, [&](const Piece& piece, size_t entry, ivec2 tile) {
    out.push_back((piece.first_corner + piece.chart->lattice.corner(tile)) << patch_bits_ |
                  uint32_t(piece.first_entry + entry));
  });
  return out;
}

std::vector<PlyPatch> LatticeTables::patches(uint32_t fabric) const {
  std::vector<PlyPatch> out;
  for_each(fabric, [&](const Piece& piece, size_t number, ivec2 tile) {
    const Entry& entry = piece.entries[number];
    const WLatticeRun& run = piece.runs[entry.yarn];
    const uint32_t along = uint32_t(tile[int(run.axis)]), line = uint32_t(tile[1 - int(run.axis)]);
    PlyPatch patch;
    patch.first_vertex = run.first_vertex + line * run.plies * run.count;
    patch.count = run.count;
    patch.first = run.ghosts + along * run.samples + entry.first;
    patch.intervals = entry.intervals;
    patch.plies = run.plies;
    patch.fabric = fabric;
    patch.material = piece.input.material;
    patch.first_ply = run.first_ply + line * run.plies;
    patch.radius = run.radius;
    patch.tau = piece.input.tau;
    patch.ghost_ends = run.ghosts != 0;
    out.push_back(patch);
  });
  return out;
}

std::vector<StoredRun> LatticeTables::runs(uint32_t fabric) const {
  std::vector<StoredRun> out;
  for (const Piece& piece : pieces_)
    if (piece.input.number == fabric)
      for (const WLatticeRun& run : piece.runs)
        out.push_back({run, uint32_t(piece.chart->lattice.tiles[1 - int(run.axis)]) * run.plies * run.count});
  return out;
}

}  // namespace wale
