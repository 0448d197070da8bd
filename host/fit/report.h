#pragma once
#include <string>
#include <vector>

#include "host/fit/fit.h"

namespace wale::fit {

/// What the page of a fit says beside its result.
struct FitReport {
  std::string scene, command, device;
  std::string loss;                   ///< its terms, in words
  std::vector<std::string> warnings;  ///< of photographs, weights and parameters
  PicturePair photographs;            ///< as they were compared; the size of the renders
};

/// A parameter's row in words: its value, range and what is to be said of it.
std::string parameter_line(const FitParameter& parameter, const FittedParameter& fitted);

/// What went wrong with the parameters, one line each: not determined, at a bound, alike.
std::vector<std::string> parameter_warnings(const FitSettings& settings, const FitResult& result);

/// Photograph, render and difference of each side, as one picture for a file.
Image side_by_side(const PicturePair& photographs, const PicturePair& renders);

/// A page that needs nothing else.
std::string report_html(const FitReport& report, const FitSettings& settings, const FitJournal& journal,
                        const FitResult& result);

}  // namespace wale::fit
