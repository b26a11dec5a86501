// The sampled motion of modal coordinates, many samples at a time.
#pragma once

#include <Eigen/Core>

#include "fem/response/modal_transition.hpp"

namespace beamid::fem {

/// What is observed of the state x = (z, z') and the inputs f: y = O x + F f.
struct ModalObservation {
  Eigen::MatrixXd state;  ///< O (r x 2k)
  Eigen::MatrixXd input;  ///< F (r x m)
};

/// The states at every L-th sample only, and the L observations that follow each of them as one product
///
///     (y_0 ... y_{L-1}) = (O; O A; ... O A^{L-1}) x + T (f_0 ... f_{L-1}),
///
/// T holding the answers to unit inputs within the block. That is the exact motion with fewer operations, and
/// fewer roundings, than one sample after the other.
class BlockedMotion {
 public:
  BlockedMotion(const ModalBasis& basis, const Eigen::MatrixXd& loads, double interval,
                const ModalObservation& observation);

  static constexpr Eigen::Index length = 32;  ///< L

  /// @param state x at the first sample; becomes that of the sample after the last of these blocks
  /// @param inputs (L m x blocks) f_0 ... f_{L-1} of each block, @param after (m) the input that follows them
  /// @returns (L r x blocks) the observations
  Eigen::MatrixXd advance(Eigen::VectorXd& state, const Eigen::MatrixXd& inputs,
                          const Eigen::VectorXd& after);

  /// States at the beginning of the blocks that were advanced last (2k x blocks).
  const Eigen::MatrixXd& starts() const { return starts_; }

  /// One sample.
  const ModalTransition& transition() const { return step_; }

 private:
  ModalTransition step_, leap_;  // over 1 and over L intervals
  Eigen::MatrixXd observed_;     // O A^j (L r x 2k)
  Eigen::MatrixXd answers_;      // T (L r x L m)
  Eigen::MatrixXd pushed_;       // state after L intervals by f_0 ... f_{L-1} (2k x L m)
  Eigen::MatrixXd starts_;
};

}  // namespace beamid::fem
