#include "reduction/reduction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <stdexcept>

namespace beamid::reduction {

using Eigen::Index, Eigen::MatrixXd;

ReductionRegistry& reduction_registry() {
  static ReductionRegistry registry("reduction");
  return registry;
}

namespace {

// K_r = R^T R. With D = U^T U it is the R of the QR decomposition of U B Phi, so that nothing cancels. Where
// an axial load has made D indefinite there is no U, and R is the Cholesky factor of K_r itself.
MatrixXd stiffness_factor(const fem::StrainFactors& stiffness, const MatrixXd& shapes) {
  const MatrixXd strain = stiffness.strain * shapes;
  const Eigen::SimplicialLLT<fem::SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> rigidity(
      stiffness.rigidity);
  if (rigidity.info() == Eigen::Success) {
    const Eigen::HouseholderQR<MatrixXd> qr(rigidity.matrixU() * strain);
    return qr.matrixQR().topRows(shapes.cols()).triangularView<Eigen::Upper>();
  }
  const Eigen::LLT<MatrixXd> reduced(strain.transpose() * (stiffness.rigidity * strain));
  if (reduced.info() != Eigen::Success)
    throw std::invalid_argument(
        "the reduced stiffness is not positive: the axial load buckles the structure");
  return reduced.matrixU();
}

}  // namespace

ReducedModel project(const fem::StructuralSystem& system, const Bases& bases) {
  const MatrixXd& shapes = bases.shapes;
  const Index n = system.size(), r = shapes.cols();
  if (shapes.rows() != n || r < 1 || r > n)
    throw std::invalid_argument("shapes are " + std::to_string(shapes.rows()) + " x " + std::to_string(r) +
                                "; expected " + std::to_string(n) + " rows and 1 to " + std::to_string(n) +
                                " columns");
  const MatrixXd factor = stiffness_factor(system.stiffness, shapes);
  const auto diagonal = factor.diagonal().array().abs();
  if (!(diagonal.minCoeff() > 1e-13 * diagonal.maxCoeff()))
    throw std::invalid_argument(
        "shapes depend on each other, or one of them moves the structure without strain");

  fem::SparseMatrix identity(r, r);
  identity.setIdentity();
  ReducedModel model;
  model.shapes = shapes;
  model.system.coordinates.resize(r);
  const MatrixXd mass = shapes.transpose() * (system.mass * shapes);
  const MatrixXd damping = shapes.transpose() * (system.damping * shapes);
  model.system.mass = (0.5 * (mass + mass.transpose())).sparseView();
  model.system.damping = (0.5 * (damping + damping.transpose())).sparseView();
  model.system.stiffness = {factor.sparseView(), identity, identity};
  model.system.inputs = MatrixXd(shapes.transpose() * system.inputs).sparseView();
  model.system.outputs = MatrixXd(system.outputs * shapes).sparseView();
  model.system.input_names = system.input_names;
  model.system.output_names = system.output_names;
  for (const fem::NonlinearForce& force : system.nonlinear_forces)
    model.system.nonlinear_forces.push_back({MatrixXd(shapes.transpose() * force.direction).sparseView(),
                                             force.cubic_stiffness, force.quadratic_damping});
  return model;
}

ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction,
                    const Training& training) {
  return project(system, reduction.bases(system, training));
}

}  // namespace beamid::reduction
