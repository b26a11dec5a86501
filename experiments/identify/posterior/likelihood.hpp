// What was measured, as a function of parameters whose priors are standard normal.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace beamid::experiments {

/// ln L(u), its gradient, and a positive semidefinite approximation of its negative second derivative (of a
/// sum of squares: J^T J).
struct LikelihoodValue {
  double log = -std::numeric_limits<double>::infinity();  ///< -inf: impossible
  Eigen::VectorXd gradient;                               ///< (q); empty unless asked for
  Eigen::MatrixXd information;                            ///< (q x q); likewise
  bool possible() const { return log > -std::numeric_limits<double>::infinity(); }
};

/// Called from several threads at once.
class Likelihood {
 public:
  virtual ~Likelihood() = default;
  virtual Eigen::Index size() const = 0;  ///< q
  virtual LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const = 0;
};

}  // namespace beamid::experiments
