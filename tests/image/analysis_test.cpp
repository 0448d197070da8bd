// What is dropped because it cannot matter (host/analysis.h): each rule on a scene where it holds, with the picture it
// leaves, and on scenes close by where it must not.
#include <gtest/gtest.h>

#include "geom/base_mesh.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"

namespace wale::test {
namespace {

World world_of(const Scene& scene, bool drop = true) {
  return build_world(scene, Loaders{[](const auto& file) { return read_mesh(file); }, {}}, {}, {.drop = drop});
}

Rendered rendered(const Scene& scene, bool drop, int spp = 16, unsigned seed = 0, bool aovs = false) {
  const World world = world_of(scene, drop);
  const SceneDevice on_device(device(), world);
  IntegratorScene integrator = scene.integrator;
  integrator.seed = seed;
  RenderOptions options;
  options.spp = spp;
  options.aovs = aovs;
  return render(device(), world, on_device, integrator, options);
}

std::string dropped(const Scene& scene) {
  std::string all;
  for (const Dropped& d : world_of(scene).dropped) all += d.what + ": " + d.because + "\n";
  return all;
}

bool drops(const Scene& scene, const std::string& words) { return dropped(scene).find(words) != std::string::npos; }

LightScene quad(const std::string& name, dvec3 position, dvec3 look_at) {
  LightScene light;
  light.name = name;
  light.kind = LightScene::Kind::quad;
  light.position = position;
  light.look_at = look_at;
  light.width = light.height = 0.004;
  light.radiance = {30, 30, 30};
  return light;
}

// Two rows of yarn under a lamp; the camera looks down at them from 6 cm.
Scene cloth() {
  Scene scene = empty_scene(0.006, 16);
  add_fabric(scene, straight_yarn(0.002, 0.0007), 0.006, 0.004, 2, "wool", Rgb{0.8, 0.5, 0.3});
  scene.lights.push_back(quad("lamp", dvec3(0.01, 0.01, 0.02), dvec3(0)));
  return scene;
}

// A lamp behind the camera that shines away from everything.
Scene with_lamp_that_shines_away() {
  Scene scene = cloth();
  scene.lights.push_back(quad("away", dvec3(0, 0, 0.09), dvec3(0, 0, 1)));
  return scene;
}

const std::string kOneWay = "light \"away\" (quad): it shines one way only";

TEST(ShinesAway, DropsTheLampAndKeepsThePicture) {
  const Scene scene = with_lamp_that_shines_away();
  EXPECT_TRUE(drops(scene, kOneWay)) << dropped(scene);
  EXPECT_FALSE(drops(scene, "\"lamp\"")) << dropped(scene);
  // As if it were black, bit by bit: nothing of it is seen, its shape stays.
  Scene black = scene;
  black.lights[1].radiance = {0, 0, 0};
  const Image image = rendered(scene, true).image;
  EXPECT_EQ(different_pixels(image, rendered(black, true).image), 0u);
  // Half of the light samples no longer go to it: other noise, the same mean.
  size_t tests = 0;
  const double p = smallest_p(rendered(scene, true, 512, 1).image, rendered(scene, false, 512, 2).image, tests);
  EXPECT_GT(p, sidak(1e-3, tests));
  EXPECT_GT(mean_rgb(image)[0], 0.01);
}

TEST(ShinesAway, KeepsLampsThatMayBeSeen) {
  const auto changed = [](const auto& change) {
    Scene scene = with_lamp_that_shines_away();
    change(scene);
    return scene;
  };
  EXPECT_FALSE(drops(changed([](Scene& s) { s.lights[1].two_sided = true; }), "away"));
  EXPECT_FALSE(drops(changed([](Scene& s) { s.lights[1].look_at = dvec3(0); }), "away")) << "it shines at the cloth";
  EXPECT_FALSE(drops(changed([](Scene& s) { s.lights[1].position.z = 0.03; }), "away")) << "the camera sees it";
  EXPECT_FALSE(drops(changed([](Scene& s) {
                       ObjectScene ball;
                       ball.kind = ObjectScene::Kind::sphere;
                       ball.center = dvec3(1, 0, 0);
                       ball.radius = 0.0901;
                       ball.material = int(s.materials.size());
                       s.materials.push_back({});
                       s.objects.push_back(ball);
                     }),
                     "away"))
      << "a ball reaches in front of it";
  // Upright beside the cloth: its plane just misses, or just meets, the nearest ply.
  const double edge = 0.003 + 0.001 + 0.0007;  // half the cloth, half a stitch past its border, a ply
  for (const double x : {edge - 0.0006, 2 * edge})
    EXPECT_EQ(drops(changed([&](Scene& s) {
                      s.lights[1] = quad("away", dvec3(x, 0, 0), dvec3(1, 0, 0));
                      s.lights[1].up = dvec3(0, 0, 1);
                    }),
                    "away"),
              x > edge)
        << x;
}

TEST(BlackLight, IsNotSampledAndStillCastsItsShadow) {
  Scene scene = empty_scene(0.006, 16);
  ObjectScene ground;
  ground.kind = ObjectScene::Kind::ground;
  ground.up = dvec3(0, 0, 1);
  ground.material = 0;
  scene.materials.push_back({});
  scene.objects.push_back(ground);
  scene.lights.push_back(constant_environment(1));
  const double bare = mean_rgb(rendered(scene, true, 64).image)[0];
  scene.lights.push_back(quad("off", dvec3(0, 0, 0.005), dvec3(0)));
  scene.lights[1].width = scene.lights[1].height = 0.02;
  scene.camera.position.z = 0.004;
  scene.lights[1].radiance = {0, 0, 0};
  EXPECT_TRUE(drops(scene, "light \"off\" (quad): it is black")) << dropped(scene);
  const double off = mean_rgb(rendered(scene, true, 64).image)[0];
  scene.lights[1].radiance = {1e-6, 1e-6, 1e-6};
  EXPECT_LT(off, 0.5 * bare);
  EXPECT_NEAR(off, mean_rgb(rendered(scene, true, 64).image)[0], 0.05 * bare);
}

TEST(Enclosed, DropsALampInABallUnlessTheCameraOrClothIsInsideToo) {
  Scene scene = cloth();
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.center = dvec3(0.05, 0, 0);
  ball.radius = 0.01;
  ball.material = int(scene.materials.size());
  scene.materials.push_back({});
  scene.objects.push_back(ball);
  LightScene bulb;
  bulb.name = "bulb";
  bulb.kind = LightScene::Kind::sphere;
  bulb.position = dvec3(0.051, 0, 0);
  bulb.radius = 0.002;
  bulb.radiance = {50, 50, 50};
  scene.lights.push_back(bulb);
  EXPECT_TRUE(drops(scene, "light \"bulb\" (sphere): an opaque sphere encloses it")) << dropped(scene);
  Scene black = scene;
  black.lights[1].radiance = {0, 0, 0};
  EXPECT_EQ(different_pixels(rendered(scene, true).image, rendered(black, true).image), 0u);
  const auto changed = [&](const auto& change) {
    Scene other = scene;
    change(other);
    return other;
  };
  EXPECT_FALSE(drops(changed([](Scene& s) { s.lights[1].radius = 0.0095; }), "bulb")) << "it sticks out";
  EXPECT_FALSE(drops(changed([](Scene& s) { s.objects[0].radius = 0.06; }), "bulb")) << "so is the cloth";
  EXPECT_FALSE(drops(changed([](Scene& s) { s.camera.position.x = 0.05, s.camera.position.z = 0; }), "bulb"));
}

const std::string kMaps = "fibre maps of \"fabric\": a pixel covers at least";

TEST(BelowPixels, DropsMapsThatTheFilterTakesAwayAndKeepsEveryBit) {
  Scene scene = cloth();
  scene.camera.height = 0.02;  // a fibre of wool in a ply of 0.35 mm is 0.09 mm thick at most
  scene.film.width = scene.film.height = 24;
  EXPECT_TRUE(drops(scene, kMaps)) << dropped(scene);
  const World world = world_of(scene);
  EXPECT_TRUE(world.fibres.candidates.empty());
  EXPECT_FALSE(world_of(scene, false).fibres.candidates.empty());
  EXPECT_EQ(different_pixels(rendered(scene, true).image, rendered(scene, false).image), 0u);
}

// The camera goes nearer until the rule stops; from there on the maps change the picture.
TEST(BelowPixels, KeepsMapsThatSomePixelMayResolve) {
  Scene scene = cloth();
  scene.camera.orthographic = false;
  scene.camera.fov = 0.4;
  scene.film.width = scene.film.height = 24;
  bool before = true;
  size_t changes = 0;
  double nearest = 1;  // where they are dropped
  for (double distance = 0.06; distance > 0.002; distance *= 0.8) {
    scene.camera.position = dvec3(0, 0, distance);
    const bool now = drops(scene, kMaps);
    changes += now != before;
    EXPECT_LE(now, before) << distance;
    before = now;
    if (now) {
      nearest = distance;
      continue;
    }
    // A lens may see from nearer than its middle.
    scene.camera.aperture = 0.001;
    EXPECT_FALSE(drops(scene, kMaps));
    scene.camera.aperture = 0;
  }
  EXPECT_EQ(changes, 1u);
  scene.camera.position.z = nearest;
  EXPECT_EQ(different_pixels(rendered(scene, true, 64).image, rendered(scene, false, 64).image), 0u) << nearest;
  scene.camera.position.z = 0.6 * nearest;
  Scene none = scene;
  none.fabrics[0].spec.detail = Detail::none;
  EXPECT_GT(different_pixels(rendered(scene, true).image, rendered(none, true).image), 20u) << "maps show here";
  scene.camera.position.z = 1;
  EXPECT_TRUE(drops(scene, kMaps));
  scene.fabrics[0].spec.detail = Detail::paper;
  EXPECT_FALSE(drops(scene, kMaps)) << "KNIT21's maps are not filtered";
}

TEST(Opaque, PliesLetNothingThroughWhereNoRayWouldPass) {
  Scene scene = cloth();
  scene.lights.push_back(constant_environment(1));
  scene.materials[0].yarn.optical_radius = 3000;
  EXPECT_TRUE(drops(scene, "light through plies of \"fabric\"")) << dropped(scene);
  EXPECT_EQ(different_pixels(rendered(scene, true).image, rendered(scene, false).image), 0u);
  scene.materials[0].yarn.optical_radius = 2000;
  EXPECT_FALSE(drops(scene, "light through plies"));
  scene.materials[0].yarn.optical_radius = 3;
  const Image some = rendered(scene, true).image;
  scene.materials[0].yarn.optical_radius = 3000;
  EXPECT_GT(different_pixels(some, rendered(scene, true).image), 20u) << "here light passes";
}

TEST(FirstHits, NothingShinesSoThatPathsEndThere) {
  Scene scene = cloth();
  scene.lights[0].radiance = {0, 0, 0};
  EXPECT_TRUE(drops(scene, "paths after the first hit: nothing that shines can be seen")) << dropped(scene);
  const Rendered dark = rendered(scene, true, 8, 0, true), full = rendered(scene, false, 8, 0, true);
  EXPECT_EQ(different_pixels(dark.image, full.image), 0u) << "features of the first hit are there";
  EXPECT_EQ(dark.counts.bounce, 0u);
  EXPECT_GT(full.counts.bounce, 100u);
  scene.lights[0].radiance = {1e-3, 0, 0};
  EXPECT_FALSE(drops(scene, "paths after"));
}

TEST(FirstHits, NothingScatters) {
  Scene scene = empty_scene(0.006, 16);
  MaterialSpec black;
  black.surface.color = {0, 0, 0};
  scene.materials.push_back(black);
  ObjectScene ball;
  ball.kind = ObjectScene::Kind::sphere;
  ball.radius = 0.002;
  ball.material = 0;
  scene.objects.push_back(ball);
  scene.lights.push_back(constant_environment(1));
  EXPECT_TRUE(drops(scene, "paths after the first hit: nothing scatters")) << dropped(scene);
  EXPECT_EQ(different_pixels(rendered(scene, true).image, rendered(scene, false).image), 0u);
  scene.materials[0].surface.coated = true;
  EXPECT_FALSE(drops(scene, "paths after")) << "its coat reflects";
  scene.materials[0].surface.coated = false;
  scene.materials[0].surface.color = {0, 0, 1e-3};
  EXPECT_FALSE(drops(scene, "paths after"));
}

}  // namespace
}  // namespace wale::test
