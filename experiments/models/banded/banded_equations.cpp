#include "experiments/models/banded/banded_equations.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::VectorXd;

namespace {

fem::SparseMatrix chosen_columns(const fem::SparseMatrix& matrix, const std::vector<Index>& columns) {
  fem::SparseMatrix chosen(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] < 0 || columns[k] >= matrix.cols())
      throw std::invalid_argument("measured force is input " + std::to_string(columns[k]) +
                                  "; expected one of the system's " + std::to_string(matrix.cols()));
    chosen.col(static_cast<Index>(k)) = matrix.col(columns[k]);
  }
  return chosen;
}

std::vector<const fem::SparseMatrix*> slopes_of(const std::vector<fem::SparseMatrix>& matrices) {
  std::vector<const fem::SparseMatrix*> slopes;
  for (std::size_t j = 1; j < matrices.size(); ++j) slopes.push_back(&matrices[j]);
  return slopes;
}

// S from its parts, entry by entry.
BEAMID_WIDE_CLONE void sum_up(const double* stiffness, const double* mass, const double* dashpots,
                              std::size_t count, Complex by_stiffness, Complex by_mass, Complex by_dashpots,
                              Complex* sum) {
  for (std::size_t k = 0; k < count; ++k)
    sum[k] = stiffness[k] * by_stiffness + mass[k] * by_mass + dashpots[k] * by_dashpots;
}

}  // namespace

BandedEquations::Assembled::Assembled(const fem::ParametricSystem& equations)
    : stiffness{assembled_stiffness(equations.system.stiffness.strain, equations.system.stiffness.rigidity)},
      mass{equations.system.mass},
      dashpots{equations.system.damping} {
  for (const auto& derivative : equations.derivatives) {
    stiffness.push_back(assembled_stiffness(equations.strain, derivative.rigidity));
    mass.push_back(derivative.mass);
    dashpots.push_back(derivative.damping);
  }
}

SymmetricPattern BandedEquations::Assembled::pattern() const {
  std::vector<const fem::SparseMatrix*> all;
  for (const auto* const kind : {&stiffness, &mass, &dashpots})
    for (const fem::SparseMatrix& matrix : *kind) all.push_back(&matrix);
  return {mass.front().rows(), all};
}

BandedEquations::Entries::Entries(const SymmetricPattern& pattern,
                                  const std::vector<fem::SparseMatrix>& matrices)
    : reference(pattern.values(matrices.front())), now(reference) {
  for (const fem::SparseMatrix* slope : slopes_of(matrices)) {
    slopes.push_back(pattern.part(*slope));
    is_constant = is_constant && slopes.back().place.empty();
  }
}

void BandedEquations::Entries::set(const VectorXd& change) {
  if (is_constant) return;
  now = reference;
  for (std::size_t j = 0; j < slopes.size(); ++j) slopes[j].add(change[static_cast<Index>(j)], now);
}

BandedEquations::BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description)
    : BandedEquations(equations, description, Assembled(equations)) {}

BandedEquations::BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description,
                                 const Assembled& assembled)
    : description_(description),
      size_(equations.system.size()),
      stiffness_(equations),
      mass_(equations),
      pattern_(assembled.pattern()),
      stiffness_entries_(pattern_, assembled.stiffness),
      mass_entries_(pattern_, assembled.mass),
      dashpot_entries_(pattern_, assembled.dashpots),
      dashpots_(assembled.dashpots.front(), slopes_of(assembled.dashpots)),
      force_(chosen_columns(equations.system.inputs, description.forces)) {
  if (static_cast<Index>(equations.derivatives.size()) != description.properties())
    throw std::invalid_argument("the description drives " + std::to_string(description.properties()) +
                                " properties; expected the " + std::to_string(equations.derivatives.size()) +
                                " of the equations");
  for (const auto& derivative : equations.derivatives)
    force_slopes_.push_back(chosen_columns(derivative.inputs, description.forces));
  change_.setZero(properties());
}

bool BandedEquations::set(const PhysicalValues& values) {
  const bool properties_stay = is_set_ && values.change == change_;
  bool stays = properties_stay && values.mass_damping == mass_damping_ &&
               values.stiffness_damping == stiffness_damping_ && values.ratios == ratios_;
  if (stays) return false;
  is_set_ = true;
  mass_damping_ = values.mass_damping;
  stiffness_damping_ = values.stiffness_damping;
  ratios_ = values.ratios;
  mode_dampings_.clear();
  for (std::size_t i = 0; i < damped_modes().size(); ++i)
    mode_dampings_.push_back(damping_at(damped_modes()[i], values.change, ratios_[static_cast<Index>(i)]));
  if (properties_stay) return true;
  change_ = values.change;
  stiffness_.set(change_);
  mass_.set(change_);
  dashpots_.set(change_);
  for (Entries* entries : {&stiffness_entries_, &mass_entries_, &dashpot_entries_}) entries->set(change_);
  return true;
}

VectorXd BandedEquations::force(const VectorXd& input) const {
  VectorXd force = force_ * input.head(force_.cols());
  for (std::size_t j = 0; j < force_slopes_.size(); ++j)
    if (force_slopes_[j].nonZeros() > 0)
      force += change_[static_cast<Index>(j)] * (force_slopes_[j] * input.head(force_.cols()));
  return force;
}

VectorXd BandedEquations::force_slope(Index j, const VectorXd& input) const {
  return force_slopes_[j] * input.head(force_.cols());
}

double BandedEquations::highest_squared_frequency() const {
  double highest = 0.0;
  for (Index i = 0; i < size_; ++i) {
    const auto diagonal = static_cast<std::size_t>(pattern_.start(i + 1) - 1);
    highest = std::max(highest,
                       std::abs(stiffness_entries_.reference[diagonal]) / mass_entries_.reference[diagonal]);
  }
  return highest;
}

void BandedEquations::assemble(const Complex& lambda, std::vector<Complex>& entries) const {
  entries.resize(pattern_.entries());
  const Complex by_stiffness{1.0 + lambda.re * stiffness_damping_, lambda.im * stiffness_damping_};
  sum_up(stiffness_entries_.now.data(), mass_entries_.now.data(), dashpot_entries_.now.data(), entries.size(),
         by_stiffness, lambda * lambda + mass_damping_ * lambda, lambda, entries.data());
}

}  // namespace beamid::experiments::banded
