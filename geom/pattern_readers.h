#pragma once
#include <filesystem>
#include <string_view>

#include "geom/pattern.h"

namespace wale {

/// Readers of the single formats, from the bytes of a file and its name; parse_pattern() chooses by suffix, fills in
/// the stitches and checks what comes back.
Pattern parse_pyp(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints);
Pattern parse_leaf(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints);
Pattern parse_bcc(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints);
Pattern parse_pattern_json(std::string_view bytes, const std::filesystem::path& file, const PatternHints& hints);

/// Moves the curves so that z = 0 is the middle of their z range.
void recentre_z(Pattern& pattern);

/// Periods of a tile that does not state them, from the displacements between curve ends (metres). Components of
/// `known` that are not zero are kept. `tolerance`: metres by which partner ends may miss each other. Throws a user
/// error.
dvec2 recover_periods(const Pattern& pattern, dvec2 known, double tolerance, const std::filesystem::path& file);

/// Wales and courses of a tile whose file does not say. Courses: x yarns per tile; wales: loop heads per course
/// (largest over the courses, as a slipped stitch has no head), or yarns in y of a weave; at least 1.
ivec2 estimate_stitches(const Pattern& pattern);

}  // namespace wale
