// The modes of a structure as functions of its unknown parameters, with exact derivatives.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "fem/structural_system.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

// Modes that were found, and how they change with the matrices.

struct FoundModes {
  Eigen::VectorXd eigenvalues;  ///< (m) with m >= k
  Eigen::MatrixXd shapes;       ///< (n x m), phi^T M phi = 1
  Eigen::MatrixXd compliance;   ///< S K^-1 (p x n); empty: the modes are all of them, or S is one point
};

/// What one parameter does to the matrices.
struct MatrixSlope {
  fem::SparseMatrix stiffness, mass;  ///< K_j, M_j (n x n)
};

/// The k lowest; where shapes at several points are to have slopes, twice as many and the static rest.
/// @throws std::runtime_error when there are no such modes.
FoundModes lowest_found_modes(const fem::StructuralSystem& system, Eigen::Index count, bool slopes);

/// The k lowest of them as sensors see them, without slopes.
/// @throws std::runtime_error when a mode has a negative stiffness.
PredictedModes seen_modes(const FoundModes& found, const fem::SparseMatrix& outputs, Eigen::Index count);

/// lambda' = phi^T (K_j - lambda M_j) phi [fox1968] and the change of each shape at the sensors.
void add_slopes(const FoundModes& found, const fem::SparseMatrix& outputs,
                const std::vector<MatrixSlope>& slopes, PredictedModes& modes);

/// Those of [[parameters]]; without any, every storey of a chain or every factor by itself, or the bending
/// stiffness.
/// @throws InputError as unknowns_of(), and when nothing is left to ask about.
AskedParameters asked_parameters(const Experiment& experiment);

/// K(p) phi = lambda M(p) phi with M and K affine in p (fem::assemble_parametric). A small system is solved
/// dense, with all modes; of a large one the lowest are found through the strain factors of K.
///
/// lambda' = phi^T (K_j - lambda M_j) phi [fox1968]; phi' by the modes, of a large system by the lowest of
/// them and the static rest, S K^-1, solved once for all sensors.
class ModalModel final : public ModesOfParameters {
 public:
  /// @param points sensors; @param count modes that at() finds at most
  /// @throws std::invalid_argument as assemble_parametric()
  ModalModel(const fem::Structure& structure, int elements, std::vector<fem::Point> points,
             AskedParameters asked, Eigen::Index count);

  const fem::Structure& structure() const { return structure_; }
  const AskedParameters& asked() const override { return asked_; }
  const fem::ParametricSystem& described() const { return described_; }
  const std::vector<fem::Point>& points() const { return points_; }
  Eigen::Index size() const override { return described_.system.size(); }
  Eigen::Index modes() const override { return count_; }
  bool dense() const override;
  PredictedModes at(const Eigen::VectorXd& values, bool slopes) const override;

  /// The same of all coordinates; of a small system all modes. @throws as at()
  FoundModes found(const Eigen::VectorXd& values, bool slopes) const;

  /// M and K at p, dense. @throws std::invalid_argument when the system is not small.
  std::pair<Eigen::MatrixXd, Eigen::MatrixXd> matrices(const Eigen::VectorXd& values) const;

 private:
  fem::Structure structure_;
  int elements_;
  std::vector<fem::Point> points_;
  AskedParameters asked_;
  Eigen::Index count_;
  fem::ParametricSystem described_;
  std::vector<MatrixSlope> slopes_;       // q
  Eigen::MatrixXd mass_0_, stiffness_0_;  // at p = 0; dense only
};

}  // namespace beamid::experiments
