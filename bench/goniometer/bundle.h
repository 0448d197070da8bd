#pragma once
#include <vector>

#include "geom/fibre_section.h"
#include "geom/vec.h"

namespace wale {

/// An endless helical bundle: the straight pieces of its fibres in a slab along z of 0.15 radians of twist, continued
/// by screw symmetry. Ply radius 1, axis z. A fibre strays from its chord by less than 0.003 ply radii. Migration is
/// left out: a migrating bundle has no screw symmetry.
class Bundle {
 public:
  explicit Bundle(const FibreRecipe& recipe);

  /// A ray inside the ply, in the slab. turn: by how much directions must be turned about z to be in the frame that the
  /// ray started in.
  struct Ray {
    dvec3 origin, direction;
    double turn = 0;
  };

  /// Carries the ray to the next fibre it meets, passing over fibre `ignored` (-1: none): the origin becomes the point
  /// of that fibre's axis nearest to the ray, and the fibre's number is returned. -1: the ray has left the ply, its
  /// origin on the surface.
  int advance(Ray& ray, int ignored) const;

  dvec3 axis(int fibre) const { return pieces_[size_t(fibre)].axis; }
  double slab() const { return slab_; }
  int fibres() const { return int(pieces_.size()); }

 private:
  struct Piece {
    dvec3 centre, axis;
  };
  struct Hit {
    int fibre = -1;
    double t;
  };
  Hit nearest(const Ray& ray, double limit, int ignored) const;
  double entry(const Piece& piece, const Ray& ray) const;
  void build_grid();

  double radius_, slab_, angle_;
  std::vector<Piece> pieces_;
  int cells_ = 1;
  std::vector<int> first_, list_;  ///< fibres of cell i: list_[first_[i]] to list_[first_[i + 1]]
};

}  // namespace wale
