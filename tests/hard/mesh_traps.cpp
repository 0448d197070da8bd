#include "tests/hard/trap.h"

namespace wale::test {

std::vector<Trap> mesh_traps() { return {}; }

}  // namespace wale::test
