#include "experiments/identify/update/modal_model.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Eigenvalues>

#include "experiments/models/motion/beam_equations.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double close_modes = 0.01;  // relative distance of frequencies

// First mode and number of those that follow each other closely, for each mode.
std::vector<std::pair<Index, Index>> clusters_of(const VectorXd& frequency) {
  std::vector<std::pair<Index, Index>> clusters(static_cast<std::size_t>(frequency.size()));
  for (Index first = 0; first < frequency.size();) {
    Index end = first + 1;
    while (end < frequency.size() && frequency[end] < (1.0 + close_modes) * frequency[end - 1]) ++end;
    for (Index i = first; i < end; ++i) clusters[static_cast<std::size_t>(i)] = {first, end - first};
    first = end;
  }
  return clusters;
}

// First row and number of rows in which two symmetric matrices have entries.
std::pair<Index, Index> touched_by(const fem::SparseMatrix& a, const fem::SparseMatrix& b) {
  Index first = a.rows(), end = 0;
  for (const fem::SparseMatrix* matrix : {&a, &b})
    for (Index column = 0; column < matrix->outerSize(); ++column)
      if (fem::SparseMatrix::InnerIterator(*matrix, column)) {
        first = std::min(first, column);
        end = std::max(end, column + 1);
      }
  return {std::min(first, end), std::max<Index>(0, end - first)};
}

}  // namespace

FoundModes lowest_found_modes(const fem::StructuralSystem& system, Index count, bool slopes) {
  const bool shaped = slopes && system.outputs.rows() > 1;
  const fem::Modes modes = fem::modes(system, std::min(system.size(), shaped ? 2 * count + 6 : count));
  FoundModes result{modes.angular_frequency.cwiseAbs2(), modes.shape, {}};
  if (shaped && modes.rigid == 0)
    result.compliance =
        fem::StiffnessSolver(system.stiffness).solve(MatrixXd(system.outputs.transpose())).transpose();
  return result;
}

PredictedModes seen_modes(const FoundModes& found, const fem::SparseMatrix& outputs, Index count) {
  if (!(found.eigenvalues[0] > -1e-9 * std::abs(found.eigenvalues[count - 1])))
    throw std::runtime_error("a mode has a negative stiffness");
  PredictedModes modes;
  modes.frequency_hz = found.eigenvalues.head(count).cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
  modes.shapes = outputs * found.shapes.leftCols(count);
  modes.cluster = clusters_of(modes.frequency_hz);
  return modes;
}

// With F = (K_j - lambda M_j - lambda' M) phi, which no mode near phi sees but phi itself:
//
//     S phi' = -sum_m s_m (phi_m^T F) / (lambda_m - lambda) - s (phi^T M_j phi) / 2
//
// over all modes outside the cluster. Of a large system, whose modes are the lowest only, the rest answers
// statically: S K^-1 F less what these modes do of it.
void add_slopes(const FoundModes& all, const fem::SparseMatrix& outputs,
                const std::vector<MatrixSlope>& slopes, PredictedModes& modes) {
  const Index k = modes.frequency_hz.size(), q = static_cast<Index>(slopes.size()), m = all.shapes.cols();
  const MatrixXd seen = outputs * all.shapes;  // (p x m)
  modes.frequency_slopes.resize(k, q);
  if (seen.rows() > 1) modes.shape_slopes.assign(static_cast<std::size_t>(k), MatrixXd(seen.rows(), q));
  for (Index j = 0; j < q; ++j) {
    const MatrixSlope& slope = slopes[static_cast<std::size_t>(j)];
    const bool heavy = slope.mass.nonZeros() > 0;
    const auto [from, rows] = touched_by(slope.stiffness, slope.mass);
    const MatrixXd lowest = all.shapes.leftCols(k);
    MatrixXd loads = slope.stiffness * lowest;  // F but for lambda' M phi
    const MatrixXd momenta = heavy ? MatrixXd(slope.mass * lowest) : MatrixXd();
    if (heavy) loads -= momenta * all.eigenvalues.head(k).asDiagonal();
    const MatrixXd work = all.shapes.middleRows(from, rows).transpose() * loads.middleRows(from, rows);
    MatrixXd statics;
    if (all.compliance.size() > 0)
      statics = all.compliance.middleCols(from, rows) * loads.middleRows(from, rows);
    for (Index i = 0; i < k; ++i) {
      const double lambda = all.eigenvalues[i], f = modes.frequency_hz[i];
      modes.frequency_slopes(i, j) =
          f > 0.0 ? work(i, i) / (8.0 * std::numbers::pi * std::numbers::pi * f) : 0.0;
      if (seen.rows() < 2) continue;  // no shape to compare
      const auto [first, number] = modes.cluster[static_cast<std::size_t>(i)];
      VectorXd change = VectorXd::Zero(seen.rows());
      for (Index a = 0; a < m; ++a) {
        const double mu = all.eigenvalues[a];
        const bool near = a >= first && a < first + number;
        double share = near ? 0.0 : 1.0 / (mu - lambda);
        if (all.compliance.size() > 0) share -= 1.0 / mu;
        change -= share * work(a, i) * seen.col(a);
      }
      if (all.compliance.size() > 0) change -= statics.col(i);
      if (heavy) change -= 0.5 * lowest.col(i).dot(momenta.col(i)) * seen.col(i);
      modes.shape_slopes[static_cast<std::size_t>(i)].col(j) = change;
    }
  }
}

