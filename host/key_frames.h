#pragma once
#include <string>
#include <vector>

#include "host/json_document.h"

namespace wale {

/// How a value gets from one key to the next: on a straight line; on a monotone cubic (Fritsch and Butland 1984), which
/// starts and ends at rest and never leaves the range between two keys; or not before the next key.
enum class KeyWay { linear, smooth, hold };
const std::vector<std::string>& key_ways();

/// Values of one scene key over time. Numbers, lists of them and colours "#rrggbb" (as light) lie between two keys;
/// words and truths are those of the key before.
class KeyTrack {
 public:
  /// `list` = [[frame, value], [frame, value, "smooth"], ...]. Throws a user error that names the place and `path`.
  KeyTrack(const JsonNode& list, const std::string& path, KeyWay otherwise);
  /// The value at a frame; before the first key and after the last one it is theirs.
  JsonNode at(double frame) const;

 private:
  struct Key {
    double frame;
    JsonNode value;
    KeyWay way;
  };
  std::vector<Key> keys_;
};

}  // namespace wale
