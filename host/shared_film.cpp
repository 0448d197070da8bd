#include "host/shared_film.h"

#include <algorithm>
#include <numeric>

namespace wale {
namespace {

constexpr size_t kReadTiles = 1024;  // of the film at once: 8 MB
constexpr size_t kTileSums = kTilePixels * kScrambles;

}  // namespace

SharedFilm::SharedFilm(std::vector<const FilmDevice*> films, const WorkList& list, uint32_t pixels,
                       uint32_t block_pixels)
    : films_(std::move(films)), list_(list), pixels_(pixels), block_pixels_(block_pixels) {}

std::vector<uint32_t> SharedFilm::all() const {
  std::vector<uint32_t> numbers(tiles());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

size_t SharedFilm::run_end(std::span<const uint32_t> tiles, size_t i) const {
  const auto owner = list_.owner(block_of(tiles[i]));
  size_t end = i + 1;
  while (end < std::min(tiles.size(), i + kReadTiles) && tiles[end] == tiles[end - 1] + 1 &&
         list_.owner(block_of(tiles[end])) == owner)
    ++end;
  return end;
}

void SharedFilm::for_runs(std::span<const uint32_t> tiles,
                          const std::function<void(size_t, const PixelSums&)>& use) const {
  for (size_t i = 0; i < tiles.size();) {
    const size_t end = run_end(tiles, i);
    if (const auto owner = list_.owner(block_of(tiles[i])))
      use(i, films_[*owner]->read(tiles[i] * kTilePixels, uint32_t(end - i) * kTilePixels));
    i = end;
  }
}

std::vector<double> SharedFilm::measure(std::span<const uint32_t> tiles,
                                        const std::function<double(std::span<const w_float4>)>& of) const {
  const std::vector<w_float4> none(kTileSums, w_float4{0, 0, 0, 0});
  std::vector<double> values(tiles.size(), of(none));
  for_runs(tiles, [&](size_t first, const PixelSums& sums) {
    for (size_t k = 0; k * kTileSums < sums.radiance.size(); ++k)
      values[first + k] = of(std::span(sums.radiance).subspan(k * kTileSums, kTileSums));
  });
  return values;
}

Reached SharedFilm::reached(double goal, double floor) const {
  const std::vector<uint32_t> numbers = all();
  if (floor == 0) floor = error_floor(measure(numbers, tile_luminance));
  std::vector<uint32_t> samples(numbers.size());
  for (const uint32_t t : numbers) samples[t] = list_.samples(block_of(t));
  return wale::reached(measure(numbers, [&](auto sums) { return tile_error(sums, floor); }), samples, goal, floor);
}

FilmSums SharedFilm::gather(int width, int height, bool aovs) const {
  const size_t pixels = size_t(width) * size_t(height);
  FilmSums film{width, height, std::vector<w_float4>(pixels * kScrambles, w_float4{0, 0, 0, 0}), {}, {}};
  if (aovs) {
    film.aov.assign(pixels * 4, w_float4{0, 0, 0, 0});
    film.ply.assign(pixels, W_NONE);
  }
  const std::vector<uint32_t> numbers = all();
  for_runs(numbers, [&](size_t first, const PixelSums& sums) { scatter(sums, uint32_t(first) * kTilePixels, film); });
  return film;
}

}  // namespace wale
