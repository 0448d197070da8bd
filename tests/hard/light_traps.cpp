#include "tests/hard/trap.h"

namespace wale::test {

std::vector<Trap> light_traps() { return {}; }

}  // namespace wale::test
