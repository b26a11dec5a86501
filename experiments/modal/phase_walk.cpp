#include "experiments/modal/phase_walk.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <boost/math/distributions/fisher_f.hpp>

#include "experiments/modal/poles.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/in_double.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr Index fewest_sections = 4;

/// Of one mode in the sections where it is seen: when, its phase ahead of the fit's, the logarithm of its
/// amplitude over the fit's, and how well both are known.
struct Phases {
  std::vector<double> time, phase, level, deviation;
};

/// Sections of at least so many periods of the slowest mode and beats of the closest two; 0: too short.
Index sections_of(const JointDecayFit& fit, double duration) {
  constexpr double periods = 6.0, beats = 1.5;
  constexpr Index most = 12;
  std::vector<double> hz;
  for (const Complex& rate : fit.rates) hz.push_back(rate.imag() / (2.0 * std::numbers::pi));
  std::sort(hz.begin(), hz.end());
  double shortest = periods / hz.front();
  for (std::size_t m = 1; m < hz.size(); ++m) shortest = std::max(shortest, beats / (hz[m] - hz[m - 1]));
  const Index count = std::min(most, static_cast<Index>(duration / shortest));
  return count < fewest_sections ? 0 : count;
}

// a^H b of the channels, each in units of its noise.
Complex weighted(const VectorXcd& a, const VectorXcd& b, const VectorXd& variance) {
  return (a.conjugate().array() * b.array() / variance.array().cast<Complex>()).sum();
}

/// @param seen sections where phases are better known than this are [rad]
std::vector<Phases> phases_of(const JointDecayFit& fit, const MatrixXd& record, double interval,
                              Index sections, double seen) {
  const auto modes = static_cast<Index>(fit.rates.size()), size = record.cols() / sections;
  const std::vector<bool> oscillating(fit.rates.size(), true);
  const MatrixXd centred = record.colwise() - fit.offsets;
  std::vector<Phases> found(fit.rates.size());
  for (Index s = 0; s < sections; ++s) {
    const double begin = interval * static_cast<double>(s * size);
    const MatrixXcd own =
        fit_shapes(centred.middleCols(s * size, size), interval, fit.rates, oscillating).shapes;
    for (Index m = 0; m < modes; ++m) {
      const Complex rate = fit.rates[static_cast<std::size_t>(m)];
      const VectorXcd joint = fit.shapes.col(m) * std::exp(rate * begin);
      const VectorXd variance = fit.noise_variance.col(m);
      const double strength = weighted(joint, joint, variance).real();
      // sum over the section of e^(-2 sigma t) / 2, of a cosine's squares
      const double decay = 2.0 * rate.real() * interval;
      const double squares =
          0.5 * (std::abs(decay) < 1e-12 ? static_cast<double>(size)
                                         : std::expm1(decay * static_cast<double>(size)) / std::expm1(decay));
      const double deviation = 1.0 / std::sqrt(strength * squares);
      if (!(deviation < seen)) continue;
      Phases& one = found[static_cast<std::size_t>(m)];
      one.time.push_back(begin + 0.5 * interval * static_cast<double>(size));
      const Complex ratio = weighted(joint, own.col(m), variance) / strength;
      one.phase.push_back(std::arg(ratio));
      one.level.push_back(std::log(std::abs(ratio)));
      one.deviation.push_back(deviation);
    }
  }
  return found;
}

/// chi^2 of the phases about a smooth function of time, of the levels about another, and what a walk of q = 1
/// adds to that of the phases in the mean.
struct Scatter {
  double squares = 0.0, of_levels = 0.0, freedom = 0.0, by_walk = 0.0;
};

/// Smooth (n x 2 or 5): a line; against amplitudes 1, t, t^2, A and A^2 of the amplitude A, as phases of a
/// frequency that follows it have them.
MatrixXd smooth_functions(const VectorXd& time, double decay_rate, WalkAgainst against) {
  MatrixXd smooth(time.size(), against == WalkAgainst::noise ? 2 : 5);
  const Eigen::ArrayXd t = time.array() / time[time.size() - 1],
                       amplitude = (-decay_rate * time.array()).exp();
  smooth.leftCols(2) << VectorXd::Ones(time.size()), t.matrix();
  if (smooth.cols() > 2) smooth.rightCols(3) << t.square(), amplitude, amplitude.square();
  return smooth;
}

Scatter scatter_of(const Phases& one, double section, double decay_rate, WalkAgainst against) {
  const auto count = static_cast<Index>(one.time.size());
  if (count < fewest_sections) return {};
  const auto values = [count](const std::vector<double>& of) { return VectorXd::Map(of.data(), count); };
  const VectorXd time = values(one.time), weight = values(one.deviation).cwiseInverse();
  const MatrixXd smooth = weight.asDiagonal() * smooth_functions(time, decay_rate, against);
  if (count <= smooth.cols()) return {};
  MatrixXd means(count, count);  // of a walk from 0 over each section: covariance
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) means(i, j) = i == j ? time[i] - section / 6.0 : time[std::min(i, j)];
  MatrixXd whole(count, count + 2);
  whole << MatrixXd(weight.asDiagonal()), values(one.phase).cwiseProduct(weight),
      values(one.level).cwiseProduct(weight);
  whole -= smooth * least_squares(smooth, whole);
  const MatrixXd left = whole.leftCols(count);
  return {whole.col(count).squaredNorm(), whole.col(count + 1).squaredNorm(),
          static_cast<double>(count - smooth.cols()), (left * means * left.transpose()).trace()};
}

