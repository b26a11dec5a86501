#include "experiments/identify/update/modal_residual.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "experiments/identify/update/mode_pairing.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double farthest_factor = 1e4, start_factor = 5.0;
constexpr std::uint64_t start_seed = 1;

}  // namespace

SearchSpace::SearchSpace(const AskedParameters& asked) {
  const auto q = static_cast<Index>(asked.unknowns.size());
  guess_.resize(q);
  scale_.resize(q);
  lower_.resize(q);
  upper_.resize(q);
  from_.resize(q);
  to_.resize(q);
  longest_step_.setOnes(q);
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = asked.unknowns[static_cast<std::size_t>(j)];
    const bool signed_quantity = unknown.quantity == "axial_load";
    logarithmic_.push_back(unknown.guess > 0.0 && !signed_quantity &&
                           !(unknown.form == Form::bounded && unknown.lower <= 0.0));
    stated_.push_back(unknown.form == Form::bounded);
    guess_[j] = unknown.guess;
    scale_[j] = std::max(std::abs(unknown.guess), unknown.deviation);
    const auto x = [&](double p) {
      return logarithmic_.back() ? std::log(p / guess_[j]) : (p - guess_[j]) / scale_[j];
    };
    if (stated_.back()) {
      lower_[j] = from_[j] = x(unknown.lower);
      upper_[j] = to_[j] = x(unknown.upper);
    } else if (logarithmic_.back()) {
      upper_[j] = std::log(farthest_factor);
      to_[j] = std::log(start_factor);
      lower_[j] = -upper_[j];
      from_[j] = -to_[j];
    } else {
      upper_[j] = farthest_factor;
      lower_[j] = signed_quantity ? -farthest_factor : x(0.0);
      from_[j] = std::max(-3.0 * unknown.deviation / scale_[j], lower_[j]);
      to_[j] = 3.0 * unknown.deviation / scale_[j];
    }
  }
}

SearchSpace::SearchSpace(const AskedParameters& asked, const std::vector<std::pair<double, double>>& likely)
    : SearchSpace(asked) {
  VectorXd from(size()), to(size());
  for (Index j = 0; j < size(); ++j) {
    from[j] = likely[static_cast<std::size_t>(j)].first;
    to[j] = likely[static_cast<std::size_t>(j)].second;
  }
  from_ = place(from);
  to_ = place(to);
  longest_step_ = longest_step_.cwiseMax(0.2 * (upper_ - lower_));
}

VectorXd SearchSpace::physical(const VectorXd& x) const {
  VectorXd values(size());
  for (Index j = 0; j < size(); ++j)
    values[j] = logarithmic(j) ? guess_[j] * std::exp(x[j]) : guess_[j] + scale_[j] * x[j];
  return values;
}

VectorXd SearchSpace::slope(const VectorXd& x) const {
  VectorXd slopes(size());
  for (Index j = 0; j < size(); ++j) slopes[j] = logarithmic(j) ? guess_[j] * std::exp(x[j]) : scale_[j];
  return slopes;
}

VectorXd SearchSpace::place(const VectorXd& values) const {
  VectorXd x(size());
  for (Index j = 0; j < size(); ++j)
    x[j] = logarithmic(j) ? std::log(values[j] / guess_[j]) : (values[j] - guess_[j]) / scale_[j];
  return x.cwiseMax(lower_).cwiseMin(upper_);
}

VectorXd SearchSpace::start(std::size_t number) const {
  VectorXd x = VectorXd::Zero(size());
  if (number == 0) return x;
  filters::RandomStream random(start_seed, number);
  for (Index j = 0; j < size(); ++j) x[j] = from_[j] + (to_[j] - from_[j]) * random.uniform();
  return x;
}

namespace {

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
