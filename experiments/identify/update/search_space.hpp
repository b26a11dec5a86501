// The coordinates in which parameters are searched for.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "experiments/identify/update/predicted_modes.hpp"

namespace beamid::experiments {

/// x = ln(p / guess) of positive quantities, whose frequencies depend on ratios; x = (p - guess) / scale of
/// an axial load or of a guess of zero. A box keeps the search within bounds that are stated, or within a
/// factor of 1e4 where none are.
class SearchSpace {
 public:
  explicit SearchSpace(const AskedParameters& asked);
  /// @param likely from, to (q): where the starts are drawn, in place of all that the bounds allow
  SearchSpace(const AskedParameters& asked, const std::vector<std::pair<double, double>>& likely);

  Eigen::Index size() const { return lower_.size(); }
  const Eigen::VectorXd& lower() const { return lower_; }  ///< of x (q)
  const Eigen::VectorXd& upper() const { return upper_; }
  bool stated(Eigen::Index j) const { return stated_[static_cast<std::size_t>(j)]; }  ///< bounds of p_j
  bool logarithmic(Eigen::Index j) const { return logarithmic_[static_cast<std::size_t>(j)]; }

  /// That a step is not to exceed (q): 1 of a logarithm; where bounds are much wider than what is likely, a
  /// fifth of them.
  const Eigen::VectorXd& longest_step() const { return longest_step_; }

  Eigen::VectorXd physical(const Eigen::VectorXd& x) const;
  Eigen::VectorXd slope(const Eigen::VectorXd& x) const;  ///< dp/dx (q)
  Eigen::VectorXd place(const Eigen::VectorXd& values) const;

  /// A start: number 0 is the guess, the others are drawn evenly in x between the bounds stated, or within a
  /// factor of 5 of the guess.
  Eigen::VectorXd start(std::size_t number) const;

 private:
  Eigen::VectorXd guess_, scale_, lower_, upper_, from_, to_, longest_step_;
  std::vector<bool> logarithmic_, stated_;
};

}  // namespace beamid::experiments
