#include "fem/matrix_system.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "fem/parametric_system.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double same_entry = 1e-9;    // of K_ij and K_ji, over the largest entry
constexpr double least_pivot = 1e-13;  // over the diagonal entry it is left of

[[noreturn]] void refuse_system(const std::string& message) {
  throw std::invalid_argument(message);
}

void check_matrix(const SparseMatrix& matrix, const std::string& name, Index n) {
  std::ostringstream message;
  if (matrix.rows() != n || matrix.cols() != n) {
    message << name << " is " << matrix.rows() << " x " << matrix.cols() << "; expected " << n << " x " << n
            << " as the mass matrix";
    refuse_system(message.str());
  }
  double largest = 0.0;
  for (Index k = 0; k < matrix.outerSize(); ++k)
    for (SparseMatrix::InnerIterator entry(matrix, k); entry; ++entry) {
      if (!std::isfinite(entry.value())) {
        message << name << ": entry (" << entry.row() + 1 << ", " << entry.col() + 1
                << ") is not finite; expected a number";
        refuse_system(message.str());
      }
      largest = std::max(largest, std::abs(entry.value()));
    }
  for (Index k = 0; k < matrix.outerSize(); ++k)
    for (SparseMatrix::InnerIterator entry(matrix, k); entry; ++entry)
      if (const double other = matrix.coeff(entry.col(), entry.row());
          std::abs(other - entry.value()) > same_entry * largest) {
        message << name << ": entry (" << entry.row() + 1 << ", " << entry.col() + 1 << ") is "
                << entry.value() << " and (" << entry.col() + 1 << ", " << entry.row() + 1 << ") is " << other
                << "; expected a symmetric matrix";
        refuse_system(message.str());
      }
}

// A_0 + sum_j theta_j A_j
SparseMatrix at_values(const MatrixSystem& system, SparseMatrix MatrixSystem::*constant,
                       SparseMatrix MatrixSystem::Parameter::*part) {
  const Index n = system.size();
  SparseMatrix sum = (system.*constant).rows() == n ? system.*constant : SparseMatrix(n, n);
  for (const MatrixSystem::Parameter& parameter : system.parameters)
    if ((parameter.*part).nonZeros() > 0) sum += parameter.value * (parameter.*part);
  return sum;
}

SparseMatrix identity(Index n) {
  SparseMatrix one(n, n);
  one.setIdentity();
  return one;
}

// Rows of L^T P from the last one up: each determines one more coordinate, as the solver wants it.
StrainFactors cholesky_factors(const MatrixSystem& system, const SparseMatrix& stiffness) {
  const Index n = stiffness.rows();
  const Eigen::SimplicialLLT<SparseMatrix> cholesky(stiffness);
  const auto refuse_motion = [](const std::string& which) {
    refuse_system("the stiffness matrix is not positive definite" + which +
                  ": the structure can move without strain, or is unstable; expected one that is held");
  };
  if (cholesky.info() != Eigen::Success) refuse_motion("");
  const SparseMatrix lower = cholesky.matrixL();
  const auto& order = cholesky.permutationPinv().indices();  // place in the factor -> coordinate
  Triplets entries;
  for (Index k = 0; k < n; ++k)
    for (SparseMatrix::InnerIterator entry(lower, k); entry; ++entry) {
      const int coordinate = order[entry.row()];
      if (entry.row() == k &&
          entry.value() * entry.value() < least_pivot * stiffness.coeff(coordinate, coordinate))
        refuse_motion(" at unknown '" + system.labels[static_cast<std::size_t>(coordinate)] + "'");
      entries.emplace_back(static_cast<int>(n - 1 - k), coordinate, entry.value());
    }
  return {sparse(n, n, entries), identity(n), identity(n)};
}

const MatrixSystem::Parameter& named(const MatrixSystem& system, const BeamParameter& parameter) {
  std::string known;
  for (const MatrixSystem::Parameter& one : system.parameters) {
    if (parameter.quantity == BeamParameter::Quantity::factor && one.name == parameter.name) return one;
    known += (known.empty() ? "" : ", ") + one.name;
  }
  refuse_system(parameter.quantity == BeamParameter::Quantity::factor
                    ? "the system has no factor '" + parameter.name +
                          "'; expected one of: " + (known.empty() ? "none, it has no parameters" : known)
                    : "a system of matrices has no such quantity; expected factor, with a name");
}

}  // namespace

