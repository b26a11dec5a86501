#include "experiments/modal/channel_fault.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Lines of both spectra in a band.
struct Lines {
  std::vector<double> frequency;
  std::vector<Complex> base, response;

  Index size() const { return static_cast<Index>(frequency.size()); }
  Lines within(double from, double to) const {
    Lines part;
    for (std::size_t i = 0; i < frequency.size(); ++i) {
      if (frequency[i] < from || frequency[i] > to) continue;
      part.frequency.push_back(frequency[i]);
      part.base.push_back(base[i]);
      part.response.push_back(response[i]);
    }
    return part;
  }
};

// Its mean removed, a twentieth at each end raised from zero by half a cosine.
std::vector<double> tapered_ends(const VectorXd& signal) {
  const Index n = signal.size(), edge = std::max<Index>(1, n / 20);
  const double mean = signal.mean();
  std::vector<double> result(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) {
    const Index from_end = std::min(k, n - 1 - k);
    const double share = from_end < edge
                             ? 0.5 - 0.5 * std::cos(std::numbers::pi * (static_cast<double>(from_end) + 0.5) /
                                                    static_cast<double>(edge))
                             : 1.0;
    result[static_cast<std::size_t>(k)] = share * (signal[k] - mean);
  }
  return result;
}

Lines lines_of(const VectorXd& base, const VectorXd& response, double interval) {
  Eigen::FFT<double> transform;
  std::vector<Complex> u, y;
  const Index length = fast_length_within(base.size());
  transform.fwd(u, tapered_ends(base.head(length)));
  transform.fwd(y, tapered_ends(response.head(length)));
  Lines lines;
  const double duration = interval * static_cast<double>(length);
  for (std::size_t k = 4; k < u.size() / 2; ++k) {
    lines.frequency.push_back(static_cast<double>(k) / duration);
    lines.base.push_back(u[k]);
    lines.response.push_back(y[k]);
  }
  return lines;
}

// The lowest peak of the smoothed |Y| / |U| that is half as high as the highest.
double lowest_peak(const Lines& lines) {
  constexpr double width = 1.08, step = 1.02;
  std::vector<double> frequency, ratio;
  for (double f = width * lines.frequency.front(); f < lines.frequency.back() / width; f *= step) {
    double above = 0.0, below = 0.0;
    const auto first = std::lower_bound(lines.frequency.begin(), lines.frequency.end(), f / width);
    for (auto at = static_cast<std::size_t>(first - lines.frequency.begin());
         at < lines.frequency.size() && lines.frequency[at] < f * width; ++at)
      above += std::norm(lines.response[at]), below += std::norm(lines.base[at]);
    if (!(below > 0.0)) continue;
    frequency.push_back(f);
    ratio.push_back(std::sqrt(above / below));
  }
  if (ratio.size() < 8)
    throw std::invalid_argument("the record is too short for a spectrum; expected 16 lines");
  const double highest = *std::max_element(ratio.begin() + 2, ratio.end() - 2);
  for (std::size_t i = 2; i + 2 < ratio.size(); ++i)
    if (ratio[i] >= 0.5 * highest && ratio[i] >= *std::max_element(ratio.begin() + static_cast<long>(i) - 2,
                                                                   ratio.begin() + static_cast<long>(i) + 3))
      return frequency[i];
  throw std::invalid_argument("the response over the base has no peak");
}

// Real and imaginary parts below each other: of Gamma's and rho's column, and of Y - U.
struct Equations {
  MatrixXd columns;  // (2M x 2)
  VectorXd relative;
};

Equations equations_at(const Lines& lines, double f1, double ratio) {
  const Index m = lines.size();
  Equations result{MatrixXd(2 * m, 2), VectorXd(2 * m)};
  for (Index k = 0; k < m; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double f = lines.frequency[at];
    const Complex mode = lines.base[at] * f * f / (f1 * f1 - f * f + Complex(0.0, 2.0 * ratio * f1 * f)),
                  rest = lines.base[at] * f * f / (f1 * f1), relative = lines.response[at] - lines.base[at];
    result.columns.row(k) << mode.real(), rest.real();
    result.columns.row(m + k) << mode.imag(), rest.imag();
    result.relative[k] = relative.real();
    result.relative[m + k] = relative.imag();
  }
  return result;
}

// [ln f1, ln xi] with the best Gamma and rho.
struct Fit {
  VectorXd linear, residual;  // (2), (2M)
};

Fit fitted_at(const Lines& lines, const Eigen::Vector2d& logarithms) {
  const Equations at = equations_at(lines, std::exp(logarithms[0]), std::exp(logarithms[1]));
  const VectorXd linear = at.columns.colPivHouseholderQr().solve(at.relative);
  return {linear, at.relative - at.columns * linear};
}

VectorXd residual_of(const Lines& lines, const Eigen::Vector4d& all) {
  const Equations at = equations_at(lines, std::exp(all[0]), std::exp(all[1]));
  return at.relative - at.columns * all.tail<2>();
}

// By all four constants, differences.
MatrixXd slopes_at(const Lines& lines, const Eigen::Vector4d& all) {
  MatrixXd slopes(2 * lines.size(), 4);
  for (Index j = 0; j < 4; ++j) {
    const double step = 1e-5 * std::max(1.0, std::abs(all[j]));
    Eigen::Vector4d up = all, down = all;
    up[j] += step, down[j] -= step;
    slopes.col(j) = (residual_of(lines, up) - residual_of(lines, down)) / (2.0 * step);
  }
  return slopes;
}

