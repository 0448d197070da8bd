#pragma once
/* Every tolerance of the tests, by name, with the reason for its size. */

namespace wale::tolerance {

// Appearance, kernels against the double oracle, relative to the value.
constexpr double kBsdfFloat = 1e-4;      // float: angles to 1e-7, divided by the variance of the narrowest lobe
constexpr double kBsdfDouble = 1e-6;     // double build: the Bessel polynomials of Abramowitz & Stegun, 2e-7
constexpr double kFurnace = 2e-6;        // sum of energies of white plies: float rounding alone
constexpr double kEnergyDouble = 1e-12;  // same formulas, other order
constexpr double kPdfIntegral = 1e-3;    // midpoint grid of 384 x 384 over the sphere
constexpr double kElementary = 3e-7;     // polynomials of shared/elementary.clh: two or three roundings of 2^-24
constexpr double kCoatTable = 2e-3;      // coarser integration than the table's, and its 5 digits
constexpr double kSurfaceFloat = 1e-3;   // float against double: D of the sharpest coat, alpha 0.0025
constexpr double kSurfaceFurnace = 0.01;
constexpr double kReciprocity = 2e-5;  // float rounding of the coat's D at its sharpest tested roughness

// Intersection, in ply radii, from 10 to 1e6 radii away.
constexpr double kOffSurfaceFloat = 1e-6;  // the point is set back on its surface: a few roundings of 2^-24
constexpr double kPointFloat = 1e-4;       // what is promised; where |h| < 0.99 and the ray does not run along the axis
constexpr double kPointDouble = 1e-9;      // the vertices' coordinates in double, 1e-16 of 1e6 radii

// Rays and plies at their limits.
constexpr double kAcrossJoint = 5e-3;  // two rays 1e-3 radii beside a joint; a ply's frame turns by less than 2/r there
constexpr double kCreepDepth = 1.001e-3;  // W_PARALLEL of the kernels is the square of 1e-3, rounded
constexpr double kMoved = 1e-4;           // radii: rounding of coordinates a few hundred radii from the origin
constexpr double kWildRayTime = 2.5;      // NaN and infinite rays over sound ones
constexpr double kFurnaceMean = 0.005;    // three standard errors of a picture of 24 x 24 pixels and 256 samples

// Lights.
constexpr double kFormFactor = 2e-3;  // mean of 2^18 stratified samples against closed forms
constexpr double kDensityFloat = 2e-4;

// Hard cases.
constexpr double kFurnacePicture = 0.005;  // mean of a white furnace of 1e5 paths: four standard errors
constexpr double kFurnaceSmall = 0.02;     // the same of 1e4 paths
constexpr double kProportional = 1e-5;     // sums of 64 floats in another order of magnitude
constexpr double kStandardErrors = 4;      // of one statistic: by chance once in 16000 times
constexpr double kLessThanNoise = 1;       // the promise itself
constexpr double kPixelsOfAnotherScale = 0.01;
constexpr double kGrazingShare = 1e-3;     // rays within 1e-3 of a silhouette, |h| > 0.999, that float may decide otherwise

// Levels of accuracy, in ply radii: hits against the curved ply (the seam's overlap, and float coordinates), and points
// that are kept in 16 bits.
constexpr double kJointSurface = 1e-4;

// Statistics: a family of tests fails by chance once in a hundred times, and the seeds are fixed.
constexpr double kFamilyP = 0.01;

// Of a tile's standard error, between drivers and with the same seed: as if 16 of its 512 paths had gone elsewhere. One
// such path moves its pixel by half a standard error and the tile's mean by 1/16 of one; 16 at random by 4/16.
constexpr double kShareOfNoise = 0.25;

// Rendering to an error goal.
constexpr double kErrorOfError = 0.03;  // mean over 300 tiles of 448 degrees of freedom, and the skew of 400 samples
constexpr double kFactorOfGoal = 1.5;   // the promise: actual error over the one asked for
constexpr double kBiasShare = 0.005;    // four standard errors of the mean of 24 pictures of 576 pixels, and the reference's
constexpr double kVarianceShare = 0.1;  // variance channel against the spread of 24 pictures of 576 pixels

// Yarn radii by which a bundled tile may differ from the one that its chart gives on another machine: forces end at a
// tolerance, not at 0.
constexpr double kRelaxedAgain = 0.01;

// Chart and published simulation of one knit: share by which periods, and yarn radii by which centrelines at the
// published period, may differ. And radii between what a chart relaxes into there and what the published tile does:
// rows of theirs differ in length by 0.4 %, ours do not.
constexpr double kPublishedPeriod = 0.05, kPublishedDistance = 0.5, kPublishedAtRest = 0.2;

// Seconds of processor time that a reader may take for any file of up to 64 KiB: what a user does not notice.
constexpr double kReaderSeconds = 1;

// Device memory of a segment of three-ply yarn, bytes: to trace it, to shade it too, and to trace it from a lattice.
constexpr double kBytesToTrace = 30, kBytesToShade = 48, kProceduralBytes = 4;

// Stored leaves against their estimate (host/memory_needs.h): some hold fewer intervals than others of their yarn.
constexpr double kLeafBytes = 0.1;

// Animation. Memory of a tiny scene over a hundred frames, MB: what an allocator keeps or gives back by chance. Lengths
// along yarns and azimuths of a cloth that is knitted anew on other triangles: a float of some metres, and of a turn.
constexpr double kMegabytesInHundredFrames = 3;
constexpr double kSameLength = 2e-6, kSameDirection = 2e-5;

}  // namespace wale::tolerance
