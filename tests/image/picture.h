#pragma once
#include <string>

#include "host/render.h"
#include "host/scene.h"
#include "host/world.h"

namespace wale::test {

/// The one device of the tests; fails the program when there is none.
const Device& device();

/// A scene that is made ready once and rendered often.
class Studio {
 public:
  Studio(const Device& device, const Scene& scene);
  Rendered take(const RenderOptions& options, unsigned seed = 0) const;

 private:
  const Device& device_;
  IntegratorScene integrator_;
  World world_;
  SceneDevice on_device_;
};

/// Builds and renders a scene made in code.
struct Picture {
  Image image;
  WaveCounts counts;
};
Picture take(const Scene& scene, int spp, unsigned seed = 0, uint32_t pool = 0, bool aovs = false);
/// The same on a given device: forced lane widths, other drivers.
Picture take_on(const Device& device, const Scene& scene, int spp, unsigned seed = 0, uint32_t pool = 0,
                bool aovs = false);

/// Rare events that are more than notes (host/rare_events.h), all of them together.
uint64_t bad_events(const WaveCounts& counts);

/// A scene with an orthographic camera that looks down -z at [-size/2, size/2]^2, and no lights.
Scene empty_scene(double size, int pixels);

/// Yarn running straight along x, `pitch` metres apart, radius `radius`: the simplest fabric there is. The rows fill a
/// swatch of width x height metres.
Pattern straight_yarn(double pitch, double radius);

/// Adds a swatch of a pattern written to a temporary file.
void add_fabric(Scene& scene, const Pattern& pattern, double width, double height, int plies, const std::string& preset,
                std::optional<Rgb> color, double twist_pitch = 8);

LightScene constant_environment(double radiance);

/// Two-sided p-value of Student's t with `dof` degrees of freedom.
double student_p(double t, double dof);

/// Smallest p-value over all pixels and channels of the hypothesis "mean = expected", with the variance of each pixel's
/// mean from its eight scrambles (Student's t, 7 degrees of freedom). Pixels without spread must agree to 1e-4 or the
/// result is 0. `tests` counts the hypotheses, for Sidak's correction.
double smallest_p(const Image& image, double expected, size_t& tests);
/// The same of "two pictures have the same mean" (Welch).
double smallest_p(const Image& a, const Image& b, size_t& tests);
/// Of "the means over all pixels are the same", the least of the channels: finds what is too little for any one pixel.
double smallest_p_of_means(const Image& a, const Image& b);

/// Significance per test so that `tests` independent ones together have level `alpha`.
double sidak(double alpha, size_t tests);

/// Mean of R, G, B over the picture.
std::array<double, 3> mean_rgb(const Image& image);

}  // namespace wale::test
