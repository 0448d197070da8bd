#pragma once
#include "host/scene.h"

namespace wale {

/// A step of who looks: around the middle of the picture, along it, nearer or farther.
struct CameraMove {
  double right = 0, up = 0;          ///< orbit, radians: where the camera goes around look_at
  double pan_right = 0, pan_up = 0;  ///< picture heights, at the distance of look_at
  double zoom = 1;                   ///< factor on the distance, or on the height of an orthographic picture
};

/// The camera after a step. It keeps its `up`, from which it stays 2 degrees away, and a distance of 1e-6 to 1e5
/// metres.
CameraScene moved_camera(CameraScene camera, const CameraMove& move);

}  // namespace wale
