#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/fit/homography.h"
#include "host/fit/picture.h"
#include "host/fit/resample.h"

namespace wale::fit {

/// How the numbers of a file follow from light.
enum class Transfer { srgb, linear };

/// What is known of a photograph. All places are pixels of the file.
struct PhotographOptions {
  std::optional<Transfer> transfer{};            ///< not given: what the file says; EXR, HDR and PFM are linear
  std::optional<Rectangle> grey{};               ///< a reference of known reflectance, lit as the cloth is
  double grey_reflectance = 0.18;                ///< of it; the usual photographer's card has 0.18
  std::optional<std::array<double, 3>> gains{};  ///< instead of a reference: factors on linear R, G, B
  double exposure = 1;                           ///< time times ISO over f-number squared, in any unit
  std::optional<double> clip_level{};            ///< stored value from which a pixel is clipped; integers: 1
  std::optional<Rectangle> crop{};               ///< the part with the cloth, or
  std::optional<Corners> corners{};              ///< a rectangle of the cloth, to be seen straight on
  std::optional<ivec2> size{};                   ///< of the picture then; not given: about the photograph's resolution
};

/// Linear light, where 1 is what a white Lambertian surface in the cloth's place would give.
struct Photograph {
  Picture picture;
  std::array<double, 3> gains{1, 1, 1};  ///< from linear value over exposure to the picture
  std::vector<std::string> warnings;     ///< one line each
};

/// Reads one photograph: linear light, gains and exposure, then crop or corners. Throws one-line user errors: not an
/// image, options that contradict each other or lie outside of it, more than 1 % of the pixels clipped, black, not
/// finite, transparent. Clipped pixels below that share, an uneven reference, few pixels, more asked for
/// than there are, and a dark picture in 8 bits are warnings.
Photograph read_photograph(const std::filesystem::path& file, const PhotographOptions& options);

/// Two photographs of one cloth from one place.
struct PhotographPair {
  PicturePair pictures;
  std::vector<std::string> warnings;
};
struct PairOptions {
  PhotographOptions front;
  PhotographOptions back;  ///< without grey and gains: the front's gains, by the two exposures
};

/// Reads both. The reference belongs to the front: a card does not let light through. Throws what read_photograph()
/// throws, and when the sizes differ, both are the same picture, or the back gives no light (under 1e-4 of the
/// front's).
PhotographPair read_pair(const std::filesystem::path& front, const std::filesystem::path& back,
                         const PairOptions& options);

}  // namespace wale::fit
