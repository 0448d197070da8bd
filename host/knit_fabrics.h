#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "host/world.h"

namespace wale {

struct KnittedFabric {
  Fabric fabric;
  MeshReport mesh_report;
  Knitting knitting;
  std::vector<Rgb> yarn_colors;         ///< as yarn_colors() says
  std::optional<size_t> of_previous{};  ///< fabric of the world before that would be the same; nothing was knitted
  /// Where the mesh is now, its triangles those of the mesh as it was read; empty: nothing moved it.
  BaseMesh moved{};
  std::vector<std::string> frame_notes{};  ///< of the frame, not of the knitting
};

/// Loads the base meshes of a scene one after the other and knits its fabrics at the same time, but for those that
/// `previous` has already. Calls progress(share done) from several threads, one at a time. Throws the user error of the
/// first fabric, in the scene's order, that has one.
std::vector<KnittedFabric> knit_fabrics(const Scene& scene, const Loaders& loaders,
                                        const std::function<void(double)>& progress, const World* previous = nullptr);

/// Throws a user error where knit_fabrics() would knit a fabric of more than `most` segments. Knits nothing.
void refuse_more_segments(const Scene& scene, const Loaders& loaders, const World* previous, double most);

/// Puts the mesh of a knitted fabric where `moved` is, which has the same triangles as the mesh that it was knitted on.
void follow_mesh(Fabric& fabric, const BaseMesh& moved);

}  // namespace wale
