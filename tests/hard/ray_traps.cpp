#include "tests/hard/trap.h"

namespace wale::test {

std::vector<Trap> ray_traps() { return {}; }

}  // namespace wale::test
