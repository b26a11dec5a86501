#include "fem/solvers/strain_sweeps.hpp"

#include <algorithm>
#include <cmath>

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

void StrainSweeps::sweep_backward(double* f, double* forces) const {
  for (Eigen::Index step = steps(); step-- > 0;) {
    double* const place = f + pivot_[step];
    const RepeatedRows::Entry *entry = rows_.begin(step), *last = rows_.end(step);
    const double load = *place;
    forces[row_[step]] = load * entry->value;
    while (++entry != last) place[entry->offset] -= entry->value * load;
  }
}

}  // namespace beamid::fem
