// Motion of a reduced model whose matrices are affine in the unknown properties of the beam.
#pragma once

#include <string>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"

namespace beamid::experiments {

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
