#include "experiments/modal/joint_decay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// e^(rate t) at t = 0, dt, ..., (N - 1) dt: an exponential for one sample of 64, a product for the others.
Eigen::VectorXcd wave_of(Complex rate, double interval, Index count) {
  constexpr Index span = 64;
  Eigen::VectorXcd wave(count);
  const Index first = std::min(span, count);
  for (Index k = 0; k < first; ++k) wave[k] = std::exp(rate * (interval * static_cast<double>(k)));
  for (Index begin = span; begin < count; begin += span) {
    const Complex turn = std::exp(rate * (interval * static_cast<double>(begin)));
    const double re = turn.real(), im = turn.imag();
    const Index samples = std::min(span, count - begin);
    for (Index k = 0; k < samples; ++k) {  // by parts: the product of the library looks for infinities
      const double a = wave[k].real(), b = wave[k].imag();
      wave[begin + k] = {re * a - im * b, re * b + im * a};
    }
  }
  return wave;
}

void check_joint_decay_fit(const MatrixXd& outputs, double interval, const std::vector<Complex>& start) {
  const std::size_t fewest = 2 * (4 * start.size() + 1);
  const bool oscillating = std::all_of(start.begin(), start.end(), [](Complex rate) {
    return rate.imag() > 0 && std::isfinite(rate.imag()) && std::isfinite(rate.real());
  });
  if (!start.empty() && oscillating && interval > 0 && outputs.allFinite() && outputs.rows() > 0 &&
      static_cast<std::size_t>(outputs.cols()) >= fewest)
    return;
  std::ostringstream message;
  message << "fit of " << start.size() << " damped sines to " << outputs.rows() << " channels of "
          << outputs.cols() << " samples; expected at least " << fewest
          << " finite samples and one or more rates of positive angular frequency";
  throw std::invalid_argument(message.str());
}

/// The problem at given rates, with the best amplitudes.
struct JointLinearisation {
  MatrixXd parts;                ///< (2K+1 x p) amplitudes (Re, Im) and offset
  MatrixXd residuals;            ///< (N x p)
  std::vector<MatrixXd> slopes;  ///< (N x 2K) of each channel, without what amplitudes can follow
  VectorXd variances;            ///< (p)
  MatrixXd normal;               ///< J^T J of the rates, every channel in units of its noise (2K x 2K)
  VectorXd gradient;             ///< J^T r
  double misfit = 0;             ///< minus twice the logarithm of the likelihood, and a constant
};

JointLinearisation linearise(const MatrixXd& y, double interval, const VectorXd& rates) {
  const Index count = y.rows(), modes = rates.size() / 2;
  Eigen::MatrixXcd waves(count, modes);
  MatrixXd basis(count, 2 * modes + 1);
  for (Index m = 0; m < modes; ++m) {
    waves.col(m) = wave_of({-rates[2 * m + 1], rates[2 * m]}, interval, count);
    basis.col(2 * m) = waves.col(m).real();
    basis.col(2 * m + 1) = -waves.col(m).imag();
  }
  basis.col(2 * modes).setOnes();
  const Eigen::HouseholderQR<MatrixXd> qr(basis);
  const MatrixXd range = qr.householderQ() * MatrixXd::Identity(count, basis.cols());
  const MatrixXd projected = range.transpose() * y;
  JointLinearisation at;
  at.parts = qr.matrixQR().topRows(basis.cols()).triangularView<Eigen::Upper>().solve(projected);
  at.residuals = y - range * projected;
  const VectorXd floor = 1e-26 * y.colwise().squaredNorm().transpose().cwiseMax(1e-280);
  at.variances =
      at.residuals.colwise().squaredNorm().transpose().cwiseMax(floor) / static_cast<double>(count);
  at.misfit = static_cast<double>(count) * at.variances.array().log().sum();
  const VectorXd time = interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  at.normal = MatrixXd::Zero(2 * modes, 2 * modes);
  at.gradient = VectorXd::Zero(2 * modes);
  for (Index c = 0; c < y.cols(); ++c) {
    MatrixXd slope(count, 2 * modes);
    for (Index m = 0; m < modes; ++m) {
      const Eigen::VectorXcd motion = Complex(at.parts(2 * m, c), at.parts(2 * m + 1, c)) * waves.col(m);
      slope.col(2 * m) = -time.cwiseProduct(motion.imag());
      slope.col(2 * m + 1) = -time.cwiseProduct(motion.real());
    }
    slope -= range * (range.transpose() * slope);
    at.normal += slope.transpose() * slope / at.variances[c];
    at.gradient += slope.transpose() * at.residuals.col(c) / at.variances[c];
    at.slopes.push_back(std::move(slope));
  }
  return at;
}

