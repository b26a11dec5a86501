#include "experiments/models/banded/banded_equations.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::VectorXd;

namespace {

int half_width(const fem::SparseMatrix& matrix) {
  int width = 0;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      width = std::max(width, std::abs(static_cast<int>(it.row()) - j));
  return width;
}

// Rows first .. second - 1 of the lower triangle, width + 1 entries each.
std::vector<double> lower_band(const fem::SparseMatrix& matrix, int width, std::pair<Index, Index> rows) {
  std::vector<double> band(static_cast<std::size_t>(rows.second - rows.first) * (width + 1), 0.0);
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      if (it.row() >= j) band[(it.row() - rows.first) * (width + 1) + width + j - it.row()] = it.value();
  return band;
}

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

BEAMID_WIDE_CLONE void add_scaled(double factor, const double* x, std::size_t count, double* y) {
  for (std::size_t i = 0; i < count; ++i) y[i] += factor * x[i];
}

}  // namespace

BandedEquations::BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description)
    : description_(description),
      size_(equations.system.size()),
      stiffness_(equations),
      mass_(equations),
      width_(mass_.width()),
      dashpots_(equations.system.damping),
      force_(chosen_columns(equations.system.inputs, description.forces)) {
  const fem::StrainFactors& factors = equations.system.stiffness;
  if (static_cast<Index>(equations.derivatives.size()) != description.properties())
    throw std::invalid_argument("the description drives " + std::to_string(description.properties()) +
                                " properties; expected the " + std::to_string(equations.derivatives.size()) +
                                " of the equations");
  std::vector<fem::SparseMatrix> assembled{factors.assembled()};
  for (const auto& derivative : equations.derivatives) {
    assembled.push_back(factors.strain.transpose() * derivative.rigidity * factors.strain);
    force_slopes_.push_back(chosen_columns(derivative.inputs, description.forces));
  }
  for (const auto& matrix : assembled) width_ = std::max(width_, half_width(matrix));
  width_ = BandedFactor(0, std::max(width_, half_width(dashpots_))).width();
  stiffness_band_ = lower_band(assembled[0], width_, {0, size_});
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j)
    stiffness_slopes_.push_back(
        lower_band(assembled[j + 1], width_, stiffness_.reach(static_cast<Index>(j))));
  if (dashpots_.nonZeros() > 0) dashpot_band_ = lower_band(dashpots_, width_, {0, size_});
  band_ = stiffness_band_;
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
  band_ = stiffness_band_;
  for (std::size_t j = 0; j < stiffness_slopes_.size(); ++j)
    add_scaled(change_[static_cast<Index>(j)], stiffness_slopes_[j].data(), stiffness_slopes_[j].size(),
               band_.data() + stiffness_.reach(static_cast<Index>(j)).first * (width_ + 1));
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

void BandedEquations::assemble(const Complex& lambda, BandedFactor& factor) const {
  const Complex square = lambda * lambda;
  const Complex by_stiffness{1.0 + lambda.re * stiffness_damping_, lambda.im * stiffness_damping_};
  const Complex by_mass = square + mass_damping_ * lambda;
  const int across = mass_.width();
  for (Index i = 0; i < size_; ++i) {
    Complex* const row = factor.row(i);
    const double* const stiffness = &band_[i * (width_ + 1)];
    const double* const mass = mass_.row(i) + across - width_;
    for (int k = 0; k < width_ - across; ++k) row[k] = stiffness[k] * by_stiffness;
    for (int k = width_ - across; k <= width_; ++k) row[k] = stiffness[k] * by_stiffness + mass[k] * by_mass;
    if (dashpot_band_.empty()) continue;
    for (int k = 0; k <= width_; ++k) row[k] += dashpot_band_[i * (width_ + 1) + k] * lambda;
  }
}

}  // namespace beamid::experiments::banded