/// Of all modes; the walk is that of q / omega^2 = 1 [1/s^2].
Scatter scatter_of(const std::vector<Phases>& phases, const JointDecayFit& fit, double section,
                   WalkAgainst against) {
  Scatter all;
  for (std::size_t m = 0; m < phases.size(); ++m) {
    const Scatter one = scatter_of(phases[m], section, -fit.rates[m].real(), against);
    all.squares += one.squares, all.of_levels += one.of_levels, all.freedom += one.freedom;
    all.by_walk += std::pow(fit.rates[m].imag(), 2) * one.by_walk;
  }
  return all;
}

/// A point of the ratio of two mean squares of so many degrees of freedom each.
double variance_ratio_limit(double freedom, double probability) {
  return quantile(boost::math::fisher_f_distribution<double, InDouble>(freedom, freedom), probability);
}

constexpr double weak = 0.1, near = 0.1;  // of a stronger mode's amplitude and frequency

/// The weak modes beside a strong one that have its shape in several channels: a phase that wanders has such
/// sidebands, which would take up its walk.
std::vector<std::size_t> sidebands_of(const JointDecayFit& fit) {
  constexpr double alike = 0.98;
  const auto in_noise = [&](std::size_t m) {
    const auto column = static_cast<Index>(m);
    return VectorXcd(fit.shapes.col(column).array() / fit.noise_variance.col(column).array().sqrt());
  };
  std::vector<std::size_t> found;
  for (std::size_t m = 0; m < fit.rates.size() && fit.shapes.rows() > 1; ++m)
    for (std::size_t n = 0; n < fit.rates.size(); ++n) {
      const double w = fit.rates[n].imag();
      const VectorXcd one = in_noise(m), other = in_noise(n);
      if (!(one.norm() < weak * other.norm()) || !(std::abs(fit.rates[m].imag() - w) < near * w) ||
          !(modal_assurance(one, other) > alike))
        continue;
      found.push_back(m);
      break;
    }
  return found;
}

/// The fit without some of its modes; absent where that fails.
std::optional<JointDecayFit> without(const std::vector<std::size_t>& left_out, const JointDecayFit& fit,
                                     const MatrixXd& record, double interval) {
  std::vector<Complex> rates;
  for (std::size_t m = 0; m < fit.rates.size(); ++m)
    if (std::ranges::find(left_out, m) == left_out.end()) rates.push_back(fit.rates[m]);
  try {
    return fit_decays_jointly(record, interval, rates);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

void WalkDeviation::widen(double& of_frequency_hz, double& of_damping_ratio) const {
  of_frequency_hz = std::hypot(of_frequency_hz, frequency_hz);
  of_damping_ratio = std::hypot(of_damping_ratio, damping_ratio);
}

WalkDeviation PhaseWalk::deviation(Complex rate) const {
  const double w = rate.imag(), q = w * w * clock;
  return {std::sqrt(q * std::max(-0.5 * rate.real(), 1.2 / duration)) / (2.0 * std::numbers::pi),
          0.25 * q / w};
}

bool PhaseWalk::is_sure() const {
  constexpr double surely = 1.0 - 1e-4;
  return squares > chi_square_limit(freedom, surely) || over_levels > variance_ratio_limit(freedom, surely);
}

std::string PhaseWalk::sentence() const {
  return fmt::format(
      "The modes do not keep their phases ({} in {} sections of the record). They "
      "wander as under a clock that is {:.2g} ms off after {:.3g} s of intervals that scatter, or under "
      "frequencies that change. Standard deviations allow for such a walk.",
      over_levels > 0.0
          ? fmt::format("which scatter {:.3g} times as much as amplitudes", std::sqrt(over_levels))
          : fmt::format("chi^2 = {:.3g} of {:.0f}", squares, freedom),
      sections, 1e3 * std::sqrt(clock * duration), duration);
}

std::optional<PhaseWalk> phase_walk(const JointDecayFit& of_all, const MatrixXd& record, double interval,
                                    WalkAgainst against) {
  constexpr double worth_widening = 1e-2, beyond_amplitudes = 1e-3;  // by chance
  PhaseWalk walk;
  walk.duration = interval * static_cast<double>(record.cols());
  walk.sidebands = sidebands_of(of_all);
  const auto freed =
      walk.sidebands.empty() ? std::nullopt : without(walk.sidebands, of_all, record, interval);
  if (!freed) walk.sidebands.clear();
  const JointDecayFit& fit = freed ? *freed : of_all;
  walk.sections = sections_of(fit, walk.duration);
  if (walk.sections == 0) return {};
  // Deviations count the sidebands of the walk as noise [rad].
  const double seen = against == WalkAgainst::noise ? 0.2 : 0.6;
  const std::vector<Phases> phases = phases_of(fit, record, interval, walk.sections, seen);
  const double section = walk.duration / static_cast<double>(walk.sections);
  const Scatter found = scatter_of(phases, fit, section, against);
  if (found.freedom < 1.0) return {};
  walk.squares = found.squares, walk.freedom = found.freedom;
  double noise = 1.0;
  if (against == WalkAgainst::amplitudes) {
    walk.over_levels = found.squares / found.of_levels;
    if (!(walk.over_levels > variance_ratio_limit(found.freedom, 1.0 - beyond_amplitudes))) return {};
    noise = std::min(noise, found.of_levels / found.freedom);
  } else if (!(found.squares > chi_square_limit(found.freedom, 1.0 - worth_widening))) {
    return {};
  }
  walk.clock = std::max(0.0, found.squares - noise * found.freedom) / found.by_walk;
  return walk;
}

ModalEstimate without_neighbours(ModalEstimate mode) {
  std::erase_if(mode.companions, [&](const CompanionMode& other) {
    return std::abs(other.frequency_hz - mode.frequency_hz) < near * mode.frequency_hz;
  });
  return mode;
}

}  // namespace beamid::experiments
