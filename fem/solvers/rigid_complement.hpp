// Everything but rigid-body motion.
#pragma once

#include <Eigen/Core>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Rigid-body modes R (n x k, R^T M R = I) and the projections that take them out of motions and loads,
///
///     q - R R^T M q,     f - M R R^T f.
class RigidComplement {
 public:
  /// @param motions basis of the rigid-body motions (n x k).
  /// @throws std::runtime_error when one of them has no mass.
  RigidComplement(const SparseMatrix& mass, Eigen::MatrixXd motions);

  const Eigen::MatrixXd& modes() const { return modes_; }
  Eigen::Index count() const { return modes_.cols(); }

  void project_motion(Eigen::Ref<Eigen::VectorXd> motion) const {
    if (count() > 0) motion.noalias() -= modes_ * (loads_.transpose() * motion).eval();
  }
  void project_load(Eigen::Ref<Eigen::VectorXd> load) const {
    if (count() > 0) load.noalias() -= loads_ * (modes_.transpose() * load).eval();
  }

 private:
  Eigen::MatrixXd modes_, loads_;  // R and M R
};

}  // namespace beamid::fem
