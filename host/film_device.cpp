#include "host/film_device.h"

#include <algorithm>
#include <optional>

#include "geom/error.h"

namespace wale {
namespace {

constexpr uint32_t kTile = 8;
static_assert(kTile * kTile == kTilePixels);
constexpr size_t kFeatures = 4;  // vectors of accumulate_aov

uint64_t tiles(int n) { return (uint64_t(n) + kTile - 1) / kTile; }

// Place in the picture's rows of a pixel by its number; none outside of the picture.
std::optional<size_t> row_pixel(const FilmSums& film, uint32_t number) {
  const uint32_t columns = uint32_t(tiles(film.width)), tile = number / kTilePixels, inside = number % kTilePixels;
  const uint32_t x = tile % columns * kTile + inside % kTile, y = tile / columns * kTile + inside / kTile;
  if (x >= uint32_t(film.width) || y >= uint32_t(film.height)) return {};
  return size_t(y) * size_t(film.width) + x;
}

}  // namespace

uint64_t padded_pixels(int width, int height) { return tiles(width) * tiles(height) * kTile * kTile; }

FilmDevice::FilmDevice(const Device& device, int width, int height, bool aovs)
    : aovs_(aovs), transfers_(device.context(), device.id()) {
  const uint64_t pixels = padded_pixels(width, height);
  if (pixels > 0xffffffffu)
    user_error("film.size: {} x {} pixels are more than 2^32 in whole tiles of 8 x 8; valid: up to 65528 x 65536",
               width, height);
  const uint64_t most = device.traits().max_alloc_bytes / (kScrambles * sizeof(w_float4)) / 64 * 64;
  band_pixels_ = uint32_t(std::min(pixels, std::max<uint64_t>(64, most)));
  for (uint64_t first = 0; first < pixels; first += band_pixels_) {
    const size_t count = size_t(std::min<uint64_t>(band_pixels_, pixels - first));
    Band& band = bands_.emplace_back();
    band.radiance = Buffer<w_float4>(device, count * kScrambles);
    band.aov = Buffer<w_float4>(device, aovs ? count * kFeatures : 0);
    band.ply = Buffer<uint32_t>(device, aovs ? count : 0);
  }
  clear(device);
}

void FilmDevice::clear(const Device& device) {
  for (Band& band : bands_) {
    band.radiance.fill(device, w_float4{0, 0, 0, 0});
    band.aov.fill(device, w_float4{0, 0, 0, 0});
    band.ply.fill(device, W_NONE);
  }
  device.queue().finish();
}

std::vector<FilmDevice::Piece> FilmDevice::pieces(uint32_t first, uint32_t count) const {
  std::vector<Piece> out;
  for (uint32_t done = 0; done < count;) {
    const uint32_t at = first + done, in_band = at % band_pixels_;
    const uint32_t here = std::min(count - done, band_pixels_ - in_band);
    out.push_back({at / band_pixels_, in_band, done, here});
    done += here;
  }
  return out;
}

std::vector<size_t> FilmDevice::bands_of(const std::vector<uint32_t>& tiles) const {
  std::vector<bool> used(bands_.size());
  for (const uint32_t tile : tiles) used[tile / (band_pixels_ / kTilePixels)] = true;
  std::vector<size_t> bands;
  for (size_t band = 0; band < used.size(); ++band)
    if (used[band]) bands.push_back(band);
  return bands;
}

uint64_t FilmDevice::bytes() const {
  uint64_t sum = 0;
  for (const Band& band : bands_) sum += band.radiance.bytes() + band.aov.bytes() + band.ply.bytes();
  return sum;
}

PixelSums FilmDevice::read(uint32_t first, uint32_t count) const {
  PixelSums sums;
  sums.radiance.resize(count * kScrambles);
  if (aovs_) sums.aov.resize(count * kFeatures), sums.ply.resize(count);
  for (const Piece& p : pieces(first, count)) {
    const auto get = [&](const auto& buffer, auto& to, size_t per_pixel) {
      const size_t item = sizeof(to[0]) * per_pixel;
      transfers_.enqueueReadBuffer(buffer.cl(), CL_TRUE, p.in_band * item, p.count * item,
                                   to.data() + p.in_run * per_pixel);
    };
    get(bands_[p.band].radiance, sums.radiance, kScrambles);
    if (!aovs_) continue;
    get(bands_[p.band].aov, sums.aov, kFeatures);
    get(bands_[p.band].ply, sums.ply, 1);
  }
  return sums;
}

void FilmDevice::write(uint32_t first, const PixelSums& sums) {
  for (const Piece& p : pieces(first, uint32_t(sums.radiance.size() / kScrambles))) {
    const auto put = [&](const auto& buffer, const auto& from, size_t per_pixel) {
      const size_t item = sizeof(from[0]) * per_pixel;
      transfers_.enqueueWriteBuffer(buffer.cl(), CL_TRUE, p.in_band * item, p.count * item,
                                    from.data() + p.in_run * per_pixel);
    };
    put(bands_[p.band].radiance, sums.radiance, kScrambles);
    if (!aovs_) continue;
    put(bands_[p.band].aov, sums.aov, kFeatures);
    put(bands_[p.band].ply, sums.ply, 1);
  }
}

void scatter(const PixelSums& sums, uint32_t first, FilmSums& film) {
  for (size_t i = 0; i < sums.radiance.size() / kScrambles; ++i) {
    const auto pixel = row_pixel(film, first + uint32_t(i));
    if (!pixel) continue;
    std::copy_n(sums.radiance.begin() + std::ptrdiff_t(i * kScrambles), kScrambles,
                film.radiance.begin() + std::ptrdiff_t(*pixel * kScrambles));
    if (sums.aov.empty()) continue;
    std::copy_n(sums.aov.begin() + std::ptrdiff_t(i * kFeatures), kFeatures,
                film.aov.begin() + std::ptrdiff_t(*pixel * kFeatures));
    film.ply[*pixel] = sums.ply[i];
  }
}

}  // namespace wale
