#include "fem/mode_curves.hpp"

#include <Eigen/SparseLU>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// [F, M phi; (M phi)^T, 0].
SparseMatrix bordered(const SparseMatrix& inner, const VectorXd& border) {
  const Index n = inner.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < inner.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(inner, column); entry; ++entry)
      entries.emplace_back(entry.row(), entry.col(), entry.value());
  for (Index i = 0; i < n; ++i) {
    entries.emplace_back(i, n, border[i]);
    entries.emplace_back(n, i, border[i]);
  }
  SparseMatrix result(n + 1, n + 1);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// K_j phi and M_j phi of all parameters, which every mode needs.
struct ParameterMatrices {
  std::vector<SparseMatrix> stiffness, mass;  ///< q
};

ModeCurve curve_of(const ParametricSystem& equations, const ParameterMatrices& by,
                   const SparseMatrix& stiffness, double square, const VectorXd& shape) {
  const SparseMatrix &mass = equations.system.mass, &outputs = equations.system.outputs;
  const Index n = shape.size(), q = equations.values.size(), p = outputs.rows();
  const VectorXd momentum = mass * shape;
  // Both parts of a size: the border as large as F is.
  const double scale = square * momentum.norm() / momentum.squaredNorm();
  Eigen::SparseLU<SparseMatrix> solver;
  solver.compute(bordered(stiffness - square * mass, scale * momentum));
  if (solver.info() != Eigen::Success)
    throw std::runtime_error("a mode at omega^2 = " + std::to_string(square) +
                             " shares its frequency with another: its shape has no derivative");
  const auto solve = [&](const VectorXd& force, double along) -> VectorXd {
    VectorXd right(n + 1);
    right << force, scale * along;
    return solver.solve(right).head(n);
  };

  ModeCurve curve{square,         VectorXd(q),
                  MatrixXd(q, q), outputs * shape,
                  MatrixXd(p, q), std::vector<MatrixXd>(static_cast<std::size_t>(p), MatrixXd(q, q))};
  MatrixXd stiff(n, q), heavy(n, q), shapes(n, q);  // K_j phi, M_j phi, phi_j
  for (Index j = 0; j < q; ++j) {
    stiff.col(j) = by.stiffness[static_cast<std::size_t>(j)] * shape;
    heavy.col(j) = by.mass[static_cast<std::size_t>(j)] * shape;
    curve.square_slope[j] = shape.dot(stiff.col(j) - square * heavy.col(j));
    const VectorXd turned = stiff.col(j) - square * heavy.col(j) - curve.square_slope[j] * momentum;
    shapes.col(j) = solve(-turned, -0.5 * shape.dot(heavy.col(j)));
  }
  curve.reading_slope = outputs * shapes;

  const VectorXd& slope = curve.square_slope;
  const auto turn = [&](Index j, const VectorXd& on) -> VectorXd {  // F_j on a shape
    return by.stiffness[static_cast<std::size_t>(j)] * on -
           square * (by.mass[static_cast<std::size_t>(j)] * on) - slope[j] * (mass * on);
  };
  for (Index j = 0; j < q; ++j)
    for (Index l = 0; l <= j; ++l) {
      const double bend =
          2.0 * shapes.col(l).dot(stiff.col(j) - square * heavy.col(j)) - slope[l] * shape.dot(heavy.col(j));
      const VectorXd force = turn(j, shapes.col(l)) + turn(l, shapes.col(j)) - bend * momentum -
                             slope[j] * heavy.col(l) - slope[l] * heavy.col(j);
      const double along = -shapes.col(l).dot(mass * shapes.col(j)) - heavy.col(l).dot(shapes.col(j)) -
                           heavy.col(j).dot(shapes.col(l));
      const VectorXd reading = outputs * solve(-force, along);
      curve.square_curvature(j, l) = curve.square_curvature(l, j) = bend;
      for (Index i = 0; i < p; ++i) {
        MatrixXd& curvature = curve.reading_curvature[static_cast<std::size_t>(i)];
        curvature(j, l) = curvature(l, j) = reading[i];
      }
    }
  return curve;
}

}  // namespace

std::vector<ModeCurve> mode_curves(const ParametricSystem& equations, const Modes& modes) {
  if (modes.rigid > 0)
    throw std::invalid_argument(std::to_string(modes.rigid) +
                                " rigid modes; expected a structure that is held");
  ParameterMatrices by;
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j) {
    by.stiffness.push_back(equations.stiffness_derivative(j));
    by.mass.push_back(equations.derivatives[j].mass);
  }
  const SparseMatrix stiffness = equations.system.stiffness.assembled();
  std::vector<ModeCurve> curves;
  for (Index i = 0; i < modes.size(); ++i) {
    const double omega = modes.angular_frequency[i];
    curves.push_back(curve_of(equations, by, stiffness, omega * omega, modes.shape.col(i)));
  }
  return curves;
}

}  // namespace beamid::fem
