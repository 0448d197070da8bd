#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/fit/picture.h"

namespace wale::fit {

/// Values of one kind that describe a picture.
struct Block {
  std::string name;
  double weight;  ///< share of its descriptor; those of one picture add up to 1
  /// What differences to this picture count by: the root mean square of the values of this kind in it, but never less
  /// than kLeastUnit of its brightness, so that nothing divides by a shade that the picture hardly has.
  double unit;
  std::vector<float> values;
  int passes = 1;   ///< how often the values run over the picture, from its top down
  int windows = 0;  ///< > 0: values of one window after those of another instead, so many windows
};
using Blocks = std::vector<Block>;
constexpr double kLeastUnit = 0.02;
/// Contrast below which cloths look alike.
constexpr double kLeastContrast = 0.02;

/// Whether two pictures are compared pixel by pixel, or only what they look like in windows.
enum class Alignment { aligned, unaligned };

/// How a picture is cut up for the descriptors.
struct DescriptorOptions {
  Alignment alignment = Alignment::aligned;
  int windows = 3;  ///< unaligned: across and down (host/fit/windows.h)
  int levels = 4;   ///< pictures of a pyramid, the first at full resolution, each next half as large
};

/// One term of a loss: a picture to blocks, whose names, weights and sizes follow from the picture's size alone.
using Descriptor = std::function<Blocks(const Picture&)>;

/// Linear light. Aligned: the pixels of a pyramid, one block a level, so that what lies a pixel aside still counts as
/// near. Unaligned: mean colour of each window.
Descriptor low_pass_descriptor(const DescriptorOptions& options);

/// Distribution of colours in the picture (aligned) or each window (unaligned): mean; contrast (logarithm of standard
/// deviation over mean) and correlations of the channels; and 16 quantiles of each channel, whose squared differences
/// are the squared Wasserstein distance on the line.
Descriptor color_descriptor(const DescriptorOptions& options);

/// Edges, at every level of a pyramid: differences of neighbours across and down. Aligned: all of them. Unaligned: mean
/// and root mean square of their sizes in each window, as contrast. It stands in for the features of a network where
/// there are no weights: they, too, are edges at first.
Descriptor gradient_descriptor(const DescriptorOptions& options);

/// Contrast (logarithm of standard deviation over mean) of luminance in each window (of the picture, where aligned) by
/// band of spatial frequency, half an octave each: the spectrum averaged over rings, without phases, thus wherever the
/// stitches lie.
Descriptor spectrum_descriptor(const DescriptorOptions& options);

/// Values of a kind and the picture's brightness to Block::unit.
double unit_of(const std::vector<float>& values, double picture_brightness);

}  // namespace wale::fit
