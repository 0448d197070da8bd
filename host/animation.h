#pragma once
#include "host/schema.h"

namespace wale {

/// The scene's key "animation".
Type animation_type();

/// Puts the values that the document's key frames have at its animation.frame where they belong, as --set would. Throws
/// user errors that name the key. What is no animation at all is left to the check of the schema.
void apply_key_frames(JsonNode& document);

/// Removes what tells one frame from another without showing: with a shutter that is closed, key frames that have been
/// applied, and frame 0.
void forget_key_frames(JsonNode& document);

}  // namespace wale
