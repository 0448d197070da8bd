#include "host/fit/loss_words.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "geom/error.h"
#include "host/fit/vgg16.h"
#include "host/suggest.h"

namespace wale::fit {
namespace {

struct Word {
  std::string name;
  double weight = 1;
};

// "a=1,b=0.5"; a name alone has weight 1.
std::vector<Word> weighted_words(const std::string& text, const char* option) {
  std::vector<Word> out;
  for (size_t at = 0; !text.empty() && at <= text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const size_t equals = part.find('=');
    Word word{part.substr(0, equals)};
    if (equals != std::string::npos) {
      const std::string number = part.substr(equals + 1);
      const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), word.weight);
      if (error != std::errc() || rest != number.data() + number.size() || !std::isfinite(word.weight) ||
          word.weight < 0)
        user_error("{}: {}: '{}' is no weight; valid: a number of at least 0", option, word.name, number);
    }
    for (const Word& before : out)
      if (before.name == word.name) user_error("{}: {} is named twice", option, word.name);
    out.push_back(std::move(word));
    at = end + 1;
  }
  return out;
}

struct Term {
  const char* name;
  double TermWeights::*weight;
  const char* words;
};
constexpr std::array<Term, 5> kTerms = {{{"low-pass", &TermWeights::low_pass, "low-passed pictures in linear light"},
                                         {"color", &TermWeights::color, "distributions of colours"},
                                         {"gradient", &TermWeights::gradient, "gradients at several scales"},
                                         {"spectrum", &TermWeights::spectrum, "spectra of luminance"},
                                         {"feature", &TermWeights::feature, "features of a VGG16"}}};

TermWeights term_weights(const std::string& text) {
  TermWeights out;
  std::vector<std::string> names;
  for (const Term& term : kTerms) names.push_back(term.name);
  for (const Word& word : weighted_words(text, "--loss")) {
    const auto term = std::find_if(kTerms.begin(), kTerms.end(), [&](const Term& t) { return word.name == t.name; });
    if (term == kTerms.end())
      user_error("--loss: no term is called '{}'; {}", word.name, nearest_choice(word.name, names));
    out.*term->weight = word.weight;
  }
  return out;
}

}  // namespace

NamedLoss::NamedLoss(const FitArgs& args, const PicturePair& photographs, std::vector<std::string>& warnings) {
  LossOptions options;
  const Alignment alignment = args.unaligned ? Alignment::unaligned : Alignment::aligned;
  options.descriptors.alignment = alignment;
  std::shared_ptr<const FeatureNetwork> network;
  if (!args.weights.empty()) {
    const std::shared_ptr<const Vgg16> read = read_vgg16(args.weights);
    // The paper's loss is of all 13 layers; which there are is never a secret.
    if (read->layers().size() < vgg16_layers().size())
      warnings.push_back(fmt::format("{}: {}", args.weights.string(), read->text()));
    network = read;
  } else if (!args.layers.empty()) {
    user_error("--layers: of a network; name its weights too: --weights FILE");
  }
  const TermWeights weights =
      args.terms.empty() ? usual_weights(alignment, network != nullptr) : term_weights(args.terms);
  if (weights.feature > 0 && !network) user_error("--loss: feature: the network's weights are needed: --weights FILE");
  options.weights = weights;
  for (const Word& word : weighted_words(args.layers, "--layers")) options.layers.push_back({word.name, word.weight});
  options.front = photographs.front.count() ? 1 : 0;
  options.back = photographs.back.count() ? 1 : 0;
  loss_ = std::make_unique<Loss>(whole(photographs), options, network);

  words_ = args.unaligned ? "Compared by statistics of windows" : "Compared pixel by pixel";
  for (const Term& term : kTerms)
    if (weights.*term.weight > 0) words_ += fmt::format(", {} (weight {:g})", term.words, weights.*term.weight);
  if (!network) words_ += "; no weights of a network were given, so gradients stand in for its features";
}

PicturePair NamedLoss::whole(const PicturePair& pair) {
  PicturePair out = pair;
  if (out.front.count() == 0) out.front = out.back;
  if (out.back.count() == 0) out.back = out.front;
  return out;
}

}  // namespace wale::fit
