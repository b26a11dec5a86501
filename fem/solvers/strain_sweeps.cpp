#include "fem/solvers/strain_sweeps.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace beamid::fem {
namespace {

using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// A pivot this much smaller than its row's largest candidate would magnify rounding.
constexpr double smallest_pivot = 0.01;

}  // namespace

StrainSweeps::StrainSweeps(const Eigen::SparseMatrix<double>& strain) : coordinates_(strain.cols()) {
  const RowMajor rows = strain;
  std::vector<bool> determined(static_cast<std::size_t>(coordinates_), false);
  std::vector<RepeatedRows::Entry> step;
  row_.reserve(static_cast<std::size_t>(rows.rows()));
  pivot_.reserve(static_cast<std::size_t>(rows.rows()));
  for (int row = 0; row < rows.rows(); ++row) {
    double largest = 0.0;
    for (RowMajor::InnerIterator it(rows, row); it; ++it)
      if (!determined[it.col()]) largest = std::max(largest, std::abs(it.value()));
    if (largest == 0.0) {  // also where supports hold all that the strain depends on
      redundants_.push_back(row);
      continue;
    }
    int pivot = -1;
    double pivot_value = 0.0;
    for (RowMajor::InnerIterator it(rows, row); it; ++it)
      if (!determined[it.col()] && std::abs(it.value()) >= smallest_pivot * largest) {
        pivot = static_cast<int>(it.col());
        pivot_value = it.value();
      }
    step.assign(1, {0, 1.0 / pivot_value});
    for (RowMajor::InnerIterator it(rows, row); it; ++it) {
      const auto column = static_cast<int>(it.col());
      if (it.value() == 0.0) continue;
      if (!determined[column] && column != pivot) gauges_.push_back(column);
      determined[column] = true;
      if (column != pivot) step.push_back({column - pivot, it.value() / pivot_value});
    }
    std::sort(step.begin() + 1, step.end(), [](const auto& a, const auto& b) { return a.offset > b.offset; });
    rows_.add(step);
    row_.push_back(row);
    pivot_.push_back(pivot);
  }
  for (int column = 0; column < coordinates_; ++column)
    if (!determined[column]) gauges_.push_back(column);
}

void StrainSweeps::sweep_motion(double* q) const {
  constexpr double cancelled = 1e-14;
  for (Eigen::Index step = 0; step < steps(); ++step) {
    double* const place = q + pivot_[step];
    const RepeatedRows::Entry *entry = rows_.begin(step), *last = rows_.end(step);
    double rest = 0.0, terms = 0.0;
    while (++entry != last) {
      const double term = entry->value * place[entry->offset];
      rest -= term;
      terms += std::abs(term);
    }
    *place = std::abs(rest) > cancelled * terms ? rest : 0.0;
  }
}

void StrainSweeps::sweep_backward(double* f, double* forces) const {
  for (Eigen::Index step = steps(); step-- > 0;) {
    double* const place = f + pivot_[step];
    const RepeatedRows::Entry *entry = rows_.begin(step), *last = rows_.end(step);
    const double load = *place;
    forces[row_[step]] = load * entry->value;
    while (++entry != last) place[entry->offset] -= entry->value * load;
  }
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double no_motion_strain = 1e-9;  // relative to the terms that cancel in it

VectorXd gauge_motion(const StrainSweeps& sweeps, int gauge) {
  VectorXd motion = VectorXd::Zero(sweeps.coordinates());
  motion[gauge] = 1.0;
  sweeps.sweep_motion(motion.data());
  return motion;
}

}  // namespace

RowMajor selected_rows(const Eigen::SparseMatrix<double>& strain, const std::vector<int>& rows) {
  std::vector<int> place(static_cast<std::size_t>(strain.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[rows[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < strain.outerSize(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator it(strain, k); it; ++it)
      if (place[it.row()] >= 0) entries.emplace_back(place[it.row()], k, it.value());
  RowMajor selected(static_cast<Index>(rows.size()), strain.cols());
  selected.setFromTriplets(entries.begin(), entries.end());
  return selected;
}

RigidMotions rigid_motions(const StrainSweeps& sweeps, const Eigen::SparseMatrix<double>& strain) {
  const RowMajor redundant = selected_rows(strain, sweeps.redundants());
  const RowMajor magnitude = redundant.cwiseAbs();
  const Index rows = redundant.rows(), gauges = static_cast<Index>(sweeps.gauges().size());
  MatrixXd constraint(rows, gauges), terms(rows, gauges);
  VectorXd largest(gauges);
  for (Index j = 0; j < gauges; ++j) {
    const VectorXd motion = gauge_motion(sweeps, sweeps.gauges()[j]);
    largest[j] = motion.cwiseAbs().maxCoeff();
    constraint.col(j) = redundant * motion;
    terms.col(j) = magnitude * motion.cwiseAbs();
  }
  MatrixXd scaled = constraint * largest.cwiseInverse().asDiagonal();
  const VectorXd scale = (terms * largest.cwiseInverse().asDiagonal()).rowwise().sum();
  for (Index i = 0; i < rows; ++i) scaled.row(i) /= scale[i] > 0.0 ? scale[i] : 1.0;

  // Rank by column-pivoted QR: [Q R11 R12], held = -R11^-1 R12 of the kept. A matrix of zeros has no kept
  // gauges.
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  Index rank = 0;
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(gauges, 0, static_cast<int>(gauges) - 1);
  if (rows > 0 && gauges > 0) {
    qr.compute(scaled);
    const auto diagonal = qr.matrixQR().diagonal().cwiseAbs();
    while (rank < diagonal.size() &&
           diagonal[rank] > no_motion_strain * std::sqrt(static_cast<double>(gauges)))
      ++rank;
    if (rank > 0) order = qr.colsPermutation().indices();
  }
  std::sort(order.data() + rank, order.data() + gauges);

  RigidMotions result;
  result.constraint.resize(rows, rank);
  for (Index j = 0; j < rank; ++j) {
    result.kept.push_back(sweeps.gauges()[order[j]]);
    result.constraint.col(j) = constraint.col(order[j]);
  }
  result.motions = MatrixXd::Zero(sweeps.coordinates(), gauges - rank);
  const auto kept_columns = [&] {
    MatrixXd columns(rows, rank);
    for (Index j = 0; j < rank; ++j) columns.col(j) = scaled.col(order[j]);
    return columns;
  };
  const Eigen::HouseholderQR<MatrixXd> kept(rank > 0 && rank < gauges ? kept_columns() : MatrixXd(0, 0));
  for (Index j = rank; j < gauges; ++j) {
    const int held = sweeps.gauges()[order[j]];
    result.held.push_back(held);
    auto motion = result.motions.col(j - rank);
    motion[held] = 1.0;
    if (rank > 0) {
      const VectorXd follow = kept.solve(scaled.col(order[j]));  // of the kept gauges, in their own scales
      for (Index i = 0; i < rank; ++i)
        motion[result.kept[i]] = -follow[i] * largest[order[j]] / largest[order[i]];
    }
    sweeps.sweep_motion(motion.data());
    motion /= motion.cwiseAbs().maxCoeff();
  }
  return result;
}

}  // namespace beamid::fem
