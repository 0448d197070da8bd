#pragma once
#include <string>
#include <vector>

#include "host/fit/photograph.h"
#include "host/stored_image.h"

namespace wale::fit {

// What a photograph is refused for; `name` begins each message, warnings are appended.

/// Options that contradict each other or cannot be, whatever the picture.
void require_consistent(const PhotographOptions& options, const std::string& name);

/// Rectangles and corners within width x height pixels.
void require_places(const PhotographOptions& options, int width, int height, const std::string& name);

/// No transparent pixel where the cloth is.
void require_opaque(const StoredImage& stored, const PhotographOptions& options, const std::string& name);

/// The reference unclipped, and at most kClippedShare of the cloth's pixels; warns of fewer.
constexpr double kClippedShare = 0.01;
void require_unclipped(const StoredImage& stored, const PhotographOptions& options, const std::string& name,
                       std::vector<std::string>& warnings);

/// Not black: a mean above 1e-5 of full scale. Warns below 1e-2 in 8 bits, where sRGB's steps are 6 % and more.
void require_light(const Picture& picture, int integer_bits, const std::string& name,
                   std::vector<std::string>& warnings);

/// Warns where a picture is to have more pixels than the photograph shows.
void warn_of_size(const PhotographOptions& options, int width, int height, const std::string& name,
                  std::vector<std::string>& warnings);

}  // namespace wale::fit
