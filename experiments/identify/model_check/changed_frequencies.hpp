// The predicted frequencies of changed beams.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/model_check/model_check.hpp"

namespace beamid::experiments {

/// f(x) of the checked modes, from assembling the changed beams anew: changes need not be small.
class ChangedFrequencies {
 public:
  explicit ChangedFrequencies(const ModelCheck& check) : check_(check) {}

  /// ln(identified / predicted at x) (n). @param which candidates (q); @param change x (q)
  Eigen::VectorXd left(const std::vector<std::size_t>& which, const Eigen::VectorXd& change) const;

  /// d ln f / dx (n x q), by differences: central, one-sided at the limits of what is possible.
  Eigen::MatrixXd slope(const std::vector<std::size_t>& which, const Eigen::VectorXd& change) const;

 private:
  const ModelCheck& check_;
};

}  // namespace beamid::experiments
