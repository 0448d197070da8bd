#pragma once
#include <optional>
#include <string>
#include <vector>

namespace wale::fit {

/// What is measured on a picture of the cloth, metres and radians; what was not is absent.
struct ClothMeasures {
  std::optional<double> wale, course;  ///< distance of neighbouring wales and courses
  std::optional<double> yarn, ply;     ///< diameters
  std::optional<double> angle;         ///< of the plies to the yarn's axis where they are nearest to the viewer
  std::optional<int> plies;
};

/// The same as a scene says it.
struct ClothParameters {
  std::optional<double> wales, courses;  ///< per 10 cm
  std::optional<double> thickness;       ///< factor on the tile's yarn
  std::optional<int> plies;
  std::optional<double> ply_radius;   ///< metres; absent: touching circles that fill the yarn have it
  std::optional<double> twist_pitch;  ///< yarn radii
  std::vector<std::string> notes;     ///< what was concluded or does not agree, one line each
};

/// `tile_radius`: metres, of the tile's yarn at the measured gauge with a thickness of 1. A ply's axis winds at the
/// distance R - r from the yarn's (R, r: radii), so that tan(angle) = 2 pi (R - r) / pitch; n touching plies that fill
/// the yarn have r / R = s / (1 + s), s = sin(pi / n) (geom/fill_yarn.cpp). `own`: plies and twist of the scene.
struct OwnYarn {
  int plies = 3;
  double twist_pitch = 8;
};
ClothParameters cloth_parameters(const ClothMeasures& measures, double tile_radius, const OwnYarn& own);

}  // namespace wale::fit
