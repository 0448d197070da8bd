#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "host/device.h"
#include "host/film.h"

namespace wale {

/// Pixels of a tile, 8 x 8 (W_TILE of kernels/stages/path_state.clh).
constexpr uint32_t kTilePixels = 64;

/// Pixels of a picture when they are numbered along its 8 x 8 tiles, those outside the picture counted too.
uint64_t padded_pixels(int width, int height);

/// Sums of a run of pixels on their way between devices and to the picture; same layout as FilmDevice's.
struct PixelSums {
  std::vector<w_float4> radiance;  ///< kScrambles a pixel: rgb and count
  std::vector<w_float4> aov;       ///< 4 a pixel, or empty
  std::vector<uint32_t> ply;       ///< 1 a pixel, or empty
};

/// Sums of all pixels on one device, in the order of their numbers (tiles), so that a run of them is one piece of
/// memory. Bands of pixels have buffers of their own where one buffer may not hold them all.
class FilmDevice {
 public:
  /// Everything starts at zero. Throws a user error when there are more pixels than numbers for them.
  FilmDevice(const Device& device, int width, int height, bool aovs);

  /// Everything is zero again.
  void clear(const Device& device);

  /// Part of a run of pixels that lies in one band.
  struct Piece {
    size_t band;
    uint32_t in_band, in_run, count;  ///< first pixel, counted from the band's and from the run's start; pixels
  };
  std::vector<Piece> pieces(uint32_t first, uint32_t count) const;
  /// Bands that hold pixels of these tiles, each once.
  std::vector<size_t> bands_of(const std::vector<uint32_t>& tiles) const;
  /// First pixel of a band and how many it holds at most.
  std::pair<uint32_t, uint32_t> pixels_of(size_t band) const { return {uint32_t(band) * band_pixels_, band_pixels_}; }
  const cl::Buffer& radiance(size_t band) const { return bands_[band].radiance.cl(); }
  const cl::Buffer& aov(size_t band) const { return bands_[band].aov.cl(); }
  const cl::Buffer& ply(size_t band) const { return bands_[band].ply.cl(); }
  uint64_t bytes() const;

  /// Both wait. They have a queue of their own: another device's thread may read here while this device traces other
  /// pixels.
  PixelSums read(uint32_t first, uint32_t count) const;
  void write(uint32_t first, const PixelSums& sums);

 private:
  struct Band {
    Buffer<w_float4> radiance, aov;
    Buffer<uint32_t> ply;
  };
  uint32_t band_pixels_ = 0;
  bool aovs_;
  std::vector<Band> bands_;
  cl::CommandQueue transfers_;
};

/// Puts the sums of pixels [first, ...) into the picture's rows.
void scatter(const PixelSums& sums, uint32_t first, FilmSums& film);

}  // namespace wale
