#include "experiments/modal/close_pair.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using std::numbers::pi;

Pole fitted_pole(const JointDecayFit& fit, std::size_t m) {
  Pole pole{fit.rates[m], fit.shapes.col(static_cast<Index>(m))};
  const auto at = static_cast<Index>(2 * m);
  pole.take_deviations(fit.covariance.block<2, 2>(at, at));
  return pole;
}

namespace {

// One mode that drifts.

bool near(Complex a, Complex b, double duration) {
  constexpr double most_cycles = 4, time_constants = 3;
  const double slower = std::min(std::abs(a.real()), std::abs(b.real()));
  return std::abs(a.imag() - b.imag()) / (2 * pi) *
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
  VectorXcd logarithm = unwrapped_logarithm(z);
  for (Index k = 0; k < z.size(); ++k)
    if (!std::isfinite(logarithm[k].real())) logarithm[k] = 0.0;  // where nothing is left, of no weight
  return complex_least_squares(weight.asDiagonal() * basis.cast<Complex>(), weight.asDiagonal() * logarithm);
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

/// Squares of the residual of modes a and b of a joint fit in some channels, each in units of its noise near
/// a, and of one mode in their place that drifts in all of them alike.
struct PairAgainstDrift {
  double left_by_pair = 0.0, left_by_drift = 0.0;
};

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

}  // namespace

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

// Two modes in the place of one.

/// The record without all modes but m.
MatrixXd without_others(const MatrixXd& record, double interval, const JointDecayFit& fit, std::size_t m) {
  MatrixXd rest = record.colwise() - fit.offsets;
  for (std::size_t other = 0; other < fit.rates.size(); ++other) {
    if (other == m) continue;
    const VectorXcd wave = decaying_wave(fit.rates[other], interval, rest.cols());
    rest -= (fit.shapes.col(static_cast<Index>(other)) * wave.transpose()).real();
  }
  return rest;
}

/// About eight samples a period: Hankel rows then reach over many periods.
std::vector<std::pair<Complex, Complex>> starts(const MatrixXd& record, double interval,
                                                const JointDecayFit& fit, std::size_t m) {
  constexpr double samples_per_period = 8.0, near = 0.1;
  std::vector<std::pair<Complex, Complex>> pairs;
  const double w = std::abs(fit.rates[m]), duration = interval * static_cast<double>(record.cols());
  const MatrixXd rest = without_others(record, interval, fit, m);
  const auto stride = std::max<Index>(1, static_cast<Index>(2.0 * pi / (w * interval * samples_per_period)));
  try {
    const MatrixXd coarse = rest(Eigen::all, Eigen::seq(0, rest.cols() - 1, stride));
    EigensystemSettings settings;
    settings.order = 4;
    settings.rows = std::min<Index>(coarse.cols() / 2, 200);
    std::vector<Complex> close;
    for (const IdentifiedMode& mode :
         eigensystem_realisation(coarse, interval * static_cast<double>(stride), settings).modes)
      if (mode.frequency_hz > 0.0 && mode.rate.real() < 0.0 && std::abs(std::abs(mode.rate) - w) < near * w)
        close.push_back(mode.rate);
    if (close.size() == 2) pairs.emplace_back(close[0], close[1]);
  } catch (const std::invalid_argument&) {  // too short
  }
  for (const double cycles : {0.5, 1.0}) {
    const Complex apart(0.0, pi * cycles / duration);
    pairs.emplace_back(fit.rates[m] - apart, fit.rates[m] + apart);
  }
  return pairs;
}

/// Noise around mode a over that a few of its lines farther away, the largest of all channels.
double density_near(const MatrixXd& record, double interval, const JointDecayFit& fit, std::size_t a) {
  constexpr int nearest = 10, first = 25, last = 80;  // lines of the record
  const MatrixXd left = record - fit.reconstruction;
  const double line = 2.0 * pi / (interval * static_cast<double>(left.cols())), w = fit.rates[a].imag();
  const auto power = [&](Index channel, double omega) {
    Complex sum = 0.0, phase = 1.0;
    const Complex step = std::polar(1.0, -omega * interval);
    for (Index k = 0; k < left.cols(); ++k, phase *= step) sum += left(channel, k) * phase;
    return std::norm(sum);
  };
  double largest = 0.0;
  for (Index c = 0; c < left.rows(); ++c) {
    double near = 0.0;
    std::vector<double> far;
    for (int k = -nearest; k <= nearest; ++k) near += power(c, w + k * line) / (2 * nearest + 1);
    for (int k = first; k <= last; ++k)
      for (const double omega : {w - k * line, w + k * line})
        if (omega > line) far.push_back(power(c, omega));
    // Of noise the median power is ln 2 of the mean; overtones and other modes do not move it.
    const double mean = far.empty() ? 0.0 : median(far) / std::numbers::ln2;
    largest = std::max(largest, near / std::max(mean, 1e-300));
  }
  return largest;
}

constexpr double least_apart = 0.25;  // cycles over the record

/// Whether modes a and b may be one mode in channels whose clocks differ: they are too near, or each channel
/// has one of them only.
bool may_be_clocks(const JointDecayFit& pair, Index a, Index b, double cycles) {
  constexpr double weak = 0.05;
  const Eigen::ArrayXd first = pair.shapes.col(a).cwiseAbs(), second = pair.shapes.col(b).cwiseAbs();
  return first.size() > 1 && (cycles < least_apart || (first.min(second) < weak * first.max(second)).all());
}

/// Absent where it does not converge, or has too few samples.
std::optional<JointDecayFit> with_pair(const MatrixXd& record, double interval, const JointDecayFit& fit,
                                       std::size_t m, const std::pair<Complex, Complex>& start) {
  std::vector<Complex> rates = fit.rates;
  rates[m] = start.first;
  rates.push_back(start.second);
  try {
    return fit_decays_jointly(record, interval, rates);
  } catch (const std::exception&) {
    return {};
  }
}

/// Two modes where `single` has m; absent where one explains the record.
std::optional<ClosePair> compete(const MatrixXd& record, double interval, const JointDecayFit& single,
                                 std::size_t m, JointDecayFit pair) {
  constexpr double by_chance = 1e-5, surely = 1e-6, close = 1.5, clearly_one = -10.0, denser = 3.0,
                   weakest = 0.02;
  const std::size_t last = pair.rates.size() - 1;
  const double w = single.rates[m].imag();
  bool surely_damped = true;
  for (const std::size_t k : {m, last}) {
    const Pole pole = fitted_pole(pair, k);
    const double ratio = pole.damping_ratio(), deviation = pole.damping_ratio_deviation;
    if (!(ratio > -2.0 * deviation) || !(std::abs(pair.rates[k].imag() - w) < 0.1 * w)) return {};
    surely_damped = surely_damped && ratio > 2.0 * deviation;
  }
  const auto at_a = static_cast<Index>(m), at_b = static_cast<Index>(last);
  const double size_a = pair.shapes.col(at_a).norm(), size_b = pair.shapes.col(at_b).norm();
  if (std::min(size_a, size_b) < weakest * std::max(size_a, size_b)) return {};
  std::vector<Index> channels(static_cast<std::size_t>(record.rows()));
  std::iota(channels.begin(), channels.end(), 0);
  const PairAgainstDrift both = pair_against_drift(pair, m, last, record, interval, channels);
  const VectorXd by_one = (record - single.reconstruction).rowwise().squaredNorm();
  const double gained =
      by_one.cwiseQuotient(pair.noise_variance.col(at_a).cwiseMax(1e-300)).sum() - both.left_by_pair;
  const double freedom = 2.0 + 2.0 * static_cast<double>(record.rows());
  const double over_drift = both.left_by_drift - both.left_by_pair;
  if (!(gained > chi_square_limit(freedom, 1.0 - by_chance)) || over_drift < clearly_one ||
      density_near(record, interval, pair, m) > denser)
    return {};
  const double cycles = std::abs(pair.rates[m].imag() - pair.rates[last].imag()) / (2.0 * pi) * interval *
                        static_cast<double>(record.cols());
  const bool over_clearly = over_drift > clearly_two;
  if (over_clearly && may_be_clocks(pair, at_a, at_b, cycles)) return {};
  const bool wins = surely_damped && over_clearly && cycles >= least_apart &&
                    gained > chi_square_limit(freedom, 1.0 - surely);
  if (!wins && cycles >= close) return {};
  return ClosePair{std::move(pair), m, over_drift, wins, cycles};
}

}  // namespace