/// Variance of white noise as dense as a residual (N) is around w [rad/s]: its periodogram under a Hann
/// window, the mean over 8 of its resolutions to either side.
double local_variance(const VectorXd& residual, double interval, double w) {
  const Index count = residual.size();
  const double turn = 2 * std::numbers::pi / static_cast<double>(count);
  double power = 0, weight = 0;
  VectorXd windowed(count);
  for (Index k = 0; k < count; ++k) {
    const double hann = 1 - std::cos(turn * (static_cast<double>(k) + 0.5));
    windowed[k] = hann * residual[k];
    weight += hann * hann;
  }
  constexpr int bins = 8;
  for (int b = -bins; b <= bins; ++b) {
    const Complex step = std::polar(1.0, -(w * interval + turn * b));
    Complex phase = 1, sum = 0;
    for (Index k = 0; k < count; ++k, phase *= step) sum += windowed[k] * phase;
    power += std::norm(sum) / (2 * bins + 1);
  }
  return power / weight;
}

/// (p x K)
MatrixXd noise_near_modes(const JointLinearisation& at, double interval, const VectorXd& rates) {
  const Index modes = rates.size() / 2, count = at.residuals.rows();
  const double freedom = static_cast<double>(count) / static_cast<double>(count - 4 * modes - 1);
  MatrixXd variance(at.residuals.cols(), modes);
  for (Index c = 0; c < at.residuals.cols(); ++c)
    for (Index m = 0; m < modes; ++m)
      variance(c, m) = freedom * local_variance(at.residuals.col(c), interval, rates[2 * m]);
  return variance;
}

MatrixXd covariance_of(const JointLinearisation& at, const MatrixXd& noise_variance) {
  const Index modes = noise_variance.cols();
  MatrixXd middle = MatrixXd::Zero(2 * modes, 2 * modes);
  for (Index c = 0; c < at.residuals.cols(); ++c) {
    VectorXd density(2 * modes);
    for (Index m = 0; m < modes; ++m) density.segment<2>(2 * m).setConstant(std::sqrt(noise_variance(c, m)));
    const MatrixXd scaled = at.slopes[c] * (density / at.variances[c]).asDiagonal();
    middle += scaled.transpose() * scaled;
  }
  const MatrixXd inverse = at.normal.ldlt().solve(MatrixXd::Identity(2 * modes, 2 * modes));
  return inverse * middle * inverse;
}

void take_own_shifts(const JointLinearisation& at, JointDecayFit& fit) {
  const Index modes = fit.noise_variance.cols(), channels = at.residuals.cols();
  fit.own_shift.setZero(channels, modes);
  fit.own_shift_deviation.setConstant(channels, modes, std::numeric_limits<double>::infinity());
  for (Index c = 0; c < channels; ++c)
    for (Index m = 0; m < modes; ++m) {
      const auto slope = at.slopes[static_cast<std::size_t>(c)].middleCols<2>(2 * m);
      const Eigen::Matrix2d inverse = (slope.transpose() * slope).inverse();
      const double variance = fit.noise_variance(c, m) * inverse(0, 0);
      if (!std::isfinite(variance) || !(variance > 0.0)) continue;
      fit.own_shift(c, m) = (inverse * (slope.transpose() * at.residuals.col(c)))[0];
      fit.own_shift_deviation(c, m) = std::sqrt(variance);
    }
}

}  // namespace

JointDecayFit fit_decays_jointly(const MatrixXd& outputs, double interval,
                                 const std::vector<Complex>& start) {
  check_joint_decay_fit(outputs, interval, start);
  const auto modes = static_cast<Index>(start.size());
  const MatrixXd y = outputs.transpose();
  VectorXd rates(2 * modes);
  for (Index m = 0; m < modes; ++m) rates.segment<2>(2 * m) << start[m].imag(), -start[m].real();
  JointLinearisation at = linearise(y, interval, rates);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(at.normal, damping, at.gradient);
  };
  const auto take = [&](const VectorXd& tried) {
    // A step that gains less than 1e-9 of a standard deviation, or moves the rates by rounding only, ends it.
    const bool settled = tried.dot(at.normal * tried) < 1e-18 || tried.norm() < 1e-13 * rates.norm();
    JointLinearisation next = linearise(y, interval, rates + tried);
    const bool lower = next.misfit <= at.misfit;
    if (lower) rates += tried, at = std::move(next);
    return filters::TriedStep{lower ? 1.0 : 0.0, settled};
  };
  const filters::MarquardtDamping rule;
  if (filters::levenberg_marquardt(rule, step, take) == filters::DescentEnd::exhausted)
    throw std::runtime_error("least squares of " + std::to_string(modes) +
                             " damped sines did not converge in " + std::to_string(rule.most_steps) +
                             " steps");
  JointDecayFit fit;
  fit.shapes.resize(y.cols(), modes);
  for (Index m = 0; m < modes; ++m) {
    fit.rates.emplace_back(-rates[2 * m + 1], rates[2 * m]);
    fit.shapes.col(m) = at.parts.row(2 * m).transpose().cast<Complex>() +
                        Complex(0, 1) * at.parts.row(2 * m + 1).transpose().cast<Complex>();
  }
  fit.offsets = at.parts.row(2 * modes).transpose();
  fit.reconstruction = (y - at.residuals).transpose();
  fit.residual_standard_deviation =
      at.residuals.colwise().norm().transpose() / std::sqrt(static_cast<double>(y.rows() - 4 * modes - 1));
  fit.noise_variance = noise_near_modes(at, interval, rates);
  fit.covariance = covariance_of(at, fit.noise_variance);
  take_own_shifts(at, fit);
  return fit;
}

