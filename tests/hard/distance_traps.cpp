#include "tests/hard/trap.h"

namespace wale::test {

std::vector<Trap> distance_traps() { return {}; }

}  // namespace wale::test
