#include "experiments/identify/mode_residual.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/modal/shape_fit.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Re and Im of e^(rate t), at most 1 in size, and 1 (N x 3).
MatrixXd columns_of(const VectorXd& time, Complex rate) {
  const double origin = rate.real() > 0 ? time[time.size() - 1] : time[0];
  MatrixXd columns = MatrixXd::Ones(time.size(), 3);
  for (Index k = 0; k < time.size(); ++k) {
    const Complex value = std::exp(rate * (time[k] - origin));
    columns(k, 0) = value.real(), columns(k, 1) = -value.imag();
  }
  return columns;
}

bool even(const VectorXd& time) {
  constexpr double same = 1e-3;  // of an interval, over all of them
  const double count = static_cast<double>(time.size() - 1),
               interval = (time[time.size() - 1] - time[0]) / count;
  const VectorXd grid = VectorXd::LinSpaced(time.size(), time[0], time[time.size() - 1]);
  return (time - grid).cwiseAbs().maxCoeff() < same * interval;
}

}  // namespace

ModeResidual mode_residual(const MatrixXd& samples, const VectorXd& time, Complex rate) {
  if (samples.allFinite() && even(time)) {
    const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
    const ShapeFit fit = fit_shapes(samples, interval, {rate, 0.0}, {true, false});
    return {fit.reconstruction, fit.residual_standard_deviation};
  }
  const MatrixXd columns = columns_of(time, rate);
  ModeResidual result{MatrixXd(samples.rows(), samples.cols()), VectorXd(samples.rows())};
  for (Index i = 0; i < samples.rows(); ++i) {
    std::vector<Index> measured;
    for (Index k = 0; k < samples.cols(); ++k)
      if (std::isfinite(samples(i, k))) measured.push_back(k);
    const VectorXd y = samples.row(i).transpose()(measured);
    VectorXd parts = VectorXd::Zero(columns.cols());
    if (!measured.empty()) parts = MatrixXd(columns(measured, Eigen::all)).colPivHouseholderQr().solve(y);
    const VectorXd motion = columns * parts;
    result.reproduced.row(i) = motion.transpose();
    const auto freedom = std::max<Index>(1, y.size() - 2 * columns.cols());
    result.standard_deviation[i] = (y - motion(measured)).norm() / std::sqrt(static_cast<double>(freedom));
  }
  return result;
}

VectorXd with_mode_in_gaps(const VectorXd& signal, double interval, Complex rate) {
  if (signal.allFinite()) return signal;
  const VectorXd time =
      VectorXd::LinSpaced(signal.size(), 0.0, interval * static_cast<double>(signal.size() - 1));
  const VectorXd motion = mode_residual(signal.transpose(), time, rate).reproduced.transpose();
  return signal.array().isFinite().select(signal, motion);
}

}  // namespace beamid::experiments
