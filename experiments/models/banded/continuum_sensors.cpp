#include "experiments/models/banded/continuum_sensors.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "experiments/models/banded/banded_blocks.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ContinuumSensors::ContinuumSensors(const fem::ParametricSystem& equations,
                                   const MotionDescription& description, const StateLayout& layout)
    : description_(description),
      layout_(layout),
      size_(equations.system.size()),
      rows_(MatrixXd(equations.system.outputs).transpose()) {
  const auto count = static_cast<Index>(description.observations.size());
  if (rows_.cols() != count)
    throw std::invalid_argument("the system has " + std::to_string(rows_.cols()) + " output rows for " +
                                std::to_string(count) + " observations; expected one each");
  for (Index i = 0; i < count; ++i)
    if (reads(description.observations[i].quantity) == Reads::accelerations) sensors_.push_back(i);
  if (sensors_.empty()) return;
  smooth(equations.system);

  const BandedMass mass(equations);
  mass_changes_everywhere_ = mass.support().size() > most_entries;
  const auto k = static_cast<Index>(sensors_.size());
  const auto s = mass_changes_everywhere_ ? 0 : static_cast<Index>(mass.support().size());
  MatrixXd right = MatrixXd::Zero(size_, k + s);
  for (Index i = 0; i < k; ++i) right.col(i) = rows_.col(sensors_[i]);
  for (Index i = 0; i < s; ++i) right(mass.support()[i], k + i) = 1.0;
  const Eigen::SimplicialLDLT<fem::SparseMatrix> factor(equations.system.mass);
  if (factor.info() != Eigen::Success)
    throw std::invalid_argument(
        "the mass matrix is not positive definite: some coordinate has no mass, and its "
        "acceleration is not determined");
  reference_ = receptance_ = factor.solve(right);
  gather_receptance();
}

void ContinuumSensors::smooth(const fem::StructuralSystem& system) {
  double highest = 0.0;  // omega^2 of the mesh, its order of magnitude
  const fem::SparseMatrix stiffness = system.stiffness.assembled();
  for (Index i = 0; i < size_; ++i)
    highest = std::max(highest, std::abs(stiffness.coeff(i, i)) / system.mass.coeff(i, i));
  fem::Modes modes = fem::modes(system, 1);
  if (modes.rigid > 0) modes = fem::modes(system, std::min(size_, modes.rigid + 3));
  if (modes.rigid >= modes.size()) return;
  const double cut = cut_off * modes.angular_frequency[modes.rigid], spare = 10.0;
  if (!(highest > spare * spare * cut * cut)) return;
  smooths_ = true;
  const SymmetricPattern pattern(size_, {&stiffness, &system.mass});
  const std::vector<double> masses = pattern.values(system.mass), rigidities = pattern.values(stiffness);
  std::vector<Complex> entries(pattern.entries());
  for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = {masses[e], rigidities[e] / (cut * cut)};
  StepFactor factor(pattern);
  factor.factor(entries);
  for (const Index sensor : sensors_)
    rows_.col(sensor) = system.mass * factor.real_part_solved(rows_.col(sensor));
}

// g of every sensor at M(p).
void ContinuumSensors::take_mass(const BandedEquations& equations) {
  const auto k = static_cast<Index>(sensors_.size());
  if (mass_changes_everywhere_) {
    if (!mass_factor_) mass_factor_.emplace(equations.pattern());
    mass_entries_.clear();
    for (const double entry : equations.mass_entries()) mass_entries_.push_back({entry, 0.0});
    mass_factor_->factor(mass_entries_);
    for (Index i = 0; i < k; ++i) receptance_.col(i) = mass_factor_->real_part_solved(rows_.col(sensors_[i]));
    return gather_receptance();
  }
  const std::vector<Index>& support = equations.mass().support();
  const auto s = static_cast<Index>(support.size());
  if (s == 0) return;
  MatrixXd added = MatrixXd::Zero(s, s), seen(s, k + s);
  const auto place = [&](Index i) {
    return std::lower_bound(support.begin(), support.end(), i) - support.begin();
  };
  for (Index j = 0; j < equations.properties(); ++j)
    for (const BandedMass::Entry& entry : equations.mass().slope(j))
      added(place(entry.row), place(entry.column)) += equations.change()[j] * entry.value;
  for (Index i = 0; i < s; ++i) seen.row(i) = reference_.row(support[i]);
  const MatrixXd system = MatrixXd::Identity(s, s) + added * seen.rightCols(s);
  receptance_ = reference_ - reference_.rightCols(s) * system.partialPivLu().solve(added * seen);
  gather_receptance();
}

