// The modes of a structure as functions of parameters, whatever these are.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/unknown.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {

/// What is asked of a structure itself.
struct AskedParameters {
  std::vector<Unknown> unknowns;
  std::vector<fem::BeamParameter> parameters;  ///< of the same order; none of changes (cause_model.hpp)
  std::vector<bool> has_prior;                 ///< a deviation is stated
  std::vector<std::string> left_out;           ///< names of those that frequencies do not depend on: dampings
};

/// Modes at one set of values.
struct PredictedModes {
  Eigen::VectorXd frequency_hz;               ///< (k) ascending
  Eigen::MatrixXd shapes;                     ///< (p x k) displacements at the sensors
  Eigen::MatrixXd frequency_slopes;           ///< (k x q) df / dp; empty unless asked for
  std::vector<Eigen::MatrixXd> shape_slopes;  ///< of each mode (p x q), without its neighbours' part; p > 1
  /// Modes so close that only the space of their shapes is determined: first and number, for each mode.
  std::vector<std::pair<Eigen::Index, Eigen::Index>> cluster;
};

/// What a residual needs of a model.
class ModesOfParameters {
 public:
  virtual ~ModesOfParameters() = default;

  /// @param values of the parameters (q)
  /// @throws std::runtime_error when there are no such modes: a structure that has buckled.
  virtual PredictedModes at(const Eigen::VectorXd& values, bool slopes) const = 0;

  virtual const AskedParameters& asked() const = 0;  ///< q
  virtual Eigen::Index size() const = 0;             ///< n coordinates
  virtual Eigen::Index modes() const = 0;            ///< k that at() finds at most
  virtual bool dense() const = 0;                    ///< so small that all modes are found at once
  Eigen::Index parameters() const { return static_cast<Eigen::Index>(asked().unknowns.size()); }  ///< q
};

}  // namespace beamid::experiments
