#include "experiments/modal/phase_walk.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "experiments/modal/poles.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr Index fewest_sections = 4;

/// Of one mode in the sections where it is seen: when, its phase ahead of the fit's, and how well known.
struct Phases {
  std::vector<double> time, phase, deviation;
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

std::vector<Phases> phases_of(const JointDecayFit& fit, const MatrixXd& record, double interval,
                              Index sections) {
  constexpr double surely_seen = 0.2;  // rad
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
      if (!(deviation < surely_seen)) continue;
      Phases& one = found[static_cast<std::size_t>(m)];
      one.time.push_back(begin + 0.5 * interval * static_cast<double>(size));
      one.phase.push_back(std::arg(weighted(joint, own.col(m), variance)));
      one.deviation.push_back(deviation);
    }
  }
  return found;
}

/// chi^2 of the phases about a line, and what a walk of q = 1 adds to it in the mean.
struct Walk {
  double squares = 0.0, freedom = 0.0, by_walk = 0.0;
};

Walk walk_of(const Phases& one, double section) {
  const auto count = static_cast<Index>(one.time.size());
  if (count < fewest_sections) return {};
  const auto values = [count](const std::vector<double>& of) { return VectorXd::Map(of.data(), count); };
  const VectorXd time = values(one.time), weight = values(one.deviation).cwiseInverse();
  MatrixXd line(count, 2), means(count, count);  // covariance of the means of a walk from 0 over each section
  line << weight, time.cwiseProduct(weight);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) means(i, j) = i == j ? time[i] - section / 6.0 : time[std::min(i, j)];
  MatrixXd whole(count, count + 1);
  whole << MatrixXd(weight.asDiagonal()), values(one.phase).cwiseProduct(weight);
  whole -= line * least_squares(line, whole);
  const MatrixXd left = whole.leftCols(count);
  return {whole.col(count).squaredNorm(), static_cast<double>(count - 2),
          (left * means * left.transpose()).trace()};
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
  return squares > chi_square_limit(freedom, 1.0 - 1e-4);
}

std::string PhaseWalk::sentence() const {
  return fmt::format(
      "The modes do not keep their phases (chi^2 = {:.3g} of {:.0f} in {} sections of the record). They "
      "wander as under a clock that is {:.2g} ms off after {:.3g} s of intervals that scatter, or under "
      "frequencies that change. Standard deviations allow for such a walk.",
      squares, freedom, sections, 1e3 * std::sqrt(clock * duration), duration);
}

std::optional<PhaseWalk> phase_walk(const JointDecayFit& of_all, const MatrixXd& record, double interval) {
  constexpr double worth_widening = 1e-2;  // by chance
  PhaseWalk walk;
  walk.duration = interval * static_cast<double>(record.cols());
  walk.sidebands = sidebands_of(of_all);
  const auto freed =
      walk.sidebands.empty() ? std::nullopt : without(walk.sidebands, of_all, record, interval);
  if (!freed) walk.sidebands.clear();
  const JointDecayFit& fit = freed ? *freed : of_all;
  walk.sections = sections_of(fit, walk.duration);
  if (walk.sections == 0) return {};
  const std::vector<Phases> phases = phases_of(fit, record, interval, walk.sections);
  double by_walk = 0.0;  // of q / omega^2 = 1 [1/s^2]
  for (std::size_t m = 0; m < phases.size(); ++m) {
    const Walk one = walk_of(phases[m], walk.duration / static_cast<double>(walk.sections));
    walk.squares += one.squares, walk.freedom += one.freedom;
    by_walk += std::pow(fit.rates[m].imag(), 2) * one.by_walk;
  }
  if (walk.freedom < 1.0 || !(walk.squares > chi_square_limit(walk.freedom, 1.0 - worth_widening))) return {};
  walk.clock = (walk.squares - walk.freedom) / by_walk;
  return walk;
}

ModalEstimate without_sidebands(ModalEstimate mode, double duration) {
  constexpr double fewest_beats = 6.0;  // for four sections of one and a half
  constexpr double half = 0.5, many_times = 3.0;
  std::erase_if(mode.companions, [&](const CompanionMode& other) {
    const double apart = std::abs(other.frequency_hz - mode.frequency_hz);
    const bool beats = apart * duration > fewest_beats,
               lasts = other.rate().real() > many_times * mode.rate().real();
    return apart < near * mode.frequency_hz && ((other.amplitude < weak * mode.amplitude && !beats) ||
                                                (other.amplitude < half * mode.amplitude && !lasts));
  });
  return mode;
}

}  // namespace beamid::experiments
