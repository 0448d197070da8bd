#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/film_device.h"
#include "host/tile_error.h"
#include "host/work_list.h"

namespace wale {

/// The film of a render, of which every device holds the blocks that it traced last. To be read while nobody traces.
class SharedFilm {
 public:
  /// `films`: of the devices, in the order of the list's; `pixels`: of the picture in whole tiles.
  SharedFilm(std::vector<const FilmDevice*> films, const WorkList& list, uint32_t pixels, uint32_t block_pixels);

  uint32_t tiles() const { return pixels_ / kTilePixels; }

  /// A number of each of these tiles, ascending, from its sums (kScrambles a pixel); of a tile without samples, from
  /// zeros.
  std::vector<double> measure(std::span<const uint32_t> tiles,
                              const std::function<double(std::span<const w_float4>)>& of) const;

  /// Noise and samples of all tiles; `floor` as error_floor() gave it, or 0: from what the tiles hold now.
  Reached reached(double goal, double floor) const;

  /// The whole film in the picture's rows.
  FilmSums gather(int width, int height, bool aovs) const;

 private:
  uint32_t block_of(uint32_t tile) const { return tile / (block_pixels_ / kTilePixels); }
  /// End of the run of tiles that lie one behind the other on one device, from entry i of the list on.
  size_t run_end(std::span<const uint32_t> tiles, size_t i) const;
  /// Calls use(first tile, sums) for every such run that holds samples.
  void for_runs(std::span<const uint32_t> tiles, const std::function<void(size_t, const PixelSums&)>& use) const;
  std::vector<uint32_t> all() const;

  std::vector<const FilmDevice*> films_;
  const WorkList& list_;
  uint32_t pixels_, block_pixels_;
};

}  // namespace wale
