#pragma once
// Hard cases by name: each trap says what breaks without care, what Wale promises, and measures it.
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace wale::test {

/// What one look at a trap found.
struct Finding {
  /// Worst error in the trap's unit, of the float and of the double build of the kernels. NaN: not measured there
  /// (pictures have no double build; a device may have no fp64).
  double error_float = NAN, error_double = NAN;
  uint64_t trials = 0;  ///< rays, pixels or inputs that were tried
  uint64_t rare = 0;    ///< rare events (W_EVENT_*) counted on the device meanwhile
  std::string broken;   ///< the part of the promise that is no number: empty when kept
};

/// One hard case.
struct Trap {
  std::string name;       ///< as in the table; its test is called after it
  std::string breaks;     ///< one sentence: what goes wrong without care
  std::string promise;    ///< one sentence: what holds
  std::string unit;       ///< of the error: "ply radii", "ulp", "of the picture's mean", "wrong answers", ...
  double limit = 0;       ///< largest error, float and double
  double rare_limit = 0;  ///< largest share rare / trials
  std::function<Finding()> look;
};

// One function per kind; each trap belongs to one of them.
std::vector<Trap> ray_traps();       ///< a ray against one or a few ply segments
std::vector<Trap> curve_traps();     ///< shapes of plies
std::vector<Trap> mesh_traps();      ///< base meshes, UVs and tiles
std::vector<Trap> fabric_traps();    ///< tiles and meshes of unequal size, at their limits
std::vector<Trap> light_traps();     ///< lights, cameras, materials at their limits
std::vector<Trap> distance_traps();  ///< scale and place of whole scenes
std::vector<Trap> number_traps();    ///< NaN, Inf, denormals, random bits

/// All of them, in the order of the table.
const std::vector<Trap>& traps();

/// The table of docs/hard_cases.md. `measured` looks at every trap; otherwise only what does not depend on the machine.
std::string trap_table(bool measured);

}  // namespace wale::test
