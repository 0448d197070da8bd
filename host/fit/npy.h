#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace wale::fit {

/// An array of a NumPy .npy file, row-major (C order).
struct NpyArray {
  std::vector<size_t> shape;
  std::vector<float> values;
};

/// Reads one of little-endian floats of 4 or 8 bytes, in C or Fortran order (NumPy Enhancement Proposal 1; versions 1
/// to 3). Throws user errors that begin with `name`.
NpyArray parse_npy(std::string_view bytes, const std::string& name);

/// "3 x 3 x 64 x 128": for messages.
std::string shape_text(const std::vector<size_t>& shape);

}  // namespace wale::fit
