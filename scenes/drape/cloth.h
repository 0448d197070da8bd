#pragma once
#include <cstdint>
#include <vector>

#include "geom/base_mesh.h"

namespace wale::drape {

/// A square of cloth over a ball; lengths in metres, times in seconds.
struct Setup {
  double size = 0.3;          ///< of the cloth
  int cells = 96;             ///< along a side
  double radius = 0.08;       ///< of the ball, whose centre is the origin
  double gap = 0.02;          ///< between ball and cloth at the start
  double thickness = 0.0045;  ///< layers of cloth and the ball keep this distance, and half of it, from the mesh
  double turn = 0.3;          ///< of the cloth about z, radians
  dvec2 off_centre{0.006, 0.003};
  double friction = 0.45;
  double frame_seconds = 0.01;
  int steps_per_frame = 48;
};

/// Particles joined by threads along warp and weft, across, and over two cells against bending, moved by extended
/// position-based dynamics in small steps (Macklin, Müller, Chentanez 2016; Macklin et al. 2019). Threads are drawn in
/// an order of colours, one thread only: the same bytes on every run of one machine.
class Cloth {
 public:
  explicit Cloth(const Setup& setup);

  /// One frame on.
  void advance();

  /// At rest in the plane, UV in metres from a corner.
  BaseMesh rest() const;
  const std::vector<dvec3>& positions() const { return x_; }

 private:
  struct Thread {
    uint32_t a = 0, b = 0;
    double length = 0;
    double compliance = 0;  ///< metres per newton, per kilogram of a particle
  };
  uint32_t at(int i, int j) const { return uint32_t(j * side_ + i); }
  void add_threads(int di, int dj, double compliance);
  void step(double dt);
  void keep_off_ball();
  void keep_layers_apart();
  dvec2 rest_place(uint32_t particle) const;

  Setup setup_;
  int side_;
  double spacing_;
  std::vector<dvec3> x_, before_, v_;
  std::vector<Thread> threads_;
};

}  // namespace wale::drape
