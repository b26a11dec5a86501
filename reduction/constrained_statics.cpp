#include "reduction/constrained_statics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <Eigen/QR>
#include <Eigen/SparseLU>

#include "fem/parametric_system.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::reduction {
namespace {

using Kind = fem::Coordinate::Kind;
using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

void require_mesh(const fem::StructuralSystem& system, const std::string& owner) {
  if (system.mesh.nodes.empty())
    throw std::invalid_argument(owner + " needs a mesh; this system is a reduced one");
}

bool is_frame(const fem::StructuralSystem& system) {
  return std::any_of(system.coordinates.begin(), system.coordinates.end(),
                     [](const fem::Coordinate& coordinate) { return coordinate.kind == Kind::axial; });
}

int nearest_node(const fem::StructuralSystem& system, double position, const std::string& owner) {
  const Eigen::VectorXd nodes = system.mesh.positions();
  const double first = nodes.minCoeff(), last = nodes.maxCoeff(), same = 1e-9 * (last - first);
  if (!(position >= first - same && position <= last + same)) {
    std::ostringstream message;
    message << owner << ": position " << position << " m is off the beam; expected " << first << " to "
            << last << " m";
    throw std::invalid_argument(message.str());
  }
  Eigen::Index nearest = 0;
  (nodes.array() - position).abs().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

int deflection_at(const fem::StructuralSystem& system, double position, const std::string& owner) {
  const int node = nearest_node(system, position, owner);
  for (std::size_t i = 0; i < system.coordinates.size(); ++i)
    if (system.coordinates[i].node == node && system.coordinates[i].kind == Kind::deflection)
      return static_cast<int>(i);
  std::ostringstream message;
  message << owner << ": the node nearest to " << position << " m, at " << system.mesh.nodes[node].x
          << " m, is held by a support; expected one that can move";
  throw std::invalid_argument(message.str());
}

std::vector<int> observed_coordinates(const fem::StructuralSystem& system, const std::string& owner) {
  std::vector<int> observed;
  const RowMajor outputs = system.outputs;
  for (Eigen::Index row = 0; row < outputs.rows(); ++row) {
    int column = -1, entries = 0;
    for (RowMajor::InnerIterator it(outputs, row); it; ++it) {
      if (it.value() == 0.0) continue;
      column = static_cast<int>(it.col());
      ++entries;
    }
    if (entries != 1) continue;
    const Kind kind = system.coordinates[column].kind;
    if ((kind == Kind::deflection || kind == Kind::axial || kind == Kind::lateral) &&
        std::find(observed.begin(), observed.end(), column) == observed.end())
      observed.push_back(column);
  }
  if (observed.empty())
    throw std::invalid_argument(owner +
                                " finds no output that reads a deflection; expected one, or positions");
  return observed;
}

}  // namespace

std::vector<int> master_coordinates(const fem::StructuralSystem& system, const std::vector<double>& positions,
                                    const std::string& owner) {
  if (positions.empty()) return observed_coordinates(system, owner);
  require_mesh(system, owner);
  if (is_frame(system))
    throw std::invalid_argument(owner +
                                ": a position does not determine a joint of a frame; expected none, which "
                                "means where the outputs are");
  std::vector<int> masters;
  for (const double position : positions) {
    const int coordinate = deflection_at(system, position, owner);
    if (std::find(masters.begin(), masters.end(), coordinate) != masters.end()) {
      std::ostringstream message;
      message << owner << ": position " << position << " m is nearest to the node at "
              << system.coordinates[coordinate].position
              << " m, and so is one before; expected each near a node of its own";
      throw std::invalid_argument(message.str());
    }
    masters.push_back(coordinate);
  }
  return masters;
}

std::vector<int> interface_coordinates(const fem::StructuralSystem& system,
                                       const std::vector<double>& positions, const std::string& owner) {
  std::vector<int> held;
  for (const int master : master_coordinates(system, positions, owner))
    for (std::size_t i = 0; i < system.coordinates.size(); ++i)
      if (system.coordinates[i].node == system.coordinates[master].node &&
          std::find(held.begin(), held.end(), static_cast<int>(i)) == held.end())
        held.push_back(static_cast<int>(i));
  return held;
}

std::vector<int> force_inputs(const fem::StructuralSystem& system) {
  std::vector<int> forces;
  for (int i = 0; i < system.inputs.cols(); ++i)
    if (static_cast<std::size_t>(i) >= system.input_names.size() ||
        !system.input_names[i].starts_with("base_acceleration"))
      forces.push_back(i);
  return forces;
}

int base_input(const fem::StructuralSystem& system) {
  for (std::size_t i = 0; i < system.input_names.size(); ++i)
    if (system.input_names[i] == "base_acceleration" || system.input_names[i] == "base_acceleration_y")
      return static_cast<int>(i);
  return -1;
}

using Eigen::Index, Eigen::MatrixXd;

namespace {

void place(const fem::SparseMatrix& part, Index row, Index column, double factor, bool and_transpose,
           fem::Triplets& entries) {
  for (int k = 0; k < part.outerSize(); ++k)
    for (fem::SparseMatrix::InnerIterator it(part, k); it; ++it) {
      const auto i = static_cast<int>(row + it.row()), j = static_cast<int>(column + it.col());
      entries.emplace_back(i, j, factor * it.value());
      if (and_transpose) entries.emplace_back(j, i, factor * it.value());
    }
}

// The constraints must tell the rigid-body motions apart.
void require_hold(const fem::StructuralSystem& system, const fem::SparseMatrix& constraints,
                  const std::string& owner) {
  const MatrixXd motions = fem::StiffnessSolver(system.stiffness).rigid_motions();
  if (motions.cols() == 0) return;
  const MatrixXd moved = constraints * motions;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(moved);
  qr.setThreshold(1e-9);
  if (qr.rank() < motions.cols())
    throw std::invalid_argument(owner + ": the structure can move without strain in " +
                                std::to_string(motions.cols()) + " ways, and the " +
                                std::to_string(constraints.rows()) +
                                " points given do not hold them all; expected more points");
}

}  // namespace

struct ConstrainedStatics::Factorisation {
  Index strains = 0, coordinates = 0, constraints = 0;
  double scale = 1.0;  // N is solved for in units of 1 / scale, which makes the entries of D^-1 one at most
  fem::SparseMatrix matrix;
  Eigen::SparseLU<fem::SparseMatrix> lu;
};

ConstrainedStatics::ConstrainedStatics(const fem::StructuralSystem& system,
                                       const fem::SparseMatrix& constraints, const std::string& owner)
    : factorisation_(std::make_unique<Factorisation>()) {
  require_hold(system, constraints, owner);
  Factorisation& f = *factorisation_;
  f.strains = system.stiffness.strain.rows();
  f.coordinates = system.size();
  f.constraints = constraints.rows();
  f.scale = system.stiffness.flexibility.coeffs().cwiseAbs().maxCoeff();
  fem::Triplets entries;
  place(system.stiffness.flexibility, 0, 0, -1.0 / f.scale, false, entries);
  place(system.stiffness.strain, 0, f.strains, 1.0, true, entries);
  place(constraints, f.strains + f.coordinates, f.strains, 1.0, true, entries);
  const Index size = f.strains + f.coordinates + f.constraints;
  f.matrix = fem::sparse(size, size, entries);
  f.lu.compute(f.matrix);

  const std::string singular =
      owner + ": the mesh cannot follow so many points, or a load buckles the structure that they hold";
  if (f.lu.info() != Eigen::Success) throw std::invalid_argument(singular);
  MatrixXd right = MatrixXd::Zero(size, f.constraints);
  right.bottomRows(f.constraints).setIdentity();
  unit_shapes_ = solve(right);
  const MatrixXd gap = constraints * unit_shapes_ - MatrixXd::Identity(f.constraints, f.constraints);
  if (!(gap.cwiseAbs().maxCoeff() < 1e-8)) throw std::invalid_argument(singular);
}
ConstrainedStatics::~ConstrainedStatics() = default;

// With one round of refinement.
MatrixXd ConstrainedStatics::solve(const MatrixXd& right) const {
  const Factorisation& f = *factorisation_;
  MatrixXd solution = f.lu.solve(right);
  solution += f.lu.solve(MatrixXd(right - f.matrix * solution));
  return solution.middleRows(f.strains, f.coordinates);
}

MatrixXd ConstrainedStatics::deflection_under(const MatrixXd& loads) const {
  const Factorisation& f = *factorisation_;
  MatrixXd right = MatrixXd::Zero(f.matrix.rows(), loads.cols());
  right.middleRows(f.strains, f.coordinates) = f.scale * loads;
  return solve(right);
}

fem::SparseMatrix unit_rows(const std::vector<int>& coordinates, Index size) {
  fem::Triplets entries;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    entries.emplace_back(static_cast<int>(i), coordinates[i], 1.0);
  return fem::sparse(static_cast<Index>(coordinates.size()), size, entries);
}

}  // namespace beamid::reduction
