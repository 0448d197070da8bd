#include "tests/hard/wild_numbers.h"
#include "tests/tolerances.h"

namespace wale::test {

std::vector<Trap> number_traps() {
  const char* answers = "wrong answers";
  return {
      {"NaN and infinite rays",
       "every comparison with NaN is false, and a traversal that trusts them visits every node",
       "each misses and is counted, and the sound rays beside it answer as if alone", answers, 0, 1,
       look_at_rays_that_are_not_finite},
      {"time of NaN and infinite rays", "one ray that visits the whole tree holds up its whole wave",
       "a batch of them takes no longer than sound rays take", "of the time of sound rays", tolerance::kWildRayTime, 1,
       look_at_their_time},
      {"rays of random bits", "squares of finite numbers overflow, and infinity minus infinity is NaN",
       "a miss, or a hit of a real segment at a finite distance within (0, tmax]", answers, 0, 1,
       look_at_rays_of_random_bits},
      {"denormal rays", "a device may flush denormals to 0 and divide by them",
       "the same answer as with zeros in their place", answers, 0, 0, look_at_denormal_rays},
      {"vertices of random bits", "boxes and centres overflow, and a tree built on NaN never ends or loses leaves",
       "beyond 1e12 m refused in one line; else an answer within bounds for every ray, no slower than trying every "
       "leaf",
       answers, 0, 1, look_at_vertices_of_random_bits},
      {"NaN and infinite vertices", "one vertex that is no number makes every box round it swallow the scene",
       "refused at load, in one line with file and vertex, in every format", "files not refused", 0, 0,
       look_at_files_that_are_not_finite},
  };
}

}  // namespace wale::test
