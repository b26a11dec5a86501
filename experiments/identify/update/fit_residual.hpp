// What least squares makes small, in the coordinates of a search.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/update/search_space.hpp"

namespace beamid::experiments {

/// r(x) in standard deviations, of one structure or of several that share the parameters.
class FitResidual {
 public:
  struct Value {
    Eigen::VectorXd residual;         ///< (r)
    Eigen::MatrixXd jacobian;         ///< dr/dx (r x q); empty unless asked for
    std::vector<Eigen::Index> pairs;  ///< of one structure: the predicted mode of each measured one
    PredictedModes modes;             ///< likewise
    std::vector<Value> parts;         ///< of several structures: each one's pairs and modes
    double chi_square() const { return residual.squaredNorm(); }
  };
  virtual ~FitResidual() = default;

  /// @throws std::runtime_error when there are no such modes.
  virtual Value at(const Eigen::VectorXd& x, bool jacobian) const = 0;
  /// Numbers that are independent: a shape has as many as its components less those of the space.
  virtual Eigen::Index independent(const Value& value) const = 0;
  virtual const ModesOfParameters& model() const = 0;  ///< of several structures the first one's
  virtual const SearchSpace& space() const = 0;
};

}  // namespace beamid::experiments
