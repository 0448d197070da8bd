#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/ply_reach.h"
#include "host/world.h"

namespace wale {

/// The rules by which an effect that a scene has is left out because it cannot matter. Each says why, in words, or
/// nothing where it may matter. What they drop is data, never code: no change of a colour, a light or the camera makes
/// another program. They look at a world before drop_what_cannot_matter().
/// `reach`: ply_reach() of every fabric.

/// A light that is black.
std::optional<std::string> is_black(const World& world, size_t light);
/// A one-sided light in whose front half space there is nothing that scatters, nor the camera.
std::optional<std::string> shines_away(const World& world, size_t light, const std::vector<PlyReach>& reach);
/// A light inside an opaque ball that no cloth reaches into and the camera stands outside of.
std::optional<std::string> is_enclosed(const World& world, size_t light, const std::vector<PlyReach>& reach);

/// Maps of fibres of which a pixel covers so many everywhere that the kernels' filter takes all of them away.
std::optional<std::string> is_below_pixels(const World& world, size_t fabric, const PlyReach& reach);

/// Plies through which passes less than one ray in 2^24, the steps of the random number that decides.
std::optional<std::string> is_opaque(const WPlyMaterial& material);

/// Paths that gather nothing after their first hit: nothing shines, or nothing scatters.
std::optional<std::string> ends_at_first_hit(const World& world);

/// Applies all of them and notes in world.dropped what was left out.
void drop_what_cannot_matter(World& world);

}  // namespace wale
