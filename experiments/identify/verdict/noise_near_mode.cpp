#include "experiments/identify/verdict/noise_near_mode.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/QR>

#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"

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

namespace {

using Complex = std::complex<double>;

constexpr double line_samples_per_cycle = 8, line_band = 1.6, slope_deviation = 2, least_weight = 2;
constexpr Index kernel_and_more = 50;  // samples that must be left of the signal

/// Orthonormal basis of what the fit can follow (n x 5): e^(s t), t e^(s t) and 1.
MatrixXd fitted_space(const DecimatedSignal& coarse, const ModalEstimate& modal) {
  const Index n = coarse.samples.size();
  MatrixXd columns = MatrixXd::Ones(n, 5);
  for (Index k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(n);
    const Complex e = std::exp(modal.rate() * (coarse.interval * static_cast<double>(k)));
    columns.block<1, 4>(k, 0) << e.real(), e.imag(), t * e.real(), t * e.imag();
  }
  columns.colwise().normalize();
  return Eigen::HouseholderQR<MatrixXd>(columns).householderQ() * MatrixXd::Identity(n, columns.cols());
}

/// Of the lines around the mode: what is left (P), the share of it that the fit does not take (w), and
/// log(f_k / f).
struct SpectralLines {
  std::vector<double> left, weight, log_frequency;
};

SpectralLines lines_of(const DecimatedSignal& coarse, const ModalEstimate& modal) {
  const MatrixXd space = fitted_space(coarse, modal);
  MatrixXd columns(space.rows(), space.cols() + 1);
  columns << coarse.samples - space * (space.transpose() * coarse.samples), space;
  const double line = 1 / (static_cast<double>(space.rows()) * coarse.interval);  // [Hz]
  const auto first = std::max<Index>(1, static_cast<Index>(std::ceil(modal.frequency_hz / line_band / line))),
             last = static_cast<Index>(modal.frequency_hz * line_band / line);
  SpectralLines lines;
  double sum = 0;
  Eigen::MatrixXcd found;
  for (Index k = first, begin = first; (k <= last || sum < least_weight) && 2 * k < space.rows(); ++k) {
    if (k == begin + found.cols()) {
      begin = k;
      found = lines_between(columns, k, std::max<Index>(1, std::min(last, (space.rows() - 1) / 2) - k + 1));
    }
    const VectorXd power = found.col(k - begin).cwiseAbs2() / static_cast<double>(space.rows());
    lines.left.push_back(power[0]);
    lines.weight.push_back(std::max(0.0, 1 - power.tail(space.cols()).sum()));
    lines.log_frequency.push_back(std::log(static_cast<double>(k) * line / modal.frequency_hz));
    sum += lines.weight.back();
  }
  return lines;
}

}  // namespace

NoiseNearMode noise_near_mode(const VectorXd& signal, double interval, const ModalEstimate& modal) {
  constexpr int most_steps = 100;
  constexpr double settled = 1e-10, prior = 1 / (slope_deviation * slope_deviation);
  const int factor = decimation_factor(1 / (interval * modal.frequency_hz * line_samples_per_cycle),
                                       signal.size() / kernel_and_more);
  const DecimatedSignal coarse =
      decimate(with_mode_in_gaps(signal, interval, modal.rate()), interval, factor);
  const double measured =
      static_cast<double>(signal.array().isFinite().count()) / static_cast<double>(signal.size());
  const SpectralLines lines = lines_of(coarse, modal);
  const auto count = static_cast<Index>(lines.left.size());
  const Eigen::Map<const Eigen::ArrayXd> left(lines.left.data(), count), weight(lines.weight.data(), count),
      u(lines.log_frequency.data(), count);
  if (!(weight.sum() > 0)) return {modal.noise_standard_deviation, 1, 0, 0};
  Eigen::Matrix2d information;  // expected, of a and b
  information << weight.sum(), (weight * u).sum(), (weight * u).sum(), (weight * u * u).sum() + prior;
  const Eigen::Matrix2d covariance = information.inverse();
  NoiseNearMode result{0, measured * 2 / covariance(0, 0), 0, static_cast<int>(count)};
  if (!(left.sum() > 0)) return result;
  Eigen::Vector2d x(std::log(left.sum() / weight.sum()), 0);
  for (int i = 0; i < most_steps; ++i) {  // Fisher's scoring
    const Eigen::ArrayXd surplus = left * (-x[0] - x[1] * u).exp() - weight;
    Eigen::Vector2d step = covariance * Eigen::Vector2d(surplus.sum(), (surplus * u).sum() - prior * x[1]);
    step /= std::max(1.0, step.cwiseAbs().maxCoeff());
    x += step;
    if (step.norm() < settled) break;
  }
  // mean of e^a for a density of one, to first order: bias of a and half its variance
  const Eigen::ArrayXd variance = covariance(0, 0) + 2 * covariance(0, 1) * u + covariance(1, 1) * u * u;
  const Eigen::Vector2d pull((weight * variance).sum(), (weight * variance * u).sum());
  const double mean = 1 - covariance.row(0).dot(pull) / 2 + covariance(0, 0) / 2;
  result.deviation = std::exp(x[0] / 2) / std::sqrt(std::max(0.5, mean)) *
                     std::sqrt(static_cast<double>(coarse.factor) / measured);
  result.slope = x[1];
  return result;
}

}  // namespace beamid::experiments
