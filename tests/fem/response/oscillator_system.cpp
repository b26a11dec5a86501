#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::test {

fem::SparseMatrix sparse(const Eigen::MatrixXd& matrix) {
  return matrix.sparseView();
}

fem::StructuralSystem chain(const std::vector<double>& masses, const std::vector<double>& springs,
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

fem::StructuralSystem oscillator(double mass, double stiffness, double dashpot) {
  return chain({mass}, {stiffness}, {dashpot});
}

Eigen::VectorXd one(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

double relative_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

}  // namespace beamid::test
