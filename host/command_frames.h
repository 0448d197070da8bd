#pragma once
#include "host/commands.h"

namespace wale {

/// Renders frames of an animation, or one blurred picture: what `wale render` does with --frames or a shutter. Frames
/// that are finished are kept; a stop keeps whole frames.
int run_frames(const RenderArgs& args, const Loaders& loaders);

}  // namespace wale
