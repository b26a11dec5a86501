#include "experiments/models/motion/supported_motion.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/LU>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

SupportedMotion::SupportedMotion(SupportedEquations equations, MotionDescription description, MatrixXd rows,
                                 VectorXd frequencies)
    : SecondOrderMotion(std::move(description), std::move(rows), "place"),
      equations_(std::move(equations)),
      frequencies_(std::move(frequencies)) {}

// W = M^-1 K and the like; a derivative by p_j is M^-1 (K_j - M_j W).
void SupportedMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                               std::vector<SecondOrderForm>* slopes) const {
  const MotionDescription& given = description();
  const PhysicalValues at = physical_values(given, layout(), state);
  const Index inside = equations_.inside();
  MatrixXd mass = equations_.mass, stiffness = equations_.stiffness, damping = equations_.damping,
           inputs = equations_.inputs;
  for (Index j = 0; j < given.properties(); ++j) {
    const auto& slope = equations_.derivatives[static_cast<std::size_t>(j)];
    mass += at.change[j] * slope.mass;
    stiffness += at.change[j] * slope.stiffness;
    damping += at.change[j] * slope.damping;
    inputs += at.change[j] * slope.inputs;
  }
  damping.topRows(inside) +=
      at.mass_damping * mass.topRows(inside) + at.stiffness_damping * stiffness.topRows(inside);
  std::vector<ModeDamping> modes;
  for (std::size_t i = 0; i < given.damped_modes.size(); ++i) {
    modes.push_back(damping_at(given.damped_modes[i], at.change, at.ratios[static_cast<Index>(i)]));
    const VectorXd& g = modes.back().momentum;
    damping.topLeftCorner(inside, inside).noalias() += (modes.back().factor * g) * g.transpose();
  }
  const Eigen::PartialPivLU<MatrixXd> factor(mass);
  if (!(factor.rcond() > 1e-14)) throw std::runtime_error("the parameters make a place without mass");
  form.stiffness = factor.solve(stiffness);
  form.damping = factor.solve(damping);
  form.inputs = factor.solve(inputs);
  if (!slopes) return;

  slopes->resize(given.unknowns.size());
  for (std::size_t j = 0; j < given.unknowns.size(); ++j) {
    const Drive& drive = given.drives[j];
    SecondOrderForm& slope = (*slopes)[j];
    slope.stiffness.setZero(mass.rows(), mass.cols());
    slope.damping.setZero(mass.rows(), mass.cols());
    slope.inputs.setZero(inputs.rows(), inputs.cols());
    auto damping_inside = slope.damping.topLeftCorner(inside, inside);
    if (drive.kind == Drive::Kind::property) {
      const auto& by = equations_.derivatives[static_cast<std::size_t>(drive.index)];
      slope.stiffness = by.stiffness - by.mass * form.stiffness;
      slope.damping = by.damping + at.mass_damping * by.mass + at.stiffness_damping * by.stiffness -
                      by.mass * form.damping;
      slope.inputs = by.inputs - by.mass * form.inputs;
      for (std::size_t i = 0; i < modes.size(); ++i) {
        const VectorXd& g = modes[i].momentum;
        const VectorXd turn = given.damped_modes[i].momentum_slopes.col(drive.index);
        damping_inside.noalias() += (modes[i].by_property[drive.index] * g) * g.transpose();
        damping_inside.noalias() += (modes[i].factor * turn) * g.transpose();
        damping_inside.noalias() += (modes[i].factor * g) * turn.transpose();
      }
    }
    if (drive.kind == Drive::Kind::mass_damping) slope.damping.topRows(inside) = mass.topRows(inside);
    if (drive.kind == Drive::Kind::stiffness_damping)
      slope.damping.topRows(inside) = stiffness.topRows(inside);
    for (std::size_t i = 0; i < modes.size() && drive.kind == Drive::Kind::damping_ratio; ++i)
      if (given.damped_modes[i].unknown == static_cast<Index>(j))
        damping_inside.noalias() += (modes[i].by_ratio * modes[i].momentum) * modes[i].momentum.transpose();
    for (MatrixXd* const matrix : {&slope.stiffness, &slope.damping, &slope.inputs})
      *matrix = at.slopes[static_cast<Index>(j)] * factor.solve(*matrix);
  }
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index most_part_coordinates = 60;

// Marks all that is connected to a coordinate without passing a support.
void mark_connected(const std::vector<const fem::SparseMatrix*>& matrices,
                    const std::vector<bool>& is_support, Index from, std::vector<bool>& inside) {
  std::vector<Index> open{from};
  while (!open.empty()) {
    const Index at = open.back();
    open.pop_back();
    if (inside[static_cast<std::size_t>(at)] || is_support[static_cast<std::size_t>(at)]) continue;
    inside[static_cast<std::size_t>(at)] = true;
    for (const fem::SparseMatrix* const matrix : matrices)
      for (fem::SparseMatrix::InnerIterator entry(*matrix, static_cast<int>(at)); entry; ++entry)
        if (entry.value() != 0.0) open.push_back(entry.row());
  }
}

bool touches(const std::vector<const fem::SparseMatrix*>& matrices, Index coordinate,
             const std::vector<bool>& inside) {
  for (const fem::SparseMatrix* const matrix : matrices)
    for (fem::SparseMatrix::InnerIterator entry(*matrix, static_cast<int>(coordinate)); entry; ++entry)
      if (entry.value() != 0.0 && inside[static_cast<std::size_t>(entry.row())]) return true;
  return false;
}

MatrixXd part_of(const fem::SparseMatrix& matrix, const std::vector<Index>& kept, Index inside) {
  if (matrix.size() == 0)
    return MatrixXd::Zero(static_cast<Index>(kept.size()), static_cast<Index>(kept.size()));
  MatrixXd part = MatrixXd(matrix)(kept, kept);
  part.bottomRows(part.rows() - inside).setZero();
  return part;
}

MatrixXd inputs_of(const fem::SparseMatrix& matrix, const std::vector<Index>& kept,
                   const std::vector<Index>& forces, const std::vector<Index>& supports, Index inside) {
  MatrixXd part = MatrixXd(matrix)(kept, forces);
  part.bottomRows(part.rows() - inside).setZero();
  for (const Index support : supports) part.col(support).setZero();
  return part;
}

}  // namespace

