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
  MatrixXd basis(count, 4);
  basis << VectorXd::Ones(count), x, x.cwiseAbs2(), x.cwiseAbs2().cwiseProduct(x);
  return basis;
}

/// 1, x, a, a^2 and a^3 with the amplitude a = e^(-decay x): what a rate that follows the amplitude makes of
/// the phase and of the logarithm of the amplitude, to third order (N x 5).
MatrixXd powers_of_amplitude(Index count, double decay) {
  const VectorXd x = VectorXd::LinSpaced(count, 0, 1), a = (-decay * x.array()).exp();
  MatrixXd basis(count, 5);
  basis << VectorXd::Ones(count), x, a, a.cwiseAbs2(), a.cwiseAbs2().cwiseProduct(a);
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

/// One mode that drifts alike in all channels: Re(A_i wave), wave = e^(c_1 x_1 + ...), every power x from 0
/// on.
class DriftingMode {
 public:
  /// @param basis powers behind a column of ones
  /// @param near (N x p) where the search begins
  DriftingMode(const MatrixXd& y, const MatrixXd& basis, const MatrixXcd& near)
      : y_(y), powers_(basis.rightCols(basis.cols() - 1).rowwise() - basis.row(0).tail(basis.cols() - 1)) {
    Index strongest = 0;
    near.colwise().squaredNorm().maxCoeff(&strongest);
    begin_near(near.col(strongest), basis);
    MatrixXd parts(y.rows(), 2);
    parts << wave_.real(), -wave_.imag();
    const MatrixXd best = least_squares(parts, y);
    amplitudes_ = best.row(0).transpose() + Complex(0, 1) * best.row(1).transpose();
  }

  VectorXd left(Index channel) const { return y_.col(channel) - (amplitudes_[channel] * wave_).real(); }

  double squares() const {
    double sum = 0.0;
    for (Index i = 0; i < y_.cols(); ++i) sum += left(i).squaredNorm();
    return sum;
  }

  /// Of least squares, along c and then the amplitudes (real and imaginary parts in turn).
  VectorXd step(double damping) const {
    const Index shared = 2 * c_.size(), unknowns = shared + 2 * y_.cols();
    MatrixXd normal = MatrixXd::Zero(unknowns, unknowns);
    VectorXd gradient = VectorXd::Zero(unknowns);
    for (Index i = 0; i < y_.cols(); ++i) {
      const MatrixXd slope = slope_of(i);
      Eigen::VectorX<Index> at = Eigen::VectorX<Index>::LinSpaced(shared + 2, 0, shared + 1);
      at.tail<2>().array() += 2 * i;
      normal(at, at) += slope.transpose() * slope;
      gradient(at) += slope.transpose() * left(i);
    }
    return filters::solve_damped(normal, damping, gradient);
  }

  DriftingMode moved(const VectorXd& step) const {
    DriftingMode there = *this;
    const Index drifts = c_.size();
    for (Index j = 0; j < drifts; ++j) there.c_[j] += Complex(step[2 * j], step[2 * j + 1]);
    for (Index i = 0; i < y_.cols(); ++i)
      there.amplitudes_[i] += Complex(step[2 * (drifts + i)], step[2 * (drifts + i) + 1]);
    there.wave_ = drifting(there.c_, powers_);
    return there;
  }

 private:
  /// With fewer powers where these, beyond where z is large, would overflow.
  void begin_near(const VectorXcd& z, const MatrixXd& basis) {
    constexpr double largest = 200.0;  // of the logarithm
    for (Index used = powers_.cols(); used >= 0; --used) {
      c_ = VectorXcd::Zero(powers_.cols());
      if (used > 0) c_.head(used) = through_logarithm(z, basis.leftCols(used + 1)).tail(used);
      if ((powers_ * c_.real()).maxCoeff() < largest) break;
    }
    wave_ = drifting(c_, powers_);
  }

  MatrixXd slope_of(Index channel) const {
    MatrixXd slope(y_.rows(), 2 * c_.size() + 2);
    const VectorXcd motion = amplitudes_[channel] * wave_;
    for (Index j = 0; j < c_.size(); ++j) {
      slope.col(2 * j) = motion.real().cwiseProduct(powers_.col(j));
      slope.col(2 * j + 1) = -motion.imag().cwiseProduct(powers_.col(j));
    }
    slope.rightCols<2>() << wave_.real(), -wave_.imag();
    return slope;
  }

  MatrixXd y_, powers_;
  VectorXcd c_, amplitudes_, wave_;
};

/// Residual sum of squares of y (N x p) under the best drifting mode, from that of `near` on.
double left_by_drifting(const MatrixXd& y, const MatrixXd& basis, const MatrixXcd& near) {
  DriftingMode mode(y, basis, near);
  double squares = mode.squares();
  const auto step = [&](double damping) { return mode.step(damping); };
  const auto take = [&](const VectorXd& tried) {
    DriftingMode there = mode.moved(tried);
    const double left = there.squares();
    if (!(left < squares)) return filters::TriedStep{};
    const bool settled = squares - left < 1e-6 * squares;
    mode = std::move(there), squares = left;
    return filters::TriedStep{1.0, settled};
  };
  filters::MarquardtDamping rule;
  rule.most = 1e6, rule.most_steps = 30;
  filters::levenberg_marquardt(rule, step, take);
  return squares;
}

}  // namespace

PairAgainstDrift pair_against_drift(const JointDecayFit& fit, std::size_t a, std::size_t b,
                                    const MatrixXd& target, double interval,
                                    const std::vector<Index>& channels) {
  const Index count = target.cols();
  const VectorXcd first = decaying_wave(fit.rates[a], interval, count),
                  second = decaying_wave(fit.rates[b], interval, count);
  MatrixXcd pair(count, static_cast<Index>(channels.size()));
  MatrixXd left(count, pair.cols());
  for (Index i = 0; i < pair.cols(); ++i) {
    const Index channel = channels[static_cast<std::size_t>(i)];
    const double noise = std::sqrt(std::max(fit.noise_variance(channel, static_cast<Index>(a)), 1e-300));
    pair.col(i) = (fit.shapes(channel, static_cast<Index>(a)) * first +
                   fit.shapes(channel, static_cast<Index>(b)) * second) /
                  noise;
    left.col(i) = (target.row(channel) - fit.reconstruction.row(channel)).transpose() / noise;
  }
  const MatrixXd both = left + pair.real();
  const double decay =
      -0.5 * (fit.rates[a].real() + fit.rates[b].real()) * interval * static_cast<double>(count);
  constexpr double two_more_numbers = 4.0;  // of the second drift, as Akaike counts them
  return {left.squaredNorm(),
          std::min(left_by_drifting(both, powers_of_time(count), pair),
                   left_by_drifting(both, powers_of_amplitude(count, decay), pair) + two_more_numbers)};
}

bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b, const MatrixXd& target,
                          double interval) {
  if (!near(fit.rates[a], fit.rates[b], interval * static_cast<double>(target.cols()))) return false;
  Index channel = 0;
  (fit.shapes.col(static_cast<Index>(a)).cwiseAbs() + fit.shapes.col(static_cast<Index>(b)).cwiseAbs())
      .cwiseQuotient(fit.residual_standard_deviation.cwiseMax(1e-300))
      .maxCoeff(&channel);
  const PairAgainstDrift found = pair_against_drift(fit, a, b, target, interval, {channel});
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
