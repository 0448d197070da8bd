#pragma once
#include <string>
#include <vector>

#include "host/fit/command.h"
#include "host/fit/loss.h"

namespace wale::fit {

/// A loss for pairs of which one picture may be missing, and its terms in words.
class NamedLoss {
 public:
  /// Reads the weights of a network, if any were named. Throws user errors that name the option or the file; appends
  /// what is to be warned of.
  NamedLoss(const FitArgs& args, const PicturePair& photographs, std::vector<std::string>& warnings);

  std::vector<double> residuals(const PicturePair& pair) const { return loss_->residuals(whole(pair)); }
  std::vector<int> cells() const { return loss_->cells(); }
  const std::string& words() const { return words_; }

 private:
  static PicturePair whole(const PicturePair& pair);

  std::unique_ptr<const Loss> loss_;
  std::string words_;
};

}  // namespace wale::fit
