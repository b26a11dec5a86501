#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "fem/solvers/rigid_complement.hpp"
#include "fem/stiffness_solver.hpp"
#include "reduction/reduction.hpp"

namespace beamid::reduction {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double dependent = 1e-12;  // what is left of a shape of length 1 when the others are taken off

// Least share of the other shapes in a rigid-body motion, about what rounding has left of it. The static
// solver weighs a load's work in that motion against the terms that cancel in it, and would never find it in
// balance if there were but one term.
constexpr double least_share = 1e-16;

// Which columns are independent, and the others as combinations of them.
struct Dependence {
  std::vector<Index> independent, rest;
  MatrixXd combination;  // columns(rest) = columns(independent) X
};

Dependence dependence(const MatrixXd& columns, const Eigen::VectorXd& lengths) {
  const Eigen::VectorXd scale = lengths.cwiseMax(1e-300).cwiseInverse();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns * scale.asDiagonal());
  const auto& order = qr.colsPermutation().indices();
  const Index r = columns.cols();
  Index rank = 0;
  while (rank < std::min(r, columns.rows()) && std::abs(qr.matrixQR()(rank, rank)) > dependent) ++rank;
  Dependence result;
  for (Index j = 0; j < r; ++j) (j < rank ? result.independent : result.rest).push_back(order[j]);
  const MatrixXd& factor = qr.matrixQR();
  result.combination.resize(rank, r - rank);
  if (rank == r) return result;
  result.combination = factor.topLeftCorner(rank, rank)
                           .triangularView<Eigen::Upper>()
                           .solve(factor.topRightCorner(rank, r - rank));
  for (Index i = 0; i < rank; ++i)
    for (Index j = 0; j < r - rank; ++j) {
      double& share = result.combination(i, j);
      share = std::copysign(std::max(std::abs(share), least_share), share) * scale[order[i]] /
              scale[order[rank + j]];
    }
  return result;
}

// Shapes without what they have of rigid-body motion, which would drown small strains in rounding.
MatrixXd elastic_part(const fem::StructuralSystem& system, const MatrixXd& motions, MatrixXd shapes) {
  const fem::RigidComplement complement(system.mass, motions);
  for (int pass = 0; pass < 2; ++pass)
    for (Index j = 0; j < shapes.cols(); ++j) complement.project_motion(shapes.col(j));
  return shapes;
}

// R of K_r = R^T R for shapes of which no combination is without strain. With D = U^T U it is the R of the QR
// decomposition of U B Phi, so that nothing cancels. Where an axial load has made D indefinite there is no U,
// and R is the Cholesky factor of K_r itself.
MatrixXd triangular_factor(const fem::StrainFactors& stiffness, const MatrixXd& shapes) {
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

// Rows from the last to the first: in this order each determines one coordinate, as the static solver likes
// it (fem/solvers/strain_sweeps.hpp).
MatrixXd strain_factor(const fem::StructuralSystem& system, const MatrixXd& shapes) {
  const Index r = shapes.cols();
  const MatrixXd motions = fem::StiffnessSolver(system.stiffness).rigid_motions();
  if (motions.cols() == 0) return triangular_factor(system.stiffness, shapes).colwise().reverse();
  const MatrixXd elastic = elastic_part(system, motions, shapes);
  const Dependence found = dependence(elastic, shapes.colwise().norm().transpose());
  const auto rank = static_cast<Index>(found.independent.size());
  if (rank == 0) return MatrixXd(0, r);
  const MatrixXd factor = triangular_factor(system.stiffness, elastic(Eigen::all, found.independent));
  MatrixXd strain(rank, r);
  strain(Eigen::all, found.independent) = factor;
  strain(Eigen::all, found.rest) = factor * found.combination;
  return strain.colwise().reverse();
}

void check(const fem::StructuralSystem& system, const MatrixXd& shapes) {
  const Index n = system.size(), r = shapes.cols();
  if (shapes.rows() != n || r < 1 || r > n)
    throw std::invalid_argument("shapes are " + std::to_string(shapes.rows()) + " x " + std::to_string(r) +
                                "; expected " + std::to_string(n) + " rows and 1 to " + std::to_string(n) +
                                " columns");
  if (!shapes.allFinite()) throw std::invalid_argument("shapes are not finite");
  const auto rank =
      static_cast<Index>(dependence(shapes, shapes.colwise().norm().transpose()).independent.size());
  if (rank < r)
    throw std::invalid_argument("shapes depend on each other: " + std::to_string(rank) + " of " +
                                std::to_string(r) + " are independent");
}

fem::SparseMatrix symmetric(const MatrixXd& matrix) {
  return (0.5 * (matrix + matrix.transpose())).sparseView();
}

}  // namespace

ReducedModel project(const fem::StructuralSystem& system, const Bases& bases) {
  if (bases.identity) return {system, {}, true};
  const MatrixXd& shapes = bases.shapes;
  check(system, shapes);
  const MatrixXd strain = strain_factor(system, shapes);
  fem::SparseMatrix identity(strain.rows(), strain.rows());
  identity.setIdentity();

  ReducedModel model;
  model.shapes = shapes;
  fem::StructuralSystem& reduced = model.system;
  reduced.coordinates.resize(shapes.cols());
  reduced.mass = symmetric(shapes.transpose() * (system.mass * shapes));
  reduced.damping = symmetric(shapes.transpose() * (system.damping * shapes));
  reduced.stiffness = {strain.sparseView(), identity, identity};
  reduced.inputs = MatrixXd(shapes.transpose() * system.inputs).sparseView();
  reduced.outputs = MatrixXd(system.outputs * shapes).sparseView();
  reduced.input_names = system.input_names;
  reduced.output_names = system.output_names;
  for (const fem::NonlinearForce& force : system.nonlinear_forces)
    reduced.nonlinear_forces.push_back({MatrixXd(shapes.transpose() * force.direction).sparseView(),
                                        force.cubic_stiffness, force.quadratic_damping});
  return model;
}

}  // namespace beamid::reduction
