// Small linear motion with unknowns, as filters take it:
//
//     z'' = B f - D z' - W z,    state [z, z', (b, d) of drifting sensors, eta, b of the others]
//
// Observed are displacements and strains h z, velocities h z' and absolute accelerations h z'' + a_base + b,
// in any mix.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/models/motion/parametric_motion.hpp"
#include "filters/continuous_model.hpp"

namespace beamid::experiments {

/// W, D and B at some values of the unknowns.
struct SecondOrderForm {
  Eigen::MatrixXd stiffness;  ///< W = M^-1 K (r x r)
  Eigen::MatrixXd damping;    ///< D = M^-1 C (r x r)
  Eigen::MatrixXd inputs;     ///< B = M^-1 E (r x m)
  Eigen::MatrixXd rows;       ///< h (p x r) where what sensors read depends on the unknowns too; else empty
};

/// z'' + D z' + W z = B u, with matrices that depend on the unknowns.
class SecondOrderMotion : public filters::LinearMotion {
 public:
  /// @param rows what the observations read of the coordinates (p x r), at the guess
  /// @param name of the coordinates in labels
  /// @throws std::invalid_argument when sizes do not fit, or an observation is a force.
  SecondOrderMotion(MotionDescription description, Eigen::MatrixXd rows, std::string name);

  /// The equations at a state's unknowns and, where asked for, their derivatives by every eta_j (q).
  /// @throws std::runtime_error when the unknowns are impossible (no mass left).
  virtual void evaluate(const Eigen::VectorXd& state, SecondOrderForm& form,
                        std::vector<SecondOrderForm>* slopes) const = 0;
  /// Whether W and D are diagonal for all values of the unknowns: then every coordinate is an oscillator of
  /// its own.
  virtual bool decoupled() const = 0;
  /// Whether its motion without inputs is one in modes; not where points move as they are told.
  virtual bool has_modes_of_its_own() const { return true; }
  /// Typical omega (r) [rad/s], by which coordinates and rates are brought to one size; positive.
  virtual Eigen::VectorXd frequencies() const = 0;

  const MotionDescription& description() const { return description_; }
  const StateLayout& layout() const { return layout_; }
  const Eigen::MatrixXd& rows() const { return rows_; }

  /// @param input which begins with the inputs at this instant
  void read(const Eigen::VectorXd& state, const Eigen::VectorXd& input, const SecondOrderForm& form,
            Eigen::VectorXd& output) const;
  void read_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input, const SecondOrderForm& form,
                     const std::vector<SecondOrderForm>& slopes, Eigen::MatrixXd& jacobian) const;

  Eigen::Index input_size() const override { return static_cast<Eigen::Index>(description_.forces.size()); }
  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;
  Eigen::Index motion_size() const override { return layout_.motion; }
  Eigen::Index parameter_size() const override { return layout_.size - layout_.motion; }
  void motion_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void motion_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                                Eigen::MatrixXd& matrix) const override;
  void input_matrix(const Eigen::VectorXd& state, Eigen::MatrixXd& matrix) const override;
  void input_matrix_derivative(const Eigen::VectorXd& state, Eigen::Index j,
                               Eigen::MatrixXd& matrix) const override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) const override;
  /// `exponential` and `pade` without matrices of the whole state (second_order_step.hpp).
  std::unique_ptr<filters::DiscreteModel> structured(double dt, const std::string& scheme,
                                                     const filters::Noise& noise) const override;

 private:
  MotionDescription description_;
  Eigen::MatrixXd rows_;
  std::string name_;
  StateLayout layout_;

  virtual std::shared_ptr<const SecondOrderMotion> copy() const = 0;
};

// Motion of a reduced model whose matrices are affine in the unknown properties of the beam.

/// M, K and E at p_0 and their derivatives, in r coordinates in which M and K are diagonal at p_0.
struct ReducedEquations {
  Eigen::VectorXd mass, stiffness;  ///< diagonals at p_0 (r)
  Eigen::MatrixXd damping;          ///< C_0: dashpots (r x r)
  Eigen::MatrixXd inputs;           ///< E (r x m)

  struct Derivative {
    Eigen::MatrixXd mass, stiffness;  ///< M_j, K_j (r x r)
    Eigen::MatrixXd inputs;           ///< E_j (r x m)
    Eigen::MatrixXd damping = {};     ///< C_j (r x r); empty: zero
  };
  std::vector<Derivative> derivatives;  ///< a
};

/// The damping of each mode of positive frequency, for MotionDescription::damped_modes; their ratios and
/// unknowns are left to the caller.
std::vector<DampedMode> damped_modes(const ReducedEquations& equations);

/// Motion of a reduced model.
class ReducedMotion final : public SecondOrderMotion {
 public:
  /// @param rows what the observations read (p x r)
  ReducedMotion(ReducedEquations equations, MotionDescription description, Eigen::MatrixXd rows,
                std::string name);

  void evaluate(const Eigen::VectorXd& state, SecondOrderForm& form,
                std::vector<SecondOrderForm>* slopes) const override;
  bool decoupled() const override { return decoupled_; }
  Eigen::VectorXd frequencies() const override;

 private:
  ReducedEquations equations_;
  bool decoupled_ = false;

  std::shared_ptr<const SecondOrderMotion> copy() const override {
    return std::make_shared<ReducedMotion>(*this);
  }
};

}  // namespace beamid::experiments
