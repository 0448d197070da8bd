#pragma once

namespace wale {

/// How the plies that a ray meets are found: W_LOCAL_STAGE of the kernels.
enum class LocalStage { exact = 0, cell = 1, ring = 2 };

}  // namespace wale