void validate(const MatrixSystem& system) {
  const Index n = system.size();
  if (n == 0) refuse_system("the mass matrix is empty; expected one row and column for each unknown");
  check_matrix(system.mass, "mass", n);
  check_matrix(system.stiffness, "stiffness", n);
  if (system.damping.size() > 0) check_matrix(system.damping, "damping", n);
  std::set<std::string> names, labels;
  for (const MatrixSystem::Parameter& parameter : system.parameters) {
    if (!names.insert(parameter.name).second)
      refuse_system("two parameters are called '" + parameter.name + "'; expected different names");
    for (const auto& [matrix, what] : {std::pair{&parameter.mass, "mass"},
                                       {&parameter.damping, "damping"},
                                       {&parameter.stiffness, "stiffness"}})
      if (matrix->size() > 0) check_matrix(*matrix, std::string(what) + " of " + parameter.name, n);
  }
  if (static_cast<Index>(system.labels.size()) != n)
    refuse_system(std::to_string(system.labels.size()) + " labels for " + std::to_string(n) +
                  " unknowns; expected one for each");
  for (const std::string& label : system.labels)
    if (!labels.insert(label).second)
      refuse_system("two unknowns are called '" + label + "'; expected different labels");
  if (system.base_motion.size() > 0 && system.base_motion.size() != n)
    refuse_system(std::to_string(system.base_motion.size()) + " numbers of base_motion for " +
                  std::to_string(n) + " unknowns; expected one for each");
}

StructuralSystem assemble(const MatrixSystem& system, const std::vector<Point>& points) {
  validate(system);
  const Index n = system.size(), count = static_cast<Index>(points.size());
  StructuralSystem result;
  for (int i = 0; i < n; ++i) result.coordinates.push_back({Coordinate::Kind::deflection, 0.0, 1.0, i});
  result.mass = at_values(system, &MatrixSystem::mass, &MatrixSystem::Parameter::mass);
  result.damping = at_values(system, &MatrixSystem::damping, &MatrixSystem::Parameter::damping);
  result.stiffness = cholesky_factors(
      system, at_values(system, &MatrixSystem::stiffness, &MatrixSystem::Parameter::stiffness));
  Triplets inputs, outputs;
  result.base_shares.setZero(count);
  for (Index i = 0; i < count; ++i) {
    const Point& point = points[static_cast<std::size_t>(i)];
    const auto label = std::find(system.labels.begin(), system.labels.end(), point.place);
    if (label == system.labels.end())
      refuse_system("the system has no unknown '" + point.place + "'; expected one of its labels, " +
                    system.labels.front() + " to " + system.labels.back());
    const auto unknown = static_cast<int>(label - system.labels.begin());
    inputs.emplace_back(unknown, static_cast<int>(i), 1.0);
    outputs.emplace_back(static_cast<int>(i), unknown, 1.0);
    result.input_names.push_back(point.name + "_force");
    result.output_names.push_back(point.name + "_displacement");
    if (system.base_motion.size() > 0) result.base_shares[i] = system.base_motion[unknown];
  }
  if (system.base_motion.size() > 0) {
    const VectorXd pull = result.mass * system.base_motion;
    for (Index k = 0; k < n; ++k) inputs.emplace_back(static_cast<int>(k), static_cast<int>(count), -pull[k]);
  }
  result.input_names.emplace_back("base_acceleration");
  result.inputs = sparse(n, count + 1, inputs);
  result.outputs = sparse(count, n, outputs);
  return result;
}

ParametricSystem assemble_parametric(const MatrixSystem& system, const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters) {
  const Index n = system.size();
  ParametricSystem result;
  result.system = assemble(system, points);
  result.strain = identity(n);
  result.values.resize(static_cast<Index>(parameters.size()));
  const auto or_zero = [n](const SparseMatrix& matrix) {
    return matrix.rows() == n ? matrix : SparseMatrix(n, n);
  };
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const MatrixSystem::Parameter& parameter = named(system, parameters[j]);
    result.values[static_cast<Index>(j)] = parameter.value;
    ParametricSystem::Derivative slope{or_zero(parameter.mass), or_zero(parameter.stiffness),
                                       SparseMatrix(n, result.system.inputs.cols()),
                                       or_zero(parameter.damping)};
    if (slope.mass.nonZeros() + slope.rigidity.nonZeros() + slope.damping.nonZeros() == 0)
      refuse_system("parameter '" + parameter.name + "' has no effect; expected a matrix that it scales");
    if (system.base_motion.size() > 0 && slope.mass.nonZeros() > 0) {
      const VectorXd pull = slope.mass * system.base_motion;
      Triplets entries;
      for (Index k = 0; k < n; ++k)
        if (pull[k] != 0.0)
          entries.emplace_back(static_cast<int>(k), static_cast<int>(points.size()), -pull[k]);
      slope.inputs = sparse(n, result.system.inputs.cols(), entries);
    }
    result.derivatives.push_back(std::move(slope));
  }
  return result;
}

double value_of(const MatrixSystem& system, const BeamParameter& parameter) {
  return named(system, parameter).value;
}

MatrixSystem with_value(const MatrixSystem& system, const BeamParameter& parameter, double value) {
  const auto place = &named(system, parameter) - system.parameters.data();
  MatrixSystem changed = system;
  changed.parameters[static_cast<std::size_t>(place)].value = value;
  return changed;
}

}  // namespace beamid::fem
