#include "host/serve/camera_move.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "host/viewpoint.h"

namespace wale {

CameraScene moved_camera(CameraScene camera, const CameraMove& move) {
  constexpr double kPole = 2 * std::numbers::pi / 180, kNearest = 1e-6, kFarthest = 1e5;
  const dvec3 axis = glm::normalize(camera.up);
  dvec3 out = camera.position - camera.look_at;  // from the middle to the camera
  // Around `up`, then over it: the polar angle is kept from both poles.
  out = glm::angleAxis(move.right, axis) * out;
  const double polar = std::acos(std::clamp(glm::dot(glm::normalize(out), axis), -1.0, 1.0));
  const double wanted = std::clamp(polar - move.up, kPole, std::numbers::pi - kPole);
  const dvec3 side = glm::normalize(glm::cross(axis, out));
  out = glm::angleAxis(wanted - polar, side) * out;
  if (camera.orthographic)
    camera.height = std::clamp(camera.height * move.zoom, kNearest, kFarthest);
  else
    out *= std::clamp(glm::length(out) * move.zoom, kNearest, kFarthest) / glm::length(out);
  const ViewFrame frame(camera.look_at + out, camera.look_at, camera.up);
  const double height = camera.orthographic ? camera.height : 2 * glm::length(out) * std::tan(0.5 * camera.fov);
  camera.look_at += height * (move.pan_right * frame.right + move.pan_up * frame.up);
  camera.position = camera.look_at + out;
  return camera;
}

}  // namespace wale