Index coordinate_of(const fem::StructuralSystem& system, Index input) {
  Index found = -1;
  for (fem::SparseMatrix::InnerIterator entry(system.inputs, static_cast<int>(input)); entry; ++entry) {
    if (entry.value() == 0.0) continue;
    if (found >= 0)
      throw std::invalid_argument(fmt::format(
          "support_acceleration at '{}' moves several coordinates at once; expected a place that is one",
          system.input_names[static_cast<std::size_t>(input)]));
    found = entry.row();
  }
  return found;
}

std::vector<bool> connected_inside(const fem::StructuralSystem& system, const std::vector<Index>& from,
                                   const std::vector<Index>& supports) {
  const auto size = static_cast<std::size_t>(system.size());
  const fem::SparseMatrix stiffness = system.stiffness.assembled();
  std::vector<bool> is_support(size, false), inside(size, false);
  for (const Index support : supports)
    is_support[static_cast<std::size_t>(coordinate_of(system, support))] = true;
  for (const Index one : from)
    mark_connected({&stiffness, &system.mass}, is_support, coordinate_of(system, one), inside);
  return inside;
}

SupportedEquations supported_equations(const fem::ParametricSystem& equations,
                                       const std::vector<Index>& forces, const std::vector<Index>& supports,
                                       Index base) {
  const fem::StructuralSystem& system = equations.system;
  const auto size = static_cast<std::size_t>(system.size());
  const fem::SparseMatrix stiffness = system.stiffness.assembled();
  std::vector<const fem::SparseMatrix*> matrices{&stiffness, &system.mass};
  if (system.damping.size() > 0) matrices.push_back(&system.damping);

  std::vector<bool> is_support(size, false), inside(size, false);
  std::vector<Index> places;  // of the supports among the coordinates
  for (const Index support : supports) {
    places.push_back(coordinate_of(system, forces[static_cast<std::size_t>(support)]));
    is_support[static_cast<std::size_t>(places.back())] = true;
  }
  for (int column = 0; column < system.outputs.outerSize(); ++column)
    for (fem::SparseMatrix::InnerIterator entry(system.outputs, column); entry; ++entry)
      if (entry.value() != 0.0) mark_connected(matrices, is_support, entry.col(), inside);

  SupportedEquations part;
  for (std::size_t i = 0; i < size; ++i)
    if (inside[i]) part.coordinates.push_back(static_cast<Index>(i));
  const auto within = static_cast<Index>(part.coordinates.size());
  if (within == 0)
    throw std::invalid_argument(
        "every sensor sits where the motion is imposed; expected one at a place between the supports");
  std::vector<Index> rows(supports.size(), -1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!touches(matrices, places[i], inside)) continue;
    rows[i] = static_cast<Index>(part.coordinates.size());
    part.coordinates.push_back(places[i]);
  }
  const auto n = static_cast<Index>(part.coordinates.size());
  part.supports = n - within;
  if (n > most_part_coordinates)
    throw std::invalid_argument(fmt::format(
        "the part between the supports has {} coordinates; expected {} at most: fewer elements, or "
        "supports nearer to each other",
        n, most_part_coordinates));

  part.mass = part_of(system.mass, part.coordinates, within);
  part.mass.bottomRightCorner(part.supports, part.supports).setIdentity();
  part.damping = part_of(system.damping, part.coordinates, within);
  part.stiffness = part_of(stiffness, part.coordinates, within);
  part.inputs = inputs_of(system.inputs, part.coordinates, forces, supports, within);
  const VectorXd moved_by_base =
      base >= 0 ? VectorXd(MatrixXd(system.mass)
                               .ldlt()
                               .solve(-MatrixXd(system.inputs).col(forces[static_cast<std::size_t>(base)])))
                : VectorXd::Zero(system.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0) continue;
    const double share = system.inputs.coeff(places[i], forces[static_cast<std::size_t>(supports[i])]);
    part.inputs(rows[i], supports[i]) = 1.0 / share;  // the coordinate of a rotation is scaled
    if (base >= 0) part.inputs(rows[i], base) = -moved_by_base[places[i]];
  }
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j) {
    const auto& slope = equations.derivatives[j];
    part.derivatives.push_back({part_of(slope.mass, part.coordinates, within),
                                part_of(slope.damping, part.coordinates, within),
                                part_of(equations.stiffness_derivative(j), part.coordinates, within),
                                inputs_of(slope.inputs, part.coordinates, forces, supports, within)});
  }
  return part;
}

