#ifndef WALE_VISITS_H
#define WALE_VISITS_H
/* What a traversal touches, counted in programs built with W_COUNT_VISITS: words behind the rare events of
   WScene.counters. Such programs measure bytes moved, never time. */
#include "shared/wale_types.h"
#define W_VISIT_NODE (W_EVENT_COUNT + 0)
#define W_VISIT_LEAF (W_EVENT_COUNT + 1) /* patch of plies */
#define W_VISIT_TRIANGLES (W_EVENT_COUNT + 2)
/* By traverse_simt.clh alone: nodes come back to for the children that waited, leaf boxes read, segments tested. */
#define W_VISIT_AGAIN (W_EVENT_COUNT + 3)
#define W_VISIT_BOX (W_EVENT_COUNT + 4)
#define W_VISIT_SEGMENT (W_EVENT_COUNT + 5)
#define W_COUNTER_COUNT (W_EVENT_COUNT + 6)
#ifdef __OPENCL_VERSION__
#ifdef W_COUNT_VISITS
#define W_COUNT(scene, what) atomic_inc((scene)->counters + (what))
#else
#define W_COUNT(scene, what)
#endif
#endif
#endif