namespace {

constexpr Index most_dense_unknowns = 64;

}  // namespace

ModalModel::ModalModel(const fem::Structure& structure, int elements, std::vector<fem::Point> points,
                       AskedParameters asked, Index count)
    : structure_(structure), elements_(elements), points_(std::move(points)), asked_(std::move(asked)) {
  described_ = fem::assemble_parametric(structure_, elements_, points_, asked_.parameters);
  count_ = std::min(count, size());
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j)
    slopes_.push_back({described_.stiffness_derivative(j), described_.derivatives[j].mass});
  if (!dense()) return;
  mass_0_ = described_.system.mass;
  stiffness_0_ = described_.system.stiffness.assembled();
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j) {
    mass_0_ -= described_.values[static_cast<Index>(j)] * slopes_[j].mass;
    stiffness_0_ -= described_.values[static_cast<Index>(j)] * slopes_[j].stiffness;
  }
}

bool ModalModel::dense() const {
  return size() <= most_dense_unknowns;
}

std::pair<MatrixXd, MatrixXd> ModalModel::matrices(const VectorXd& values) const {
  if (!dense()) throw std::invalid_argument("the system is not small");
  MatrixXd mass = mass_0_, stiffness = stiffness_0_;
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    mass += values[static_cast<Index>(j)] * slopes_[j].mass;
    stiffness += values[static_cast<Index>(j)] * slopes_[j].stiffness;
  }
  return {mass, stiffness};
}

FoundModes ModalModel::found(const VectorXd& values, bool slopes) const {
  if (dense()) {
    const auto [mass, stiffness] = matrices(values);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass);
    if (solver.info() != Eigen::Success) throw std::runtime_error("the mass matrix is not positive definite");
    return {solver.eigenvalues(), solver.eigenvectors(), {}};
  }
  fem::Structure there = structure_;
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j)
    if (fem::value_of(there, asked_.parameters[j]) != values[static_cast<Index>(j)])
      there = fem::with_value(there, asked_.parameters[j], values[static_cast<Index>(j)]);
  // A beam's mesh has nodes where its parameters begin and end; else the derivatives are not needed.
  return lowest_found_modes(
      there.is_beam() ? fem::assemble_parametric(there, elements_, points_, asked_.parameters).system
                      : fem::assemble(there, elements_, points_),
      count_, slopes);
}

PredictedModes ModalModel::at(const VectorXd& values, bool slopes) const {
  const FoundModes all = found(values, slopes);
  PredictedModes modes = seen_modes(all, described_.system.outputs, count_);
  if (slopes) add_slopes(all, described_.system.outputs, slopes_, modes);
  return modes;
}

namespace {

/// Every storey or factor by itself, or the bending stiffness.
std::vector<ParameterChoice> natural_choices(const Experiment& experiment) {
  std::vector<ParameterChoice> choices;
  if (!experiment.structure.is_beam()) {
    for (const std::string& name : fem::factor_names(experiment.structure))
      choices.push_back({"factor", name});
    if (choices.empty())
      throw std::invalid_argument(std::string("the ") + experiment.structure.kind() +
                                  " has no parameter that may be unknown; expected groups of members, or "
                                  "parameters of matrices");
    return choices;
  }
  if (!experiment.structure.is_chain()) return {{"bending_stiffness"}};
  const fem::Beam& chain = experiment.structure.beam();
  double height = 0.0;
  for (const auto& storey : chain.segments) {
    ParameterChoice choice{"storey_stiffness"};
    choice.region = {height, std::min(height + storey.length, chain.length())};
    height += storey.length;
    choices.push_back(choice);
  }
  return choices;
}

bool moves_frequencies(const std::string& quantity) {
  return beam_quantity(quantity) && quantity != "storey_damping";
}

bool is_damping(const std::string& quantity) {
  return quantity == "storey_damping" || quantity == "damping_ratio" || quantity == "mass_damping" ||
         quantity == "stiffness_damping";
}

}  // namespace

AskedParameters asked_parameters(const Experiment& experiment) {
  AskedParameters asked;
  std::vector<ParameterChoice> choices;
  for (const ParameterChoice& choice : experiment.parameters) {
    if (moves_frequencies(choice.quantity)) {
      choices.push_back(choice);
      continue;
    }
    if (!is_damping(choice.quantity))
      refuse(choice, "the structure has no " + choice.quantity +
                         " that modes would depend on; expected a stiffness, a mass or axial_load");
    asked.left_out.push_back(choice.name.empty() ? choice.quantity : choice.name);
  }
  if (choices.empty()) choices = natural_choices(experiment);
  asked.unknowns = unknowns_of(choices, beam_defaults(experiment.structure, choices));
  for (const ParameterChoice& choice : choices) {
    asked.parameters.push_back({*beam_quantity(choice.quantity), choice.region, choice.name});
    asked.has_prior.push_back(choice.deviation || choice.relative_deviation);
  }
  return asked;
}

}  // namespace beamid::experiments
