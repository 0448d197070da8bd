#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/fit/command.h"
#include "host/fit/fit.h"

namespace wale::fit {

/// What `wale fit` was asked for, read and checked.
struct FitTask {
  Scene scene;  ///< with the film's size of the pictures that are compared
  FitSettings settings;
  std::array<bool, 2> sides{};  ///< which photographs are given
  PicturePair photographs;      ///< linear, of the film's size
  std::vector<std::string> warnings;
};

/// Throws user errors that name the option, the file or the scene's key.
FitTask read_task(const FitArgs& args);

/// Tells fits apart: whatever changes what is fitted, the bytes of all files that are read among it.
std::string identity_of(const FitArgs& args, const FitTask& task);

}  // namespace wale::fit
