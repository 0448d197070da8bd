// A version of a scene whose memory cannot be had: the version before stays, cloth that would have moved included.
#include <dlfcn.h>

#include <atomic>
#include <climits>

#include "geom/base_mesh_generators.h"
#include "host/live_scene.h"
#include "tests/geom/sequence_fixtures.h"
#include "tests/image/picture.h"
#include "tests/image/program.h"
#include "tests/temporary_folder.h"

namespace {

std::atomic<int> made_buffers{0}, most_buffers{INT_MAX};

}  // namespace

// Stands before the OpenCL loader's function of that name.
extern "C" cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* error) {
  using Function = decltype(&clCreateBuffer);
  static const Function real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clCreateBuffer"));
  if (++made_buffers <= most_buffers) return real(context, flags, size, host, error);
  if (error) *error = CL_MEM_OBJECT_ALLOCATION_FAILURE;
  return nullptr;
}

namespace wale::test {
namespace {

TEST(FailingAllocation, LeavesTheClothWhereItWas) {
  TemporaryFolder folder;
  std::vector<BaseMesh> meshes(2, make_swatch(0.06, 0.06, 8, 8));
  for (dvec3& p : meshes[1].position) p += dvec3(0.01, 0, 0.02);
  folder.write("c.bin", bin_file(meshes));
  const auto file = folder.write("scene.json", R"({"wale": 1, "film": {"size": [24, 24]},
 "camera": {"position": [0, 0, 0.2], "fov": 20}, "fabrics": [{"mesh": {"frames": "c.bin"},
 "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 25}}]})");
  const auto at = [&](int frame) { return read_scene(file, {fmt::format("animation.frame={}", frame)}); };
  const Loaders loaders{[](const auto& f) { return read_mesh(f); }, {}, {}};
  LiveScene live(std::span(&device(), 1), loaders, {});
  const auto picture = [&] {
    RenderOptions options;
    options.spp = 8;
    return render(live.devices(), live.world(), live.scene().integrator, options).image;
  };
  live.apply(at(0));
  const Image before = picture();
  const int first = made_buffers;
  EXPECT_TRUE(live.apply(at(1)).moved);
  const int taken = made_buffers - first;
  ASSERT_GT(taken, 1);
  const Image after = picture();
  EXPECT_GT(different_pixels(before, after), 100u);
  live.apply(at(0));
  for (const int allowed : {0, taken / 2, taken - 1}) {
    most_buffers = made_buffers + allowed;
    EXPECT_ANY_THROW(live.apply(at(1))) << allowed;
    most_buffers = INT_MAX;
    EXPECT_EQ(different_pixels(picture(), before), 0u) << allowed;
  }
  EXPECT_FALSE(live.apply(at(1)).fabrics) << "they need not be uploaded again";
  EXPECT_EQ(different_pixels(picture(), after), 0u);
}

}  // namespace
}  // namespace wale::test
