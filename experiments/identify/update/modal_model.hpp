// The modes of a structure as functions of its unknown parameters, with exact derivatives.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/models/unknown.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// What [[parameters]] asks of the structure itself.
struct AskedParameters {
  std::vector<Unknown> unknowns;
  std::vector<fem::BeamParameter> parameters;  ///< of the same order
  std::vector<bool> has_prior;                 ///< a deviation is stated
  std::vector<std::string> left_out;           ///< names of those that frequencies do not depend on: dampings
};

/// Those of the file; without any, every storey of a chain or every factor by itself, or the bending
/// stiffness.
/// @throws InputError as unknowns_of(), and when nothing is left to ask about.
AskedParameters asked_parameters(const Experiment& experiment);

/// Modes at one set of values.
struct PredictedModes {
  Eigen::VectorXd frequency_hz;               ///< (k) ascending
  Eigen::MatrixXd shapes;                     ///< (p x k) displacements at the sensors
  Eigen::MatrixXd frequency_slopes;           ///< (k x q) df / dp; empty unless asked for
  std::vector<Eigen::MatrixXd> shape_slopes;  ///< of each mode (p x q), without its neighbours' part; p > 1
  /// Modes so close that only the space of their shapes is determined: first and number, for each mode.
  std::vector<std::pair<Eigen::Index, Eigen::Index>> cluster;
};

/// K(p) phi = lambda M(p) phi with M and K affine in p (fem::assemble_parametric). A small system is solved
/// dense, with all modes; of a large one the lowest are found through the strain factors of K.
///
/// lambda' = phi^T (K_j - lambda M_j) phi [fox1968]; phi' by the modes, of a large system by the lowest of
/// them and the static rest, S K^-1, solved once for all sensors.
class ModalModel {
 public:
  /// @param points sensors; @param count modes that at() finds at most
  /// @throws std::invalid_argument as assemble_parametric()
  ModalModel(const fem::Structure& structure, int elements, std::vector<fem::Point> points,
             AskedParameters asked, Eigen::Index count);

  const fem::Structure& structure() const { return structure_; }
  const AskedParameters& asked() const { return asked_; }
  const fem::ParametricSystem& described() const { return described_; }
  const std::vector<fem::Point>& points() const { return points_; }
  Eigen::Index size() const { return described_.system.size(); }        ///< n
  Eigen::Index parameters() const { return described_.values.size(); }  ///< q
  Eigen::Index modes() const { return count_; }                         ///< k
  bool dense() const;

  /// @param values of the parameters (q)
  /// @throws std::runtime_error when there are no such modes: a structure that has buckled.
  PredictedModes at(const Eigen::VectorXd& values, bool slopes) const;

  /// M and K at p, dense. @throws std::invalid_argument when the system is not small.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> matrices(const Eigen::VectorXd& values) const;

 private:
  fem::Structure structure_;
  int elements_;
  std::vector<fem::Point> points_;
  AskedParameters asked_;
  Eigen::Index count_;
  fem::ParametricSystem described_;
  std::vector<fem::SparseMatrix> stiffness_slopes_;  // K_j
  Eigen::MatrixXd mass_0_, stiffness_0_;             // at p = 0; dense only

  struct Found {
    Eigen::VectorXd eigenvalues;  // (m) with m >= k
    Eigen::MatrixXd shapes;       // (n x m), phi^T M phi = 1
    Eigen::MatrixXd compliance;   // S K^-1 (p x n); empty: the modes are all of them
  };
  Found found(const Eigen::VectorXd& values, bool slopes) const;
  void add_slopes(const Found& found, PredictedModes& modes) const;
};

}  // namespace beamid::experiments
