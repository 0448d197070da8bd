// A cloth held as a lattice: stored or procedural it is the same picture, and takes the memory that was foreseen.
#include <gtest/gtest.h>

#include <map>

#include "host/memory_needs.h"
#include "host/scene_device.h"
#include "host/world.h"
#include "shared/wale_types.h"
#include "tests/image/picture.h"
#include "tests/tolerances.h"

namespace wale::test {
namespace {

// A sleeve and a curtain of three plies and two.
Scene cloths(Storage storage) {
  Scene scene = empty_scene(0.03, 24);
  MaterialSpec material;
  material.name = "yarn";
  material.ply = true;
  material.yarn.preset = "wool";
  scene.materials.push_back(material);
  for (const bool tube : {true, false}) {
    FabricScene fabric;
    fabric.spec.name = tube ? "sleeve" : "curtain";
    fabric.spec.scale.kind = FabricScale::Kind::uv_metres;
    fabric.spec.plies = tube ? 3 : 2;
    fabric.spec.storage = storage;
    fabric.spec.lattice = tube ? 2 : 1;
    fabric.mesh.generator = tube ? "tube" : "swatch";
    fabric.mesh.radius = 0.008;
    fabric.mesh.width = fabric.mesh.height = 0.02;
    fabric.mesh.nu = 24;
    fabric.mesh.nv = 4;
    fabric.pattern.builtin = "stockinette";
    scene.fabrics.push_back(fabric);
  }
  scene.lights.push_back(constant_environment(1));
  return scene;
}

TEST(Storage, ProceduralClothIsTheSamePicture) {
  const Picture stored = take(cloths(Storage::stored), 16), procedural = take(cloths(Storage::procedural), 16);
  EXPECT_GT(stored.counts.bounce, stored.counts.primary / 4) << "the cloth was not hit";
  EXPECT_EQ(stored.counts.bounce, procedural.counts.bounce);
  EXPECT_EQ(stored.image.pixels, procedural.image.pixels);
  EXPECT_EQ(bad_events(procedural.counts), 0u);
}

TEST(Storage, MemoryIsAsForeseen) {
  for (const Storage storage : {Storage::stored, Storage::procedural}) {
    const World world = build_world(cloths(storage), {});
    EXPECT_EQ(world.fabrics[0].procedural, storage == Storage::procedural);
    const FabricDevice fabric = upload_fabrics(device(), fabric_inputs(world), world.origin);
    EXPECT_EQ(fabric.tight_joints, 0u);
    std::map<std::string, uint64_t> needs;
    for (const MemoryNeed& need : memory_needs(world, Features{}, 64, device().traits())) needs[need.name] = need.bytes;
    EXPECT_EQ(needs["lattices"], fabric.lattice.lattice.bytes());
    // The nodes of a small tree are less full than those that the estimate is made for.
    EXPECT_GE(needs["ply tree"] * 2 + W_NODE_WORDS * 4, fabric.tree.nodes.bytes());
    if (storage == Storage::procedural) {
      EXPECT_EQ(needs["ply vertices"], 0u);
      EXPECT_EQ(needs["ply leaves"], 0u);
    } else {
      EXPECT_EQ(needs["ply vertices"], fabric.frames.bytes());
      const double leaves = double(fabric.tree.leaves.bytes());
      EXPECT_NEAR(double(needs["ply leaves"]), leaves, tolerance::kLeafBytes * leaves);
    }
  }
}

}  // namespace
}  // namespace wale::test
