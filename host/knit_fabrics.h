#pragma once
#include <functional>
#include <string>
#include <vector>

#include "host/world.h"

namespace wale {

struct KnittedFabric {
  Fabric fabric;
  MeshReport mesh_report;
  std::vector<Rgb> yarn_colors;    ///< as yarn_colors() says
  std::vector<std::string> notes;  ///< what was mended or chosen, one line each
};

/// Loads the base meshes of a scene one after the other and knits its fabrics at the same time. Calls progress(share
/// done) from several threads, one at a time. Throws the user error of the first fabric, in the scene's order, that has
/// one.
std::vector<KnittedFabric> knit_fabrics(const Scene& scene, const Loaders& loaders,
                                        const std::function<void(double)>& progress);

}  // namespace wale
