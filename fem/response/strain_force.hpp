// The elastic forces of a motion, with the digits of the strain factors.
#pragma once

#include <Eigen/Core>

#include "fem/response/diagonal_product.hpp"

namespace beamid::fem {

/// K q as B^T (D (B q)): the strains of a smooth motion of a fine mesh are small differences, which the
/// entries 0 and
/// +-1 of B take exactly and an assembled K loses. Keeps its work space.
class StrainForce {
 public:
  explicit StrainForce(const StrainFactors& stiffness)
      : strain_(stiffness.strain), rigidity_(stiffness.rigidity), equilibrium_(stiffness.strain.transpose()) {
    strains_.resize(stiffness.strain.rows());
    natural_.resize(stiffness.strain.rows());
  }

  /// force (n) -= K q.
  void subtract(const Eigen::VectorXd& q, Eigen::VectorXd& force) {
    strains_.setZero();
    strain_.add(q, strains_);
    natural_.setZero();
    rigidity_.add(strains_, natural_);
    equilibrium_.subtract(natural_, force);
  }

 private:
  DiagonalProduct strain_, rigidity_, equilibrium_;  // B, D, B^T
  Eigen::VectorXd strains_, natural_;
};

}  // namespace beamid::fem
