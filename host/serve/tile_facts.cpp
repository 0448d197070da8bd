#include "host/serve/tile_facts.h"

#include <map>
#include <mutex>

#include "host/ply_colors.h"
#include "host/world.h"

namespace wale {

TileFacts tile_facts(const FabricScene& fabric) {
  static std::mutex mutex;
  static std::map<std::string, TileFacts> known;
  const std::lock_guard lock(mutex);
  const std::string key = fabric.pattern.file.string() + "|" + fabric.pattern.builtin;
  auto found = known.find(key);
  if (found == known.end()) {
    const Pattern tile = load_pattern(fabric.pattern);
    FabricScene plain = fabric;
    plain.palette.reset();
    found =
        known.emplace(key, TileFacts{tile.period, glm::max(tile.stitches, ivec2(1)), yarn_colors(plain, tile)}).first;
  }
  TileFacts facts = found->second;
  if (fabric.palette) facts.palette = *fabric.palette;
  return facts;
}

}  // namespace wale
