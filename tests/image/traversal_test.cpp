// A device's traversal is no matter of the picture: by vectors or by one ray per work-item, with leaves in one
// buffer or in several, every byte is the same.
#include <gtest/gtest.h>

#include "host/scene_device.h"
#include "tests/image/picture.h"

namespace wale::test {
namespace {

// Plies that let light pass, props and a ball, lit by an environment and by the ball.
Scene scene_with_everything(const std::string& local_stage) {
  Scene scene = empty_scene(0.03, 32);
  MaterialSpec yarn, plain;
  yarn.name = "yarn";
  yarn.ply = true;
  yarn.yarn.preset = "wool";
  plain.name = "plain";
  scene.materials = {yarn, plain};
  FabricScene fabric;
  fabric.spec.name = "sleeve";
  fabric.spec.scale.kind = FabricScale::Kind::uv_metres;
  fabric.mesh.generator = "tube";
  fabric.mesh.radius = 0.008;
  fabric.mesh.height = 0.02;
  fabric.mesh.nu = 24;
  fabric.mesh.nv = 4;
  fabric.pattern.builtin = "stockinette";
  scene.fabrics.push_back(fabric);
  ObjectScene ground;
  ground.kind = ObjectScene::Kind::ground;
  ground.material = 1;
  ground.height = -0.01;
  ground.up = {0, 0, 1};
  scene.objects.push_back(ground);
  scene.lights.push_back(constant_environment(0.5));
  LightScene ball;
  ball.kind = LightScene::Kind::sphere;
  ball.position = {0.012, 0.012, 0.02};
  ball.radius = 0.004;
  ball.radiance = {20, 20, 20};
  scene.lights.push_back(ball);
  scene.integrator.local_stage = local_stage;
  return scene;
}

Device one_ray_per_item() {
  Device device = Device::open();
  device.traits().traversal = Traversal::simt;
  device.traits().lanes = 1;
  return device;
}

TEST(Traversal, ByOneRayPerItemGivesThePictureOfVectors) {
  const Scene scene = scene_with_everything("exact");
  const Picture a = take(scene, 8), b = take_on(one_ray_per_item(), scene, 8);
  EXPECT_GT(a.counts.bounce, a.counts.primary / 2);
  EXPECT_GT(a.counts.shadow, 0u);
  EXPECT_EQ(a.counts.bounce, b.counts.bounce);
  EXPECT_EQ(a.image.pixels, b.image.pixels);
  EXPECT_EQ(bad_events(b.counts), 0u);
}

TEST(Traversal, QuantisesTheTreeOfTheExactStageAlone) {
  const Device device = one_ray_per_item();
  const World world = build_world(scene_with_everything("exact"), {});
  const SceneDevice exact(device, world);
  const SceneDevice cells(device, build_world(scene_with_everything("cell"), {}));
  EXPECT_GT(exact.fabric().tree.quantised.bytes(), 0u);
  EXPECT_EQ(cells.fabric().tree.quantised.bytes(), 0u);
  const Features features = analyse(world, scene_with_everything("exact").integrator, false, device.traits());
  EXPECT_TRUE(features.simt);
  EXPECT_NE(features.options().find("W_SIMT"), std::string::npos);
  EXPECT_FALSE(analyse(world, scene_with_everything("cell").integrator, false, device.traits()).simt);
}

TEST(Traversal, LeavesInSeveralBuffersGiveTheSamePicture) {
  const Scene scene = scene_with_everything("exact");
  Device small = Device::open();
  const Picture whole = take(scene, 8);
  const World world = build_world(scene, {});
  small.traits().max_alloc_bytes = SceneDevice(device(), world).fabric().tree.leaves.bytes() / 3;
  const SceneDevice split(small, world);
  EXPECT_GT(split.fabric().tree.leaves.parts().size(), 1u);
  EXPECT_EQ(whole.image.pixels, take_on(small, scene, 8).image.pixels);
}

}  // namespace
}  // namespace wale::test
