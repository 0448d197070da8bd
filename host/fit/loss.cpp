#include "host/fit/loss.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "host/suggest.h"

namespace wale::fit {
namespace {

void require_weight(double weight, const char* name) {
  if (!(std::isfinite(weight) && weight >= 0))
    user_error("loss: {}: {:g} is no weight; valid: 0 and above", name, weight);
}

void require_options(const LossOptions& options, const TermWeights& w, bool network) {
  require_weight(options.front, "front");
  require_weight(options.back, "back");
  require_weight(w.low_pass, "low_pass");
  require_weight(w.color, "color");
  require_weight(w.gradient, "gradient");
  require_weight(w.spectrum, "spectrum");
  require_weight(w.feature, "feature");
  if (!(options.front + options.back > 0)) user_error("loss: front and back are both 0; give one of them a weight");
  if (!(w.low_pass + w.color + w.gradient + w.spectrum + w.feature > 0))
    user_error("loss: all weights are 0; give one of low_pass, color, gradient, spectrum, feature");
  if (w.feature > 0 && !network) user_error("loss: feature: needs the weights of a network; gradient needs none");
  const DescriptorOptions& d = options.descriptors;
  if (d.windows < 1 || d.windows > 64) user_error("loss: windows: {}; valid: 1 to 64", d.windows);
  if (d.levels < 1 || d.levels > 16) user_error("loss: levels: {}; valid: 1 to 16", d.levels);
}

void require_pictures(const PicturePair& pair, int windows) {
  if (pair.front.width != pair.back.width || pair.front.height != pair.back.height)
    user_error("loss: the front picture has {} x {} pixels, the back one {} x {}; both need one size", pair.front.width,
               pair.front.height, pair.back.width, pair.back.height);
  const int least = 2 * (windows + 1);
  if (std::min(pair.front.width, pair.front.height) < least)
    user_error("loss: {} x {} pixels are too few for {} windows; at least {} x {}", pair.front.width, pair.front.height,
               windows, least, least);
}

// The last layers of VGG16's blocks, as far as the network has them.
std::vector<LayerWeight> usual_layers(const FeatureNetwork& network) {
  std::vector<LayerWeight> chosen;
  for (const char* name : {"relu1_2", "relu2_2", "relu3_3", "relu4_3", "relu5_3"})
    if (std::count(network.layers().begin(), network.layers().end(), name)) chosen.push_back({name, 1});
  if (chosen.empty()) chosen.push_back({network.layers().back(), 1});
  return chosen;
}

std::vector<LayerWeight> checked_layers(const std::vector<LayerWeight>& wanted, const FeatureNetwork& network) {
  if (wanted.empty()) return usual_layers(network);
  double sum = 0;
  for (const LayerWeight& layer : wanted) {
    require_weight(layer.weight, layer.layer.c_str());
    sum += layer.weight;
    if (!std::count(network.layers().begin(), network.layers().end(), layer.layer))
      user_error("loss: layer \"{}\": the network has none of this name; {}", layer.layer,
                 nearest_choice(layer.layer, network.layers()));
  }
  if (!(sum > 0)) user_error("loss: the weights of all layers are 0");
  return wanted;
}

}  // namespace

TermWeights usual_weights(Alignment alignment, bool network) {
  constexpr double kTenth = 0.1;
  TermWeights weights;
  weights.low_pass = 1;
  if (alignment == Alignment::unaligned) weights.color = weights.spectrum = 1;
  (network ? weights.feature : weights.gradient) = kTenth;
  return weights;
}

Loss::Loss(const PicturePair& target, const LossOptions& options, std::shared_ptr<const FeatureNetwork> network)
    : target_(target) {
  const TermWeights weights =
      options.weights.value_or(usual_weights(options.descriptors.alignment, network != nullptr));
  require_options(options, weights, network != nullptr);
  require_pictures(target_, options.descriptors.windows);
  const double sum = options.front + options.back;
  add_terms(&PicturePair::front, "front", options.front / sum, weights, options, network);
  add_terms(&PicturePair::back, "back", options.back / sum, weights, options, network);
}

void Loss::add_terms(const Picture PicturePair::*picture, const std::string& name, double share,
                     const TermWeights& weights, const LossOptions& options,
                     const std::shared_ptr<const FeatureNetwork>& network) {
  if (share == 0) return;
  const Picture& target = target_.*picture;
  if (!(brightness(target) > 0)) user_error("loss: the {} picture is black", name);
  const auto add = [&](const char* term, double weight, const auto& make) {
    if (weight == 0) return;
    Descriptor describe = make();
    Blocks blocks = describe(target);
    for (const Block& block : blocks)
      if (!std::all_of(block.values.begin(), block.values.end(), [](float value) { return std::isfinite(value); }))
        user_error("loss: {}, {}: values of the {} picture are not finite; are the network's weights sound?", term,
                   block.name, name);
    terms_.push_back({name + ", " + term, share * weight, picture, std::move(describe), std::move(blocks)});
  };
  const DescriptorOptions& how = options.descriptors;
  add("low pass", weights.low_pass, [&] { return low_pass_descriptor(how); });
  add("color", weights.color, [&] { return color_descriptor(how); });
  add("gradient", weights.gradient, [&] { return gradient_descriptor(how); });
  add("spectrum", weights.spectrum, [&] { return spectrum_descriptor(how); });
  add("feature", weights.feature, [&] {
    return feature_descriptor(network, checked_layers(options.layers, *network), display_exposure(target), how);
  });
}

// visit(term, block of the target, block of the pair, factor on each difference)
template <typename Visit>
void Loss::for_each_block(const PicturePair& pair, const Visit& visit) const {
  for (const Term& term : terms_) {
    const Picture& picture = pair.*term.picture;
    if (picture.width != target_.front.width || picture.height != target_.front.height)
      bug("Loss: {} x {} pixels against {} x {}", picture.width, picture.height, target_.front.width,
          target_.front.height);
    const Blocks blocks = term.describe(picture);
    for (size_t i = 0; i < blocks.size(); ++i) {
      const Block& target = term.target[i];
      visit(term, target, blocks[i],
            std::sqrt(term.weight * target.weight / double(target.values.size())) / target.unit);
    }
  }
}

std::vector<double> Loss::residuals(const PicturePair& pair) const {
  std::vector<double> all;
  for_each_block(pair, [&](const Term&, const Block& target, const Block& block, double factor) {
    for (size_t i = 0; i < block.values.size(); ++i)
      all.push_back(factor * (double(block.values[i]) - double(target.values[i])));
  });
  return all;
}

std::vector<int> Loss::cells() const {
  std::vector<int> all;
  int first = 0;
  for (const auto side : {&PicturePair::front, &PicturePair::back}) {
    int most = 0;
    for (const Term& term : terms_) {
      if (term.picture != side) continue;
      for (const Block& block : term.target) {
        const size_t count = block.values.size();
        for (size_t i = 0; i < count; ++i) {
          const size_t cell = block.windows ? i * size_t(block.windows) / count
                                            : i * size_t(block.passes) % count * size_t(kStrips) / count;
          all.push_back(first + int(cell));
        }
        most = std::max(most, block.windows ? block.windows : kStrips);
      }
    }
    first += most;
  }
  return all;
}

std::vector<Loss::Contribution> Loss::contributions(const PicturePair& pair) const {
  std::vector<Contribution> all;
  for_each_block(pair, [&](const Term& term, const Block& target, const Block& block, double factor) {
    double sum = 0;
    for (size_t i = 0; i < block.values.size(); ++i) {
      const double residual = factor * (double(block.values[i]) - double(target.values[i]));
      sum += residual * residual;
    }
    all.push_back({term.name + ", " + block.name, sum});
  });
  return all;
}

double Loss::loss(const PicturePair& pair) const {
  double sum = 0;
  for (const Contribution& part : contributions(pair)) sum += part.value;
  return sum;
}

}  // namespace wale::fit
