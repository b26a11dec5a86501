// The step of second-order motion, and its derivatives, where the unknowns stay from sample to sample.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/models/motion/rational_step.hpp"

namespace beamid::experiments {

/// Linear in the motion x = [z, z'] and in the chain of the inputs (RationalStep::chain_of):
///
///     x+ = F [x; vec chain],   d x+ / d eta_j = F_j [x; vec chain]
///
/// Made of one step of each unit vector: output error, which walks a whole record at the same unknowns, takes
/// a product with F and F_j for every sample instead of the sums of rational_step.hpp.
class HeldStep {
 public:
  /// Steps of unit vectors that F and F_j take (columns).
  static Eigen::Index columns(const SecondOrderForm& form, Eigen::Index powers) {
    return 2 * form.stiffness.rows() + form.inputs.cols() * powers;
  }

  /// @param step which is set to other inputs afterwards
  /// @param powers d + 1 of the inputs; 0 without any
  HeldStep(RationalStep& step, const SecondOrderForm& form, const std::vector<SecondOrderForm>& slopes,
           Eigen::Index powers);

  bool takes(const Eigen::MatrixXd& chain) const { return chain.cols() == powers_; }
  /// @param state begins with x, as `next` does @param tangent d x+ / d x (2r x 2r)
  /// @param by_unknowns d x+ / d eta (2r x q)
  void step(const Eigen::VectorXd& state, const Eigen::MatrixXd& chain, Eigen::VectorXd& next,
            Eigen::Ref<Eigen::MatrixXd> tangent, Eigen::Ref<Eigen::MatrixXd> by_unknowns);

 private:
  Eigen::Index moving_, powers_;
  Eigen::MatrixXd value_, slope_;  // F (2r x columns), F_j one below the other
  Eigen::VectorXd joined_, sloped_;
};

}  // namespace beamid::experiments
