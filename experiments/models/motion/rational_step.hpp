// e^(A dt) of second-order motion by diagonal Pade approximants, with the directions in which unknowns move
// what it does to one state.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"

namespace beamid::experiments {

/// x+ = R(A h)^(2^s) x, h = dt / 2^s, for the motion [z, z'] and inputs that are polynomials of the step
/// (StepInput), which enter as further coordinates: a chain of integrators, for the (2,2) Pade step that of
/// the line it takes of them.
///
///     R = Q^-1 P,   P(X) = sum_k b_k X^k,   Q(X) = P(-X)
///
/// Degree and s are chosen by the size of A dt so that R is the exponential to rounding [higham2005], or are
/// 2 and 0: the (2,2) Pade step. The derivative along dA acts on vectors only: with w = R v,
///
///     Q (dR v) = sum_k b_k d(X^k) u_k = sum_i X^i dX c_i,   u_k = v - (-1)^k w,   c_(i-1) = b_i u_i + X c_i
///
/// so that an unknown costs a few products of small matrices for all substeps together, not an exponential of
/// twice the size. Where there are more substeps than coordinates, as at unknowns that a search has thrown
/// far off, dR as a matrix is squared along with R instead.
class RationalStep {
 public:
  enum class Scheme { exponential, pade };

  /// @param frequencies that bring coordinates and rates to one size (r) [rad/s]
  RationalStep(Scheme scheme, double dt, const Eigen::VectorXd& frequencies);

  /// What the scheme takes of inputs that run so over the step: j! p_j (m x (d + 1)); no columns without any.
  /// @param inputs m
  Eigen::MatrixXd chain_of(const Eigen::VectorXd& input, Eigen::Index inputs) const;

  /// Makes R for these equations and inputs. @param chain of chain_of()
  /// @throws std::runtime_error when they are not finite.
  void set(const SecondOrderForm& form, Eigen::MatrixXd chain);

  /// [z, z'] one step later (2r).
  void apply(const Eigen::VectorXd& state, Eigen::VectorXd& next) const;
  /// d next / d [z, z'] (2r x 2r).
  void tangent(Eigen::Ref<Eigen::MatrixXd> matrix) const;
  /// d next / d eta (2r x q) at the state. @param slopes of the form that was set
  void tangent_by_unknowns(const Eigen::VectorXd& state, const std::vector<SecondOrderForm>& slopes,
                           Eigen::Ref<Eigen::MatrixXd> matrix);

 private:
  Scheme scheme_;
  double dt_;
  Eigen::VectorXd scale_;  // of [z, z', chain]: what stands in the scaled vector is state times this
  Eigen::Index r_, size_;  // size_: 2r and the chain's coordinates
  Eigen::MatrixXd chain_;
  int squarings_ = 0;
  std::vector<double> coefficients_;  // b_0 .. b_m
  Eigen::MatrixXd x_, square_, power_, even_, odd_, below_, step_, whole_, spare_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd states_, terms_, forced_, moved_, slope_;
  bool has_whole_slopes_ = false;
  Eigen::MatrixXd whole_slopes_;  // d R^(2^s), one block of columns for each unknown

  void choose_degree(double norm);
  void derive(const Eigen::Ref<const Eigen::MatrixXd>& v, const Eigen::Ref<const Eigen::MatrixXd>& w,
              const std::vector<SecondOrderForm>& slopes);
  void derive_whole(const std::vector<SecondOrderForm>& slopes);
};

}  // namespace beamid::experiments
