// Which predicted mode a measured one is.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/modal_data.hpp"
#include "experiments/models/unknown.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {

// The modes of a structure as functions of parameters, whatever these are.

/// What is asked of a structure itself.
struct AskedParameters {
  std::vector<Unknown> unknowns;
  std::vector<fem::BeamParameter> parameters;  ///< of the same order; none of changes (shared_residual.hpp)
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

/// For each row of the scores (a x b, a <= b) the column that makes their sum largest, no column twice
/// (Hungarian method [kuhn1955]).
std::vector<Eigen::Index> best_assignment(const Eigen::MatrixXd& scores);

/// MAC of measured and predicted mode (measured x k), NaN where no shape was measured. Of a predicted mode
/// with close neighbours that of the nearest shape in their common space.
Eigen::MatrixXd modal_assurances(const ModalData& data, const PredictedModes& modes);

/// MAC less |ln(f / f')| (measured x k), without MAC where no shape was measured.
Eigen::MatrixXd pairing_scores(const ModalData& data, const PredictedModes& modes,
                               const Eigen::MatrixXd& assurances);

/// The predicted mode, from 0, of each measured one. A number stated stays. Where shapes were measured, MAC
/// less |ln(f / f')| is made largest in sum; where none were, the modes are the lowest, in their order.
std::vector<Eigen::Index> pair_modes(const ModalData& data, const PredictedModes& modes);

}  // namespace beamid::experiments
