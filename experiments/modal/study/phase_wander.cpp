#include "experiments/modal/study/phase_wander.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "experiments/modal/study/record_kind.hpp"
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

/// The weak modes beside a strong one that have its shape in several channels: a phase that wanders has such
/// sidebands, which would take up its walk.
std::vector<std::size_t> sidebands_of(const JointDecayFit& fit) {
  constexpr double weak = 0.1, near = 0.1, alike = 0.98;
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
                                     const RecordModes& found) {
  std::vector<Complex> rates;
  for (std::size_t m = 0; m < fit.rates.size(); ++m)
    if (std::ranges::find(left_out, m) == left_out.end()) rates.push_back(fit.rates[m]);
  try {
    return fit_decays_jointly(found.target, found.interval, rates);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

void follow_phases(const JointDecayFit& of_all, RecordModes& found) {
  constexpr double worth_widening = 1e-2, worth_saying = 1e-4;  // by chance
  const double duration = found.interval * static_cast<double>(found.target.cols());
  std::vector<std::size_t> sidebands = sidebands_of(of_all);
  const auto freed = sidebands.empty() ? std::nullopt : without(sidebands, of_all, found);
  if (!freed) sidebands.clear();
  const JointDecayFit& fit = freed ? *freed : of_all;
  const Index sections = sections_of(fit, duration);
  if (sections == 0) return;
  const std::vector<Phases> phases = phases_of(fit, found.target, found.interval, sections);
  Walk all;
  for (std::size_t m = 0; m < phases.size(); ++m) {
    const Walk one = walk_of(phases[m], duration / static_cast<double>(sections));
    all.squares += one.squares, all.freedom += one.freedom;
    all.by_walk += std::pow(fit.rates[m].imag(), 2) * one.by_walk;
  }
  if (all.freedom < 1.0 || !(all.squares > chi_square_limit(all.freedom, 1.0 - worth_widening))) return;
  const double walk = (all.squares - all.freedom) / all.by_walk;  // of the clock [s^2 / s]
  for (std::size_t m = 0; m < of_all.rates.size(); ++m) {
    const double w = of_all.rates[m].imag(), sigma = -of_all.rates[m].real(), q = w * w * walk;
    Pole& pole = found.modes[m].pole;
    pole.frequency_deviation_hz =
        std::hypot(pole.frequency_deviation_hz,
                   std::sqrt(q * std::max(0.5 * sigma, 1.2 / duration)) / (2.0 * std::numbers::pi));
    pole.damping_ratio_deviation = std::hypot(pole.damping_ratio_deviation, 0.25 * q / w);
  }
  if (!(all.squares > chi_square_limit(all.freedom, 1.0 - worth_saying))) return;
  std::vector<double> beside_hz;
  for (const std::size_t m : sidebands) beside_hz.push_back(found.modes[m].pole.frequency_hz());
  found.objections.emplace_back(
      "phase_wander",
      fmt::format(
          "The modes do not keep their phases (chi^2 = {:.3g} of {:.0f} in {} sections of the record). They "
          "wander as under a clock that is {:.2g} ms off after {:.3g} s of intervals that scatter, or under "
          "frequencies that change. Standard deviations allow for such a walk.{}",
          all.squares, all.freedom, sections, 1e3 * std::sqrt(walk * duration), duration,
          beside_hz.empty() ? ""
                            : " What is listed at " + frequencies_text(beside_hz) +
                                  " has the shape of a stronger mode beside it, as a sideband of the walk."));
}

}  // namespace beamid::experiments