Pole ClosePair::low() const {
  const std::size_t last = fit.rates.size() - 1;
  return fitted_pole(fit, std::abs(fit.rates[m]) <= std::abs(fit.rates[last]) ? m : last);
}

Pole ClosePair::high() const {
  const std::size_t last = fit.rates.size() - 1;
  return fitted_pole(fit, std::abs(fit.rates[m]) <= std::abs(fit.rates[last]) ? last : m);
}

bool ClosePair::is_indeterminate() const {
  constexpr double alike = 1.5;
  const double a = low().damping_ratio(), b = high().damping_ratio();
  return std::max(a, b) < alike * std::min(a, b) && cycles > least_apart;
}

PairSpread ClosePair::spread_about(double frequency_hz, double damping_ratio) const {
  const Pole a = low(), b = high();
  const double larger = std::max(a.shape.norm(), b.shape.norm());
  PairSpread spread;
  for (const Pole& pole : {a, b}) {
    const double share = pole.shape.norm() / larger;
    spread.frequency_hz = std::max(spread.frequency_hz, share * std::abs(pole.frequency_hz() - frequency_hz));
    spread.damping_ratio =
        std::max(spread.damping_ratio, share * std::abs(pole.damping_ratio() - damping_ratio));
  }
  return spread;
}

const char* ClosePair::objection() const {
  return contradicts_one() ? "close_modes" : "drift_or_pair";
}

