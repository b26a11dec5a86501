// The whole mesh with unknowns as dense matrices, written down as in a textbook: the oracle of the banded
// one.
#pragma once

#include <Eigen/Cholesky>
#include <utility>

#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"
#include "filters/continuous_model.hpp"

namespace beamid::test {

/// z = [q, q', drifting offsets, eta, constant offsets] with A = [0 I; -M^-1 K, -M^-1 C].
class DenseContinuum final : public filters::LinearMotion {
 public:
  DenseContinuum(fem::ParametricSystem equations, experiments::MotionDescription description)
      : equations_(std::move(equations)),
        description_(std::move(description)),
        layout_(layout(description_, equations_.system.size())) {}

  Eigen::Index input_size() const override { return static_cast<Eigen::Index>(description_.forces.size()); }
  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;
  Eigen::Index motion_size() const override { return layout_.motion; }
  Eigen::Index parameter_size() const override { return layout_.size - layout_.motion; }

  struct Matrices {
    Eigen::MatrixXd mass, damping, stiffness, inputs;
  };
  Matrices matrices(const Eigen::VectorXd& state) const;
  /// d/dp of the physical value of unknown j.
  Matrices slopes(const Eigen::VectorXd& state, Eigen::Index j) const;

  void motion_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void motion_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                Eigen::MatrixXd& matrix) const override;
  void input_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void input_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                               Eigen::MatrixXd& matrix) const override;

  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const override;
  /// As rows of the derivative of A x + B u.
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) const override;

 private:
  fem::ParametricSystem equations_;
  experiments::MotionDescription description_;
  experiments::StateLayout layout_;

  Eigen::MatrixXd chosen(const fem::SparseMatrix& matrix) const;
};

/// The damped modes of a description: the first `ratios.size()` modes of the equations at p_0.
std::vector<experiments::DampedMode> damped_modes(const fem::ParametricSystem& equations,
                                                  const std::vector<double>& ratios);

}  // namespace beamid::test
