// Systems of few coordinates whose motion is known in closed form.
#pragma once

#include <Eigen/LU>
#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::test {

inline fem::SparseMatrix sparse(const Eigen::MatrixXd& matrix) {
  return matrix.sparseView();
}

/// Masses m_i [kg] in a row from the ground on, spring k_i [N/m] and dashpot c_i [N s/m] before each. Inputs:
/// a force on the last mass, and the acceleration of the base. Output: displacement of the last mass.
inline fem::StructuralSystem chain(const std::vector<double>& masses, const std::vector<double>& springs,
                                   const std::vector<double>& dashpots) {
  const auto n = static_cast<Eigen::Index>(masses.size());
  const auto diagonal = [n](const std::vector<double>& values) {
    return Eigen::MatrixXd(Eigen::Map<const Eigen::VectorXd>(values.data(), n).asDiagonal());
  };
  Eigen::MatrixXd strain = Eigen::MatrixXd::Identity(n, n);
  strain.diagonal<-1>().setConstant(-1.0);
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(n, 2), outputs = Eigen::MatrixXd::Zero(1, n);
  inputs(n - 1, 0) = outputs(0, n - 1) = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) inputs(i, 1) = -masses[i];
  fem::StructuralSystem system;
  system.coordinates.resize(n);
  system.mass = sparse(diagonal(masses));
  system.damping = sparse(strain.transpose() * diagonal(dashpots) * strain);
  system.stiffness = {sparse(strain), sparse(diagonal(springs)), sparse(diagonal(springs).inverse())};
  system.inputs = sparse(inputs);
  system.outputs = sparse(outputs);
  system.input_names = {"force", "base_acceleration"};
  system.output_names = {"displacement"};
  return system;
}

/// m x'' + c x' + k x = f.
inline fem::StructuralSystem oscillator(double mass, double stiffness, double dashpot = 0.0) {
  return chain({mass}, {stiffness}, {dashpot});
}

inline Eigen::VectorXd one(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

/// Largest |a - b| over the largest |b|.
inline double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

}  // namespace beamid::test
