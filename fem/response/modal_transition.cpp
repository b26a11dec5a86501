#include "fem/response/modal_transition.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "fem/response/oscillator_step.hpp"

namespace beamid::fem {

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd;

namespace {

// The exponential for states (s z, z'), s making its norm even, and inputs (f, h f').
MatrixXd scaled_exponential(const ModalBasis& basis, const MatrixXd& loads, double h, double s) {
  const Index k = basis.square.size(), m = loads.cols();
  MatrixXd rate = MatrixXd::Zero(2 * (k + m), 2 * (k + m));
  rate.block(0, k, k, k).diagonal().setConstant(s * h);
  rate.block(k, 0, k, k).diagonal() = -basis.square * (h / s);
  rate.block(k, k, k, k) = -h * basis.coupling;
  rate.block(k, k, k, k).diagonal() -= h * basis.rate;
  rate.block(k, 2 * k, k, m) = h * loads;
  rate.bottomRightCorner(m, m).setZero();
  rate.block(2 * k, 2 * k + m, m, m).setIdentity();
  return rate.exp();
}

}  // namespace

ModalTransition::ModalTransition(const ModalBasis& basis, const MatrixXd& loads, double interval)
    : from(2 * loads.rows(), loads.cols()),
      to(2 * loads.rows(), loads.cols()),
      coupled_(basis.coupling.size() > 0) {
  const Index k = basis.square.size(), m = loads.cols();
  if (coupled_) {
    const double s = std::max(std::sqrt(basis.square.maxCoeff()), 1e-3 / interval);
    const MatrixXd transition = scaled_exponential(basis, loads, interval, s);
    increment_ = transition.topLeftCorner(2 * k, 2 * k);
    increment_.diagonal().array() -= 1.0;
    to = transition.block(0, 2 * k + m, 2 * k, m);
    from = transition.block(0, 2 * k, 2 * k, m) - to;
    increment_.topRightCorner(k, k) /= s;
    increment_.bottomLeftCorner(k, k) *= s;
    to.topRows(k) /= s;
    from.topRows(k) /= s;
    return;
  }
  for (ArrayXd* diagonal : {&zz_, &zv_, &vz_, &vv_}) diagonal->resize(k);
  for (Index i = 0; i < k; ++i) {
    const auto [h, p, r] = OscillatorStep::over(basis.square[i], basis.rate[i], interval);
    zz_[i] = -basis.square[i] * p;
    zv_[i] = h;
    vz_[i] = -basis.square[i] * h;
    vv_[i] = -basis.square[i] * p - basis.rate[i] * h;
    from.row(i) = (p - r / interval) * loads.row(i);
    to.row(i) = (r / interval) * loads.row(i);
    from.row(k + i) = (h - p / interval) * loads.row(i);
    to.row(k + i) = (p / interval) * loads.row(i);
  }
}

MatrixXd ModalTransition::apply(const MatrixXd& states) const {
  if (coupled_) return states + increment_ * states;
  const Index k = zz_.size();
  MatrixXd next(states.rows(), states.cols());
  for (Index column = 0; column < states.cols(); ++column) {
    const auto z = states.col(column).head(k).array(), v = states.col(column).tail(k).array();
    next.col(column).head(k) = z + (zz_ * z + zv_ * v);
    next.col(column).tail(k) = v + (vz_ * z + vv_ * v);
  }
  return next;
}

MatrixXd ModalTransition::apply_to_rows(const MatrixXd& rows) const {
  if (coupled_) return rows + rows * increment_;
  const Index k = zz_.size();
  MatrixXd next(rows.rows(), rows.cols());
  for (Index row = 0; row < rows.rows(); ++row) {
    const auto z = rows.row(row).head(k).transpose().array(), v = rows.row(row).tail(k).transpose().array();
    next.row(row).head(k) = (z + (z * zz_ + v * vz_)).matrix().transpose();
    next.row(row).tail(k) = (v + (z * zv_ + v * vv_)).matrix().transpose();
  }
  return next;
}

}  // namespace beamid::fem
