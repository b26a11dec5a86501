#include "experiments/modal/study/phase_wander.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr Index terms = 4;

bool near(Complex a, Complex b, double duration) {
  constexpr double most_cycles = 4, time_constants = 3;
  const double slower = std::min(std::abs(a.real()), std::abs(b.real()));
  return std::abs(a.imag() - b.imag()) / (2 * std::numbers::pi) *
             std::min(duration, time_constants / std::max(slower, 1e-300)) <
         most_cycles;
}

/// Powers 0 to 3 of x from 0 to 1 (N x 4).
MatrixXd powers_of_time(Index count) {
  const VectorXd x = VectorXd::LinSpaced(count, 0, 1);
  MatrixXd basis(count, terms);
  basis.col(0).setOnes();
  for (Index j = 1; j < terms; ++j) basis.col(j) = basis.col(j - 1).cwiseProduct(x);
  return basis;
}

/// 1, x, a and a^2 with the amplitude a = e^(-decay x): what a rate that follows the amplitude makes of the
/// phase and of the logarithm of the amplitude, to second order.
MatrixXd powers_of_amplitude(Index count, double decay) {
  MatrixXd basis = powers_of_time(count);
  basis.col(2) = (-decay * basis.col(1).array()).exp();
  basis.col(3) = basis.col(2).cwiseAbs2();
  return basis;
}

VectorXcd drifting(const VectorXcd& c, const MatrixXd& basis) {
  return (basis.cast<Complex>() * c).array().exp();
}

/// c of least squares through log z, weighted by |z|.
VectorXcd through_logarithm(const VectorXcd& z, const MatrixXd& basis) {
  const VectorXd weight = z.cwiseAbs();
  return complex_least_squares(weight.asDiagonal() * basis.cast<Complex>(),
                               weight.asDiagonal() * unwrapped_logarithm(z));
}

/// d Re z / d (Re c_1, Im c_1, ...) (N x 2 terms).
MatrixXd drift_slope(const VectorXcd& z, const MatrixXd& basis) {
  MatrixXd slope(z.size(), 2 * terms);
  for (Index j = 0; j < terms; ++j) {
    slope.col(2 * j) = z.real().cwiseProduct(basis.col(j));
    slope.col(2 * j + 1) = -z.imag().cwiseProduct(basis.col(j));
  }
  return slope;
}

/// Sum of squares that the best c leaves of y, from that of z on.
double left_by_drifting(const VectorXd& y, const MatrixXd& basis, const VectorXcd& near) {
  VectorXcd c = through_logarithm(near, basis), z = drifting(c, basis);
  double squares = (y - z.real()).squaredNorm();
  const auto step = [&](double damping) -> VectorXd {
    const MatrixXd slope = drift_slope(z, basis);
    return filters::solve_damped(slope.transpose() * slope, damping, slope.transpose() * (y - z.real()));
  };
  const auto take = [&](const VectorXd& tried) {
    VectorXcd next = c;
    for (Index j = 0; j < terms; ++j) next[j] += Complex(tried[2 * j], tried[2 * j + 1]);
    const VectorXcd there = drifting(next, basis);
    const double left = (y - there.real()).squaredNorm();
    if (!(left < squares)) return filters::TriedStep{};
    const bool settled = squares - left < 1e-6 * squares;
    c = next, z = there, squares = left;
    return filters::TriedStep{1.0, settled};
  };
  filters::MarquardtDamping rule;
  rule.most = 1e6, rule.most_steps = 30;
  filters::levenberg_marquardt(rule, step, take);
  return squares;
}

}  // namespace

PairAgainstDrift pair_against_drift(const JointDecayFit& fit, std::size_t a, std::size_t b,
                                    const MatrixXd& target, double interval, Index channel) {
  const Index count = target.cols();
  VectorXcd pair(count);
  for (Index k = 0; k < count; ++k) {
    const double time = interval * static_cast<double>(k);
    pair[k] = fit.shapes(channel, static_cast<Index>(a)) * std::exp(fit.rates[a] * time) +
              fit.shapes(channel, static_cast<Index>(b)) * std::exp(fit.rates[b] * time);
  }
  const VectorXd left_by_pair = (target.row(channel) - fit.reconstruction.row(channel)).transpose(),
                 both = left_by_pair + pair.real();
  const double decay =
      -0.5 * (fit.rates[a].real() + fit.rates[b].real()) * interval * static_cast<double>(count);
  return {left_by_pair.squaredNorm(),
          std::min(left_by_drifting(both, powers_of_time(count), pair),
                   left_by_drifting(both, powers_of_amplitude(count, decay), pair))};
}

bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b, const MatrixXd& target,
                          double interval) {
  if (!near(fit.rates[a], fit.rates[b], interval * static_cast<double>(target.cols()))) return false;
  Index channel = 0;
  (fit.shapes.col(static_cast<Index>(a)).cwiseAbs() + fit.shapes.col(static_cast<Index>(b)).cwiseAbs())
      .cwiseQuotient(fit.residual_standard_deviation.cwiseMax(1e-300))
      .maxCoeff(&channel);
  const PairAgainstDrift found = pair_against_drift(fit, a, b, target, interval, channel);
  return found.left_by_drift <= found.left_by_pair;
}

namespace {

using Complex = std::complex<double>;

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

}  // namespace

void follow_phases(const JointDecayFit& fit, RecordModes& found) {
  constexpr double worth_widening = 1e-2, worth_saying = 1e-4;  // by chance
  const double duration = found.interval * static_cast<double>(found.target.cols());
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
  for (std::size_t m = 0; m < fit.rates.size(); ++m) {
    const double w = fit.rates[m].imag(), sigma = -fit.rates[m].real(), q = w * w * walk;
    Pole& pole = found.modes[m].pole;
    pole.frequency_deviation_hz =
        std::hypot(pole.frequency_deviation_hz,
                   std::sqrt(q * std::max(0.5 * sigma, 1.2 / duration)) / (2.0 * std::numbers::pi));
    pole.damping_ratio_deviation = std::hypot(pole.damping_ratio_deviation, 0.25 * q / w);
  }
  if (!(all.squares > chi_square_limit(all.freedom, 1.0 - worth_saying))) return;
  found.objections.emplace_back(
      "phase_wander",
      fmt::format(
          "The modes do not keep their phases (chi^2 = {:.3g} of {:.0f} in {} sections of the record). They "
          "wander as under a clock that is {:.2g} ms off after {:.3g} s of intervals that scatter, or under "
          "frequencies that change. Standard deviations allow for such a walk.",
          all.squares, all.freedom, sections, 1e3 * std::sqrt(walk * duration), duration));
}

}  // namespace beamid::experiments
