#pragma once
#include <string>
#include <vector>

#include "host/fit/command.h"
#include "host/fit/photograph.h"

namespace wale::fit {

/// The photographs of a command; one side may be missing. Appends what is to be warned of.
PicturePair read_photographs(const FitArgs& args, std::vector<std::string>& warnings);

/// Options of one photograph from the words of a command line, reference and gains with the front or the only one.
/// Exposures of a command line change the back's brightness against the front's alone. Throws user errors that name
/// the option.
PhotographOptions photograph_options(const FitArgs& args, bool front);

}  // namespace wale::fit
