#include "experiments/identify/update/modal_residual.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/update/mode_pairing.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool has_shape(const MeasuredMode& mode) {
  return mode.shape.size() > 1;
}

}  // namespace

ModalResidual::ModalResidual(const ModesOfParameters& model, const SearchSpace& space, const ModalData& data,
                             ModelTrust trust)
    : model_(model), space_(space), data_(data), trust_(trust) {
  for (const MeasuredMode& mode : data_.modes) {
    frequency_deviation_.push_back(std::hypot(mode.deviation_hz, trust.frequency * mode.frequency_hz));
    const double largest = mode.shape.size() > 0 ? mode.shape.cwiseAbs().maxCoeff() : 0.0;
    shape_deviation_.push_back(std::hypot(mode.shape_deviation, trust.shape * largest));
    size_ += 1 + (has_shape(mode) ? mode.shape.size() : 0);
  }
  const auto last = data_.modes.empty() ? 0
                                        : std::max<Index>(data_.modes.back().number.value_or(0),
                                                          static_cast<Index>(data_.modes.size()));
  if (last > model.modes())
    throw std::invalid_argument(
        fmt::format("{} modes for a structure that has {}; expected no more than it "
                    "has",
                    last, model.modes()));
  for (const bool prior : model.asked().has_prior) size_ += prior ? 1 : 0;
}

FitResidual::Value ModalResidual::at(const VectorXd& x, bool jacobian) const {
  Value value;
  const VectorXd values = space_.physical(x), slopes = space_.slope(x);
  value.modes = model_.at(values, jacobian);
  value.pairs = pair_modes(data_, value.modes);
  value.residual.setZero(size_);
  if (jacobian) value.jacobian.setZero(size_, x.size());
  Index row = 0;
  for (std::size_t i = 0; i < data_.modes.size(); ++i) {
    const MeasuredMode& mode = data_.modes[i];
    const Index k = value.pairs[i];
    value.residual[row] = (value.modes.frequency_hz[k] - mode.frequency_hz) / frequency_deviation_[i];
    if (jacobian)
      value.jacobian.row(row) =
          value.modes.frequency_slopes.row(k).cwiseProduct(slopes.transpose()) / frequency_deviation_[i];
    ++row;
    if (!has_shape(mode)) continue;
    add_shape(i, row, slopes, value);
    row += mode.shape.size();
  }
  add_priors(values, row, slopes, value);
  return value;
}

// P = I - S S^+:  d(P psi) = -P dS S^+ psi - (P dS S^+)^T psi  [golub1973]
void ModalResidual::add_shape(std::size_t i, Index row, const VectorXd& slopes, Value& value) const {
  const VectorXd& shape = data_.modes[i].shape;
  const auto [first, number] = value.modes.cluster[static_cast<std::size_t>(value.pairs[i])];
  if (number >= shape.size()) return;  // any shape lies in the space
  const MatrixXd space = value.modes.shapes.middleCols(first, number);
  const MatrixXd inverse = space.completeOrthogonalDecomposition().pseudoInverse();
  const VectorXd weights = inverse * shape, rest = shape - space * weights;
  const double deviation = shape_deviation_[i];
  value.residual.segment(row, shape.size()) = rest / deviation;
  if (value.jacobian.size() == 0) return;
  for (Index j = 0; j < slopes.size(); ++j) {
    MatrixXd change(shape.size(), number);
    for (Index c = 0; c < number; ++c)
      change.col(c) = slopes[j] * value.modes.shape_slopes[static_cast<std::size_t>(first + c)].col(j);
    const VectorXd moved = change * weights;
    value.jacobian.block(row, j, shape.size(), 1) =
        -(moved - space * (inverse * moved) + inverse.transpose() * (change.transpose() * rest)) / deviation;
  }
}

void ModalResidual::add_priors(const VectorXd& values, Index row, const VectorXd& slopes,
                               Value& value) const {
  for (Index j = 0; j < values.size(); ++j) {
    if (!model_.asked().has_prior[static_cast<std::size_t>(j)]) continue;
    const Unknown& unknown = model_.asked().unknowns[static_cast<std::size_t>(j)];
    const bool log = unknown.form == Form::logarithmic;
    const double deviation = log ? unknown.deviation / unknown.guess : unknown.deviation;
    value.residual[row] = (log ? std::log(values[j] / unknown.guess) : values[j] - unknown.guess) / deviation;
    if (value.jacobian.size() > 0)
      value.jacobian(row, j) = (log ? 1.0 / values[j] : 1.0) * slopes[j] / deviation;
    ++row;
  }
}

Index ModalResidual::measured() const {
  const std::vector<bool>& prior = model_.asked().has_prior;
  return size_ - std::count(prior.begin(), prior.end(), true);
}

Index ModalResidual::independent(const Value& value) const {
  Index count = size_;
  for (std::size_t i = 0; i < data_.modes.size(); ++i) {
    if (!has_shape(data_.modes[i])) continue;
    const Index number = value.modes.cluster[static_cast<std::size_t>(value.pairs[i])].second;
    count -= std::min(number, data_.modes[i].shape.size());
  }
  return count;
}

}  // namespace beamid::experiments
