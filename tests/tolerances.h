#pragma once
/* Every tolerance of the tests, by name, with the reason for its size. */

namespace wale::tolerance {

// Appearance, kernels against the double oracle, relative to the value.
constexpr double kBsdfFloat = 1e-4;      // float: angles to 1e-7, divided by the variance of the narrowest lobe
constexpr double kBsdfDouble = 1e-6;     // double build: the Bessel polynomials of Abramowitz & Stegun, 2e-7
constexpr double kFurnace = 2e-6;        // sum of energies of white plies: float rounding alone
constexpr double kEnergyDouble = 1e-12;  // same formulas, other order
constexpr double kPdfIntegral = 1e-3;    // midpoint grid of 384 x 384 over the sphere
constexpr double kCoatTable = 2e-3;      // coarser integration than the table's, and its 5 digits
constexpr double kSurfaceFloat = 1e-3;   // float against double: D of the sharpest coat, alpha 0.0025
constexpr double kSurfaceFurnace = 0.01;
constexpr double kReciprocity = 2e-5;  // float rounding of the coat's D at its sharpest tested roughness

// Lights.
constexpr double kFormFactor = 2e-3;  // mean of 2^18 stratified samples against closed forms
constexpr double kDensityFloat = 2e-4;

// Statistics: a family of tests fails by chance once in a hundred times, and the seeds are fixed.
constexpr double kFamilyP = 0.01;

// Seconds of processor time that a reader may take for any file of up to 64 KiB: what a user does not notice.
constexpr double kReaderSeconds = 1;

}  // namespace wale::tolerance