namespace {

/// Numbers, each with a deviation, that should be one.
struct Scatter {
  double mean = 0.0, squares = 0.0;  ///< squares of distances from the mean, in deviations
  double farthest = 0.0;             ///< distance from the mean, of those beyond two deviations
  Index freedom = 0;
};

Scatter scatter_of(const VectorXd& values, const VectorXd& deviations) {
  Scatter found;
  double weights = 0.0;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(deviations[i]) || !(deviations[i] > 0.0)) continue;
    const double weight = std::pow(deviations[i], -2);
    found.mean += weight * values[i], weights += weight, ++found.freedom;
  }
  if (--found.freedom < 1) return {};
  found.mean /= weights;
  for (Index i = 0; i < values.size(); ++i)
    if (std::isfinite(deviations[i]) && deviations[i] > 0.0) {
      const double distance = std::abs(values[i] - found.mean);
      found.squares += std::pow(distance / deviations[i], 2);
      if (distance > 2.0 * deviations[i]) found.farthest = std::max(found.farthest, distance);
    }
  return found;
}

/// Of each channel, over its modes: relative to the joint frequencies, with its deviation.
std::pair<VectorXd, VectorXd> clock_rates(const JointDecayFit& fit) {
  const Index channels = fit.own_shift.rows();
  VectorXd rates = VectorXd::Zero(channels), deviations(channels);
  for (Index c = 0; c < channels; ++c) {
    double weights = 0.0;
    for (Index m = 0; m < fit.own_shift.cols(); ++m) {
      const double w = fit.rates[static_cast<std::size_t>(m)].imag(),
                   weight = std::pow(w / fit.own_shift_deviation(c, m), 2);
      if (!(weight > 0.0) || !std::isfinite(weight)) continue;
      rates[c] += weight * fit.own_shift(c, m) / w, weights += weight;
    }
    rates[c] /= std::max(weights, 1e-300);
    deviations[c] = 1.0 / std::sqrt(weights);
  }
  return {rates, deviations};
}

}  // namespace

std::optional<ClockScatter> clock_scatter(const JointDecayFit& fit) {
  constexpr double by_chance = 1e-6;
  ClockScatter found;
  found.farthest.resize(fit.own_shift.cols());
  for (Index m = 0; m < fit.own_shift.cols(); ++m) {
    const Scatter mode = scatter_of(fit.own_shift.col(m), fit.own_shift_deviation.col(m));
    found.chi_square += mode.squares, found.freedom += static_cast<double>(mode.freedom);
    found.farthest[m] = mode.farthest;
  }
  if (found.freedom < 1.0 || !(found.chi_square > chi_square_limit(found.freedom, 1.0 - by_chance)))
    return {};
  const auto [rates, deviations] = clock_rates(fit);
  // A clock that runs fast counts more seconds in which the structure rings slower.
  found.apart = rates.maxCoeff(&found.slow) - rates.minCoeff(&found.fast);
  found.deviation = std::hypot(deviations[found.fast], deviations[found.slow]);
  return found;
}

std::string ClockScatter::sentence(const std::vector<std::string>& channels) const {
  return fmt::format(
      "The channels do not ring at one frequency (chi^2 = {:.3g} of {:.0f}): {} runs {:.2g} ppm faster than "
      "{}, with a standard deviation of {:.2g}. Were they sampled by clocks of their own, or "
      "does another mode ring close by?",
      chi_square, freedom, channels[static_cast<std::size_t>(fast)], 1e6 * apart,
      channels[static_cast<std::size_t>(slow)], 1e6 * deviation);
}

}  // namespace beamid::experiments
