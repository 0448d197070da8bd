#pragma once
#include <functional>
#include <span>
#include <vector>

#include "geom/fabric.h"
#include "host/ply_tree.h"
#include "shared/wale_types.h"

namespace wale {

/// What a lattice fabric's numbers start from, over all fabrics.
struct LatticeInput {
  const Fabric* fabric = nullptr;
  uint32_t number = 0;  ///< of the fabric
  uint32_t material = 0;
  float tau = 0;
  uint32_t first_vertex = 0;  ///< id of its first segment
  uint32_t first_ply = 0;
};

/// A yarn of a tile all over a stored cloth, and how many vertices that makes.
struct StoredRun {
  WLatticeRun run;
  uint32_t vertices = 0;
};

/// Leaves of one pass of a yarn of `plies` through its tile.
uint32_t patches_of(const TileYarn& yarn, uint32_t plies);

/// Device form of lattices and their tiles (W_PATCH_*, WTileVertex, W_LATTICE_WORDS of kernels/shared/wale_types.h).
class LatticeTables {
 public:
  /// Throws a user error where the leaves cannot be numbered.
  LatticeTables(std::span<const LatticeInput> inputs, dvec3 origin, Joints joints = Joints::mitre);

  const std::vector<uint32_t>& words() const { return words_; }
  const std::vector<float>& lattice() const { return lattice_; }
  uint32_t patch_bits() const { return patch_bits_; }

  /// Leaf numbers of a fabric, ascending, without W_LEAF_PROCEDURAL.
  std::vector<uint32_t> leaves(uint32_t fabric) const;
  /// The same patches over stored vertices.
  std::vector<PlyPatch> patches(uint32_t fabric) const;
  /// How the kernel lattice_vertices fills in those vertices.
  std::vector<StoredRun> runs(uint32_t fabric) const;

 private:
  /// A patch of a tile, also as it stands at the open ends of its yarn.
  struct Entry {
    size_t yarn;
    uint32_t first, intervals;
    bool open_start, open_end;
  };
  struct Piece {  ///< one chart
    LatticeInput input;
    const LatticeChart* chart;
    uint32_t first_entry, first_corner;
    std::vector<Entry> entries;
    std::vector<WLatticeRun> runs;  ///< per yarn
  };
  void add_chart(const LatticeInput& input, const LatticeChart& chart, uint32_t& vertices, uint32_t& plies,
                 dvec3 origin);
  void write_entry(Piece& piece, size_t number);
  void write_rows(const Piece& piece, const Entry& entry, uint32_t* head);
  /// Calls visit(piece, entry number, tile) in the order of leaf numbers.
  void for_each(uint32_t fabric, const std::function<void(const Piece&, size_t, ivec2)>& visit) const;

  Joints joints_;
  std::vector<Piece> pieces_;
  std::vector<uint32_t> words_;
  std::vector<float> lattice_;
  uint32_t patch_bits_ = 0;
};

}  // namespace wale
