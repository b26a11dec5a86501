// What sensors read of the whole mesh, and its derivatives, in O(n).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "experiments/models/banded/banded_equations.hpp"
#include "experiments/models/banded/step_factor.hpp"

namespace beamid::experiments::banded {

/// Rows of the observations. Those of coordinates and rates are constant; an acceleration is
///
///     y = g^T (E f - C q' - K q) + base acceleration + bias,    M(p) g = h
///
/// with g from M(p_0)^-1 by the few entries that M(p) - M(p_0) has [woodbury1950], and by a factor of M(p)
/// where it has more.
///
/// An acceleration read at a point takes the rounding errors of q times the square of the mesh's highest
/// frequency, which grows with the fourth power of the number of elements. On meshes finer than that allows,
/// h is smoothed once, with omega_c = `cut_off` times the lowest natural frequency,
///
///     h <- M Re (M + i K / omega_c^2)^-1 h,    a mode of frequency omega reads 1 / (1 + (omega/omega_c)^4)
///
/// of its acceleration.
class ContinuumSensors {
 public:
  ContinuumSensors(const fem::ParametricSystem& equations, const MotionDescription& description,
                   const StateLayout& layout);

  static constexpr double cut_off = 3000.0;
  bool smooths() const { return smooths_; }

  /// Takes the values that the equations hold now.
  void set(const BandedEquations& equations);

  /// y (p) of a state.
  void output(const BandedEquations& equations, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const;
  /// dy/dz (p x size of the state). @param slopes dp/deta of the unknowns (q)
  void jacobian(const BandedEquations& equations, const Eigen::VectorXd& slopes, const Eigen::VectorXd& state,
                const Eigen::VectorXd& input, Eigen::MatrixXd& jacobian) const;

 private:
  void smooth(const fem::StructuralSystem& system);
  void take_mass(const BandedEquations& equations);
  void gather_receptance();
  struct Motion;  // a state, and what is asked of it more than once
  Eigen::VectorXd by_drive(const BandedEquations& equations, Eigen::Index unknown, Motion& motion) const;
  Eigen::VectorXd by_property(const BandedEquations& equations, Eigen::Index j, Motion& motion) const;
  const Eigen::VectorXd& accelerations(const BandedEquations& equations, Motion& motion) const;

  static constexpr std::size_t most_entries = 24;  // that M(p) - M(p_0) may have rows

  MotionDescription description_;
  StateLayout layout_;
  Eigen::Index size_;
  Eigen::MatrixXd rows_;               // h (n x p)
  std::vector<Eigen::Index> sensors_;  // of acceleration: observations (k)
  bool smooths_ = false;
  bool mass_changes_everywhere_ = false;
  Eigen::MatrixXd reference_;   // M(p_0)^-1 [h, unit vectors of the entries that M_j touch] (n x (k + s))
  Eigen::MatrixXd receptance_;  // the same at p
  std::optional<StepFactor> mass_factor_;  // of M(p), instead of the unit vectors; s = 0
  std::vector<Complex> mass_entries_;
  Eigen::MatrixXd by_motion_, by_rate_;               // -K g and -C g (n x k)
  Eigen::MatrixXd modes_seen_;                        // g_i^T g of the damped modes (modes x k)
  std::vector<std::vector<Lanes>> receptance_lanes_;  // g, four sensors at a time
};

}  // namespace beamid::experiments::banded
