#pragma once
#include <cstdint>
#include <vector>

#include "geom/fabric.h"
#include "host/image.h"
#include "host/scene.h"
#include "shared/wale_types.h"

namespace wale {

/// True where the colour of a fabric's plies is not the same everywhere.
bool colors_vary(const PlyAppearance& yarn, const ColorImage& image, const std::vector<Rgb>& yarns);
/// True where they depend on the place along the yarn or on the stitch: the fabric is then knitted with
/// FabricSpec::places.
bool colors_need_places(const PlyAppearance& yarn, const ColorImage& image);

/// A colour in [0,1] as one word of the device: 10 bits a channel, 1 and 0 exact; see W_COLOR_GIVEN.
uint32_t pack_ply_color(const Rgb& color);
/// What the device reads out of it; zeros where none is given.
Rgb unpack_ply_color(uint32_t word);

/// What yarns of the tile are coloured by PatternCurve::yarn: the scene's palette, else the tile's; empty: the
/// material's.
std::vector<Rgb> yarn_colors(const FabricScene& fabric, const Pattern& pattern);

/// The word of each of a fabric's vertices (Fabric::anchors): the colour of the segment that starts there. The stitch's
/// colour from the image goes before stripes and plies, these before `yarns` (yarn_colors()), these before the
/// material's colour; heather changes any of
/// them. Colours become fibre colours through ThickLayer, or stay as they are where they tint body colours. `pixels` is
/// the image's content, unused without one. Throws a user error on pixels outside [0,1].
std::vector<uint32_t> bake_ply_colors(const Fabric& fabric, const PlyAppearance& yarn, const ColorImage& image,
                                      const Image& pixels, const std::vector<Rgb>& yarns = {});

/// Colour times a factor of mean 1 with the given hash in [-1,1] and relative spread; the spread is less where a
/// channel would pass 1, so that white stays white.
Rgb heathered(const Rgb& color, double hash, double spread);

}  // namespace wale