fem::ParametricSystem held_at_supports(const fem::ParametricSystem& equations,
                                       const SupportedEquations& part) {
  const std::vector<Index> inside(part.coordinates.begin(), part.coordinates.begin() + part.inside());
  const auto kept = [&](const fem::SparseMatrix& matrix) -> fem::SparseMatrix {
    if (matrix.size() == 0) return matrix;
    return fem::SparseMatrix(MatrixXd(MatrixXd(matrix)(inside, inside)).sparseView());
  };
  const auto columns = [&](const fem::SparseMatrix& matrix) -> fem::SparseMatrix {
    return fem::SparseMatrix(MatrixXd(MatrixXd(matrix)(Eigen::all, inside)).sparseView());
  };
  const auto rows = [&](const fem::SparseMatrix& matrix) -> fem::SparseMatrix {
    return fem::SparseMatrix(MatrixXd(MatrixXd(matrix)(inside, Eigen::all)).sparseView());
  };
  fem::ParametricSystem held = equations;
  fem::StructuralSystem& system = held.system;
  system.coordinates.clear();
  for (const Index i : inside)
    system.coordinates.push_back(equations.system.coordinates[static_cast<std::size_t>(i)]);
  system.mass = kept(system.mass);
  system.damping = kept(system.damping);
  system.stiffness.strain = columns(system.stiffness.strain);
  system.inputs = rows(system.inputs);
  system.outputs = columns(system.outputs);
  system.mesh = {};
  held.strain = columns(held.strain);
  for (auto& slope : held.derivatives) {
    slope.mass = kept(slope.mass);
    slope.damping = kept(slope.damping);
    slope.inputs = rows(slope.inputs);
  }
  return held;
}

}  // namespace beamid::experiments
