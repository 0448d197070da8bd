#include "geom/frame_store.h"
#include "geom/mesh_sequence.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/meshes.h"
#include "tests/fuzz/targets.h"

namespace wale::fuzz {
namespace {

// Every frame that there is, and one between two.
void read_all(std::unique_ptr<FrameStore> store, double frames_per_number) {
  SequenceSource source;
  source.frames = "fuzz";
  source.changing = true;
  const std::vector<long> numbers = store->numbers();
  const MeshSequence sequence(source, std::move(store), frames_per_number);
  expect_consistent(sequence.rest());
  for (size_t i = 0; i < std::min<size_t>(numbers.size(), 8); ++i) {
    const double frame = double(numbers[i]) * frames_per_number;
    expect_consistent(sequence.at(frame));
    expect(sequence.hash(frame) == sequence.hash(frame), "a hash that changes");
  }
}

}  // namespace

bool frames(std::string_view bytes) {
  return accepted([&] { read_all(binary_frames(ByteSource::of_memory(bytes, "fuzz.bin")), 1); });
}

bool pc2(std::string_view bytes) {
  return accepted([&] {
    BaseMesh base;
    base.name = "base";
    base.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    base.triangle = {{0, 1, 2}};
    base.normal.resize(3, dvec3(0, 0, 1));
    const ByteSource source = ByteSource::of_memory(bytes, "fuzz.pc2");
    read_all(point_cache(source, base), frames_per_sample(source));
  });
}

}  // namespace wale::fuzz
