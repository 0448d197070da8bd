/* Small stages as one program: a driver that compiles one kernel after the other reads its own headers once for all. */
#include "stages/generate.cl"
#include "stages/compact.cl"
#include "stages/miss.cl"
#include "stages/accumulate.cl"
