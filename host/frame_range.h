#pragma once
#include <string>
#include <vector>

namespace wale {

/// Frames that "--frames" names: "7", "0..47", "0..47:2". Throws a user error for anything else, and for more than a
/// million frames.
std::vector<long> frame_range(const std::string& text);

}  // namespace wale
