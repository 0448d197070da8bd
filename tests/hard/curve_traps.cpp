#include "tests/hard/trap.h"

namespace wale::test {

std::vector<Trap> curve_traps() { return {}; }

}  // namespace wale::test
