#include "host/viewpoint.h"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

w_float4 vec4(const dvec3& v) { return {float(v.x), float(v.y), float(v.z), 0}; }

}  // namespace

ViewFrame::ViewFrame(const dvec3& from, const dvec3& to, const dvec3& up_hint)
    : right(0), up(0), forward(glm::normalize(to - from)) {
  right = glm::normalize(glm::cross(forward, up_hint));
  up = glm::cross(right, forward);
}

CameraScene framed_camera(CameraScene camera, const FilmScene& film, const dvec3& centre, double radius) {
  camera.look_at = centre;
  // fov is vertical; a picture higher than wide sees less across.
  const double aspect = std::min(1.0, double(film.width) / double(film.height));
  const double half_angle = std::atan(aspect * std::tan(0.5 * camera.fov));
  camera.position = centre + glm::normalize(dvec3(0.25, 0.35, 1)) * (1.05 * radius / std::sin(half_angle));
  camera.up = dvec3(0, 1, 0);
  return camera;
}

WCamera device_camera(const CameraScene& c, const FilmScene& film, const dvec3& origin) {
  const ViewFrame frame(c.position, c.look_at, c.up);
  WCamera out{};
  out.origin = vec4(c.position - origin);
  out.right = vec4(frame.right);
  out.up = vec4(frame.up);
  out.forward = vec4(frame.forward);
  out.width = film.width;
  out.height = film.height;
  out.kind = c.orthographic ? 1 : 0;
  out.half_height = float(c.orthographic ? 0.5 * c.height : std::tan(0.5 * c.fov));
  out.half_width = out.half_height * float(out.width) / float(out.height);
  out.aperture = float(c.aperture);
  out.focus = float(c.focus > 0 ? c.focus : glm::length(c.look_at - c.position));
  out.filter = film.filter == "box" ? 0 : 1;
  return out;
}

}  // namespace wale
