#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/fit/descriptor.h"
#include "host/fit/feature_descriptor.h"
#include "host/fit/picture.h"

namespace wale::fit {

/// Weights of the terms; one that is 0 is not computed.
struct TermWeights {
  double low_pass = 0, color = 0, gradient = 0, spectrum = 0, feature = 0;
};

/// Aligned: low-passed pictures and a tenth of features, or of gradients where there is no network. Unaligned: windows'
/// means, colours and spectra, and a tenth of features or gradients.
TermWeights usual_weights(Alignment alignment, bool network);

struct LossOptions {
  DescriptorOptions descriptors;
  std::optional<TermWeights> weights;  ///< not given: usual_weights()
  std::vector<LayerWeight> layers;     ///< of the network; none: the last of each block (relu1_2, relu2_2, ...)
  double front = 1, back = 1;          ///< shares of the two pictures
};

/// How far a pair of pictures is from a target pair:
///
///     loss = sum over pictures p, terms t, blocks b of
///              share_p weight_t weight_b mean over i of ((x_i - target_i) / unit_b)^2
///
/// with shares that add up to 1, and units of the target (Block::unit): a block counts |x - target|^2 / |target|^2, so
/// that a dim back picture is worth a bright front one, and a black render loses the sum of the weights; but in blocks
/// of contrast, where a difference of logarithms counts as it is.
class Loss {
 public:
  /// Throws user errors: a picture without pixels, of two sizes or black, a weight below 0 or all of them 0, features
  /// without a network, a layer that it has not, features that overflow.
  Loss(const PicturePair& target, const LossOptions& options, std::shared_ptr<const FeatureNetwork> network = nullptr);

  double loss(const PicturePair& pair) const;
  /// What is squared and summed up in loss(), always in the same order; the derivative by a parameter is what least
  /// squares need.
  std::vector<double> residuals(const PicturePair& pair) const;

  /// Of each residual, from which part of the two photographs it is: one of kStrips strips of pixels, or a window. What
  /// one part has of noise, another has not; but windows overlap by half.
  std::vector<int> cells() const;
  static constexpr int kStrips = 16;

  /// One block's part of the loss.
  struct Contribution {
    std::string name;  ///< "front, low pass, 1/2"
    double value;
  };
  std::vector<Contribution> contributions(const PicturePair& pair) const;

  const PicturePair& target() const { return target_; }

 private:
  struct Term {
    std::string name;
    double weight;  ///< share of its picture included
    const Picture PicturePair::*picture;
    Descriptor describe;
    Blocks target;
  };
  template <typename Visit>
  void for_each_block(const PicturePair& pair, const Visit& visit) const;
  void add_terms(const Picture PicturePair::*picture, const std::string& name, double share, const TermWeights& weights,
                 const LossOptions& options, const std::shared_ptr<const FeatureNetwork>& network);

  PicturePair target_;
  std::vector<Term> terms_;
};

}  // namespace wale::fit
