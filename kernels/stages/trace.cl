/* The stages that follow single rays as one program: they share the traversal, which is then read once. */
#include "stages/intersect.cl"
#include "stages/connect.cl"