std::string ClosePair::sentence(double frequency_hz) const {
  const std::string two =
      fmt::format("{:.5g} and {:.5g} Hz with {:.3g} and {:.3g} %", low().frequency_hz(),
                  high().frequency_hz(), 100.0 * low().damping_ratio(), 100.0 * high().damping_ratio());
  if (wins)
    return fmt::format(
        "Two modes of {} explain the record better than one at {:.5g} Hz that drifts (chi^2 differs by "
        "{:.2g}).",
        two, frequency_hz, over_drift);
  return is_indeterminate()
             ? fmt::format(
                   "One or two modes at {:.5g} Hz: two of {} explain the record as well as one that drifts "
                   "(chi^2 differs by {:.2g}).",
                   frequency_hz, two, over_drift)
             : fmt::format(
                   "The mode at {:.5g} Hz follows its amplitude, or there are two of {}: both explain the "
                   "record (chi^2 differs by {:.2g}).",
                   frequency_hz, two, over_drift);
}

std::optional<ClosePair> close_pair(const MatrixXd& record, double interval, const JointDecayFit& fit,
                                    std::size_t m) {
  std::optional<ClosePair> undecided;
  for (const auto& start : starts(record, interval, fit, m)) {
    auto pair = with_pair(record, interval, fit, m, start);
    if (!pair) continue;
    if (auto found = compete(record, interval, fit, m, *std::move(pair))) {
      undecided = std::move(found);
      if (undecided->wins) break;
    }
  }
  return undecided;
}

JointDecayFit fit_with_companions(const MatrixXd& record, double interval, const ModalEstimate& mode) {
  std::vector<Complex> rates{mode.rate()};
  for (const CompanionMode& other : mode.companions) rates.push_back(other.rate());
  return fit_decays_jointly(record, interval, rates);
}

std::optional<FittedDecay> fitted_decay(const VectorXd& signal, double interval, const ModalEstimate& mode) {
  constexpr double passed = 0.3, highest = 6.0;  // of the new sampling rate; times the frequency
  constexpr double time_constants = 8.0;         // behind them the mode has died away
  constexpr Index most = 40'000;                 // samples
  const int factor = decimation_factor(passed / (highest * mode.frequency_hz * interval), signal.size());
  try {
    const DecimatedSignal coarse = decimate(signal, interval, factor);
    const double lasting = time_constants / std::max(-mode.rate().real(), 1e-300);
    const Index count = std::min(
        {coarse.samples.size(), most, static_cast<Index>(std::min(1e15, lasting / coarse.interval))});
    const MatrixXd record = coarse.samples.head(count).transpose();
    return FittedDecay{record, coarse.interval, fit_with_companions(record, coarse.interval, mode)};
  } catch (const std::exception&) {
    return {};
  }
}

std::optional<ClosePair> close_pair(const FittedDecay& decay) {
  try {
    return close_pair(decay.record, decay.interval, decay.fit, 0);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace beamid::experiments
