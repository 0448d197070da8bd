#pragma once
#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// Orthonormal right, up and forward of who looks from one point at another; `up` need not be perpendicular.
struct ViewFrame {
  dvec3 right, up, forward;
  ViewFrame(const dvec3& from, const dvec3& to, const dvec3& up_hint);
};

/// The camera where a scene gives none: a portrait lens that sees a sphere (metres) from the front, a little from
/// above.
CameraScene framed_camera(CameraScene camera, const FilmScene& film, const dvec3& centre, double radius);

/// What the kernels read; positions relative to the scene's origin.
WCamera device_camera(const CameraScene& camera, const FilmScene& film, const dvec3& origin);

}  // namespace wale
