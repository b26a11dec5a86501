// Static solutions of a chain by sweeps along it.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "fem/solvers/rigid_motions.hpp"
#include "fem/solvers/strain_sweeps.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// The force method [argyris1979] on the sweeps of strain_sweeps.hpp. With F = D^-1, redundant forces N_r and
/// kept gauges q_k, equilibrium and compatibility are
///
///     N_d = B_d^-T (f_d - R_d^T N_r),     q_d = B_d^-1 ((F N)_d - B_k q_k)
///
/// and what remains is one equation per redundant, which closes its gap, and one per kept gauge, which
/// balances it:
///
///     [ X^T F X  -W ] [ N_r ]   [ R q - (F N)_r ]
///     [   W^T     0 ] [ q_k ] = [ f_k - B_k^T N ]     (right: at N_r = 0, q_k = 0)
///
/// X being the self-equilibrated natural forces of unit redundants. A solve takes a sweep each way, two where
/// anything is redundant.
class ChainSolver {
 public:
  /// Whether gauges and redundants are so few that the sweeps are worth it.
  static bool suits(const StrainSweeps& sweeps);

  ChainSolver(const StrainFactors& stiffness, StrainSweeps sweeps, const RigidMotions& rigid);

  /// q (n) and N (s) of the load f (n).
  void solve(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
             Eigen::Ref<Eigen::VectorXd> natural_forces) const;

  /// The same to the last digits, at twice the time: forces are swept again with the redundants known, sums
  /// carry their rounding errors, and a second round of the small system closes the gaps that the first has
  /// left.
  void solve_carefully(Eigen::Ref<const Eigen::VectorXd> f, Eigen::Ref<Eigen::VectorXd> coordinates,
                       Eigen::Ref<Eigen::VectorXd> natural_forces) const;

 private:
  StrainSweeps sweeps_;
  RepeatedRows flexibility_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> redundant_;  // R
  std::vector<int> kept_;
  Eigen::VectorXd scale_;  // of the small system's rows and columns
  Eigen::FullPivLU<Eigen::MatrixXd> small_;

  Eigen::MatrixXd unit_coordinates_, unit_forces_;  // per unknown of the small system; empty where too many

  void find_forces(Eigen::Ref<const Eigen::VectorXd> f, const Eigen::VectorXd& redundant_forces,
                   Eigen::Ref<Eigen::VectorXd> scratch, Eigen::Ref<Eigen::VectorXd> natural_forces) const;
  void find_coordinates(const Eigen::Ref<const Eigen::VectorXd>& natural_forces,
                        const Eigen::VectorXd& kept_values, Eigen::Ref<Eigen::VectorXd> coordinates) const;
  Eigen::VectorXd gaps(const Eigen::Ref<const Eigen::VectorXd>& coordinates,
                       const Eigen::Ref<const Eigen::VectorXd>& natural_forces) const;
  Eigen::VectorXd unknowns(const Eigen::VectorXd& right) const;
  void add_responses(const Eigen::VectorXd& unknowns, Eigen::Ref<Eigen::VectorXd> coordinates,
                     Eigen::Ref<Eigen::VectorXd> natural_forces) const;
};

}  // namespace beamid::fem