void ContinuumSensors::gather_receptance() {
  const auto k = static_cast<Index>(sensors_.size());
  const VectorXd zero = VectorXd::Zero(size_);
  receptance_lanes_.resize(static_cast<std::size_t>((k + Lanes::count - 1) / Lanes::count));
  for (std::size_t b = 0; b < receptance_lanes_.size(); ++b) {
    const double* columns[Lanes::count];
    for (int l = 0; l < Lanes::count; ++l) {
      const Index i = static_cast<Index>(b) * Lanes::count + l;
      columns[l] = i < k ? receptance_.col(i).data() : zero.data();
    }
    receptance_lanes_[b].resize(static_cast<std::size_t>(size_));
    gather(columns, size_, receptance_lanes_[b].data());
  }
}

void ContinuumSensors::set(const BandedEquations& equations) {
  if (sensors_.empty()) return;
  const auto k = static_cast<Index>(sensors_.size());
  take_mass(equations);
  by_motion_.resize(size_, k);
  by_rate_.setZero(size_, k);
  std::vector<Lanes> product(static_cast<std::size_t>(size_));
  const auto multiply = [&](const auto& add_product, MatrixXd& columns) {
    for (std::size_t b = 0; b < receptance_lanes_.size(); ++b) {
      std::fill(product.begin(), product.end(), Lanes{});
      add_product(receptance_lanes_[b].data(), product.data());
      const Index first = static_cast<Index>(b) * Lanes::count;
      for (Index l = 0; l < std::min<Index>(Lanes::count, k - first); ++l)
        for (Index i = 0; i < size_; ++i) columns(i, first + l) = -product[i].values[l];
    }
  };
  multiply([&](const Lanes* x, Lanes* y) { equations.stiffness().add_product(x, y); }, by_motion_);
  if (!equations.dashpots().now().is_empty())
    multiply([&](const Lanes* x, Lanes* y) { equations.dashpots().now().add_product(x, y); }, by_rate_);
  if (const double beta = equations.stiffness_damping(); beta != 0.0) by_rate_ += beta * by_motion_;
  if (const double alpha = equations.mass_damping(); alpha != 0.0)
    by_rate_ -= alpha * rows_(Eigen::all, sensors_);
  modes_seen_.resize(static_cast<Index>(equations.mode_dampings().size()), k);
  for (Index i = 0; i < modes_seen_.rows(); ++i) {
    const ModeDamping& mode = equations.mode_dampings()[static_cast<std::size_t>(i)];
    modes_seen_.row(i) = mode.momentum.transpose() * receptance_.leftCols(k);
    for (Index sensor = 0; sensor < k; ++sensor)
      by_rate_.col(sensor) -= mode.factor * modes_seen_(i, sensor) * mode.momentum;
  }
}

void ContinuumSensors::output(const BandedEquations& equations, const VectorXd& state, const VectorXd& input,
                              VectorXd& output) const {
  const auto q = state.head(size_), rate = state.segment(size_, size_);
  output.resize(rows_.cols());
  VectorXd force;
  Index k = 0;
  for (Index i = 0; i < rows_.cols(); ++i) {
    const Reads what = reads(description_.observations[i].quantity);
    if (what == Reads::coordinates) output[i] = rows_.col(i).dot(q);
    if (what == Reads::rates) output[i] = rows_.col(i).dot(rate);
    if (what != Reads::accelerations) continue;
    if (force.size() == 0) {  // K q through the strains, and not -by_motion_^T q, which cancels
      force.setZero(size_);
      equations.stiffness().add_product(q.data(), force.data());
      force = equations.force(input) - force;
    }
    output[i] = receptance_.col(k).dot(force) + by_rate_.col(k).dot(rate);
    if (description_.base >= 0 && input.size() > 0)
      output[i] += description_.carried(i, description_.base) * input[description_.base];
    if (layout_.biases[i] >= 0) output[i] += state[layout_.biases[i]];
    ++k;
  }
}

}  // namespace beamid::experiments::banded