// Levenberg and Marquardt from the best of several damping ratios.
Eigen::Vector4d least_squares_fit(const Lines& lines, double start_hz) {
  Eigen::Vector4d best;
  double least = std::numeric_limits<double>::infinity();
  for (const double shift : {0.85, 0.92, 1.0, 1.08})
    for (const double ratio : {0.02, 0.05, 0.1, 0.2}) {
      const Eigen::Vector2d there(std::log(shift * start_hz), std::log(ratio));
      const Fit fit = fitted_at(lines, there);
      if (fit.residual.squaredNorm() >= least) continue;
      least = fit.residual.squaredNorm();
      best << there, fit.linear;
    }
  double weight = 1e-3;
  for (int i = 0; i < 60; ++i) {
    const MatrixXd slopes = slopes_at(lines, best);
    MatrixXd curvature = slopes.transpose() * slopes;
    curvature.diagonal() *= 1.0 + weight;
    const Eigen::Vector4d step = -curvature.ldlt().solve(slopes.transpose() * residual_of(lines, best));
    const double there = residual_of(lines, best + step).squaredNorm();
    if (there < least) {
      const bool done = least - there < 1e-12 * least;
      best += step, least = there, weight *= 0.3;
      if (done) break;
    } else if ((weight *= 10.0) > 1e8) {
      break;
    }
  }
  return best;
}

}  // namespace

BaseResponse base_response(const VectorXd& base, const VectorXd& response, double interval,
                           const std::optional<std::pair<double, double>>& band_hz) {
  Lines all = lines_of(base, response, interval);
  if (band_hz) all = all.within(band_hz->first, band_hz->second);
  if (all.size() < 16)
    throw std::invalid_argument(
        fmt::format("{} lines of the spectrum lie in the band; expected 16, a longer record or a wider band",
                    all.size()));
  const double peak = lowest_peak(all);
  BaseResponse found;
  found.band_hz = band_hz.value_or(std::pair{0.5 * peak, 1.5 * peak});
  const Lines lines = all.within(found.band_hz.first, found.band_hz.second);
  if (lines.size() < 16)
    throw std::invalid_argument(
        fmt::format("{} lines of the spectrum lie about the peak at {:.3g} Hz; expected 16, a "
                    "longer record",
                    lines.size(), peak));
  const Eigen::Vector4d fit = least_squares_fit(lines, peak);
  const VectorXd left = residual_of(lines, fit);
  const MatrixXd slopes = slopes_at(lines, fit);
  const double variance = left.squaredNorm() / static_cast<double>(left.size() - 4);
  const MatrixXd covariance = variance * (slopes.transpose() * slopes).ldlt().solve(MatrixXd::Identity(4, 4));
  found.frequency_hz = std::exp(fit[0]);
  found.frequency_deviation_hz = found.frequency_hz * std::sqrt(covariance(0, 0));
  found.damping_ratio = std::exp(fit[1]);
  found.damping_ratio_deviation = found.damping_ratio * std::sqrt(covariance(1, 1));
  found.participation = fit[2];
  found.left_percent =
      100.0 * left.norm() / equations_at(lines, found.frequency_hz, found.damping_ratio).relative.norm();
  constexpr double no_mode = 50.0;
  if (!(found.left_percent < no_mode) || found.frequency_hz < found.band_hz.first ||
      found.frequency_hz > found.band_hz.second)
    throw std::invalid_argument(
        fmt::format("one mode near {:.3g} Hz does not explain {:.0f} % of the motion between {:.3g} and "
                    "{:.3g} Hz; expected less than {:.0f} %: another band, or no such mode",
                    peak, found.left_percent, found.band_hz.first, found.band_hz.second, no_mode));
  return found;
}

namespace {

constexpr double much_less = 0.7, overdamped = 0.3;

std::optional<BaseResponse> response_if_any(const VectorXd& base, const VectorXd& response, double interval) {
  try {
    return base_response(base, response, interval, {});
  } catch (const std::invalid_argument&) {
    return {};
  }
}

double largest_swing(const VectorXd& signal) {
  return (signal.array() - signal.mean()).abs().maxCoeff();
}

}  // namespace

ChannelFault channel_fault(const VectorXd& base, const VectorXd& response, double interval) {
  const std::optional<BaseResponse> found = response_if_any(base, response, interval);
  ChannelFault best;
  double least = found ? found->left_percent : std::numeric_limits<double>::infinity();
  const double left = least;
  const auto consider = [&](ChannelFault::Kind kind, int samples, const std::optional<BaseResponse>& changed,
                            double share) {
    if (!changed || !(changed->left_percent < share * left) || !(changed->left_percent < least) ||
        !(changed->participation > 0.0) || changed->damping_ratio > overdamped)
      return;
    least = changed->left_percent;
    best = {kind, samples, *changed, left};
  };
  // The band is that of the same peak: neither change moves |Y| / |U|.
  const bool negative = found && found->participation < 0.0;
  consider(ChannelFault::Kind::reversed, 0, response_if_any(base, -response, interval),
           negative ? 1.0 : much_less);
  for (int late = -most_late_samples; late <= most_late_samples; ++late) {
    const Index n = base.size() - std::abs(late);
    if (late == 0 || n < 2) continue;
    const VectorXd &first = late > 0 ? base : response, &second = late > 0 ? response : base;
    const VectorXd head = first.head(n), tail = second.tail(n);
    consider(ChannelFault::Kind::late, late,
             late > 0 ? response_if_any(head, tail, interval) : response_if_any(tail, head, interval),
             much_less);
  }
  const bool too_damped = found && found->damping_ratio > overdamped;
  if (too_damped || largest_swing(response) < largest_swing(base))
    consider(ChannelFault::Kind::exchanged, 0, response_if_any(response, base, interval),
             too_damped ? 1.0 : much_less);
  return best;
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
