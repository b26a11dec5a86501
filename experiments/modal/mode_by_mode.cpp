#include "experiments/modal/mode_by_mode.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <Eigen/QR>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr double fewest_kernels = 1.5;
constexpr Index fewest_values = 5;

/// How many values come before the first that is smaller than this.
Index reach(const VectorXcd& values, double least) {
  Index count = 0;
  while (count < values.size() && std::abs(values[count]) >= least) ++count;
  return std::max(count, std::min(fewest_values, values.size()));
}

/// The mode over the first `count` values.
void take(const VectorXcd& values, Index count, IsolatedMode& mode) {
  mode.values = values.head(count);
  mode.logarithm = unwrapped_logarithm(mode.values);
  const VectorXd time = mode.interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  mode.line = line_through(time, mode.logarithm, mode.independent());
  const Complex mean =
      Complex(mode.line.log_amplitude,
              (mode.values.cwiseAbs2().array() *
               (mode.logarithm.imag().array() - mode.line.slope.imag() * (time.array() - mode.line.time)))
                      .sum() /
                  mode.values.squaredNorm());
  const VectorXcd model = (mean + mode.line.slope * (time.array() - mode.line.time).cast<Complex>()).exp();
  const double independent = std::max(static_cast<double>(count) * mode.independent(), 2.5);
  mode.noise = std::sqrt((mode.values - model).squaredNorm() / static_cast<double>(count) * independent /
                         (independent - 2));
}

}  // namespace

IsolatedMode isolate(const VectorXd& signal, double interval, double frequency_hz,
                     const std::vector<Complex>& others) {
  IsolatedMode mode;
  Complex rate(0, 2 * std::numbers::pi * frequency_hz);
  std::vector<Complex> neighbours = others;
  std::erase_if(neighbours, [&](const Complex& other) { return other.imag() == rate.imag(); });
  for (int pass = 0; pass < 2; ++pass) {  // the kernel's gain and w are those of the rate found at first
    const Demodulated found = demodulate(signal, interval, rate, neighbours, fewest_kernels);
    if (found.values.size() < fewest_values)
      throw std::invalid_argument(fmt::format("{} values of the mode at {:.4g} Hz; expected {} at least",
                                              found.values.size(), frequency_hz, fewest_values));
    mode.turned_back = rate.imag();
    mode.interval = found.interval;
    mode.correlation = found.correlation;
    const double largest = found.values.cwiseAbs().maxCoeff();
    take(found.values, reach(found.values, 0.2 * largest), mode);
    take(found.values, reach(found.values, std::max(5 * mode.noise, 0.01 * largest)), mode);
    if (pass == 0 && std::abs(mode.line.slope.imag()) < 0.1 * rate.imag()) rate = mode.rate();
  }
  return mode;
}

namespace {

using Complex = std::complex<double>;

constexpr double lowest_ratio = 0.7, highest_ratio = 1.4;  // of the expected frequency
constexpr Index powers = 3;                                // of s, in every numerator

/// Lines first .. first + count - 1 of the transform of a signal.
VectorXcd lines_of(const VectorXd& signal, Index first, Index count) {
  const std::vector<double> samples(signal.data(), signal.data() + signal.size());
  std::vector<Complex> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, samples);
  return Eigen::Map<const VectorXcd>(lines.data() + first, count);
}

/// Real rows of complex equations.
MatrixXd real_rows(const MatrixXcd& rows) {
  MatrixXd real(2 * rows.rows(), rows.cols());
  real << rows.real(), rows.imag();
  return real;
}

}  // namespace

ForcedMode forced_mode(const VectorXd& output, const MatrixXd& inputs, double interval, double expected_hz) {
  constexpr int iterations = 20;
  constexpr double largest_ratio = 0.3, explained = 0.5;
  const Index length = fast_length_within(output.size());
  const double line = 1 / (interval * static_cast<double>(length));  // [Hz]
  const auto first = static_cast<Index>(std::ceil(lowest_ratio * expected_hz / line)),
             last = std::min(length / 2 - 1, static_cast<Index>(highest_ratio * expected_hz / line));
  const Index count = last - first + 1, unknowns = 2 + powers * (inputs.rows() + 1);
  if (first < 1 || count < unknowns)
    throw std::invalid_argument(fmt::format(
        "{} lines of the spectrum lie between {:.4g} and {:.4g} Hz; expected at least {} for a forced mode",
        std::max<Index>(0, count), lowest_ratio * expected_hz, highest_ratio * expected_hz, unknowns));
  VectorXcd s(count);  // over the expected angular frequency
  for (Index k = 0; k < count; ++k) s[k] = Complex(0, static_cast<double>(first + k) * line / expected_hz);
  const VectorXcd y = lines_of(bridged_straight(output).head(length), first, count);
  MatrixXcd rows(count, unknowns);
  rows.col(0) = -s.cwiseProduct(y);
  rows.col(1) = -y;
  for (Index j = 0; j <= inputs.rows(); ++j) {
    VectorXcd input = VectorXcd::Ones(count);
    if (j < inputs.rows())
      input = lines_of(bridged_straight(inputs.row(j).transpose()).head(length), first, count);
    input /= std::max(1e-300, input.norm());
    for (Index power = 0; power < powers; ++power, input = s.cwiseProduct(input).eval())
      rows.col(2 + powers * j + power) = input * y.norm();
  }
  const VectorXcd right = s.array().square() * y.array();
  VectorXd weight = VectorXd::Ones(count), found = VectorXd::Zero(unknowns);
  double left = 1;
  for (int i = 0; i < iterations; ++i) {
    const MatrixXd a = real_rows(weight.asDiagonal() * rows);
    const VectorXd b = real_rows(weight.asDiagonal() * right);
    found = a.colPivHouseholderQr().solve(b);
    const VectorXcd factor = s.array().square() + found[0] * s.array() + found[1];
    // what is left of the output, with the left side divided by its factor
    left = (factor.cwiseProduct(y) - rows.rightCols(unknowns - 2) * found.tail(unknowns - 2))
               .cwiseQuotient(factor)
               .norm() /
           y.norm();
    weight = factor.cwiseAbs().cwiseInverse();
  }
  const double w = std::sqrt(found[1]), ratio = found[0] / (2 * w);
  if (!(w > lowest_ratio && w < highest_ratio && std::abs(ratio) < largest_ratio && left * left < explained))
    throw std::invalid_argument(
        fmt::format("no mode between {:.4g} and {:.4g} Hz explains the response to the measured inputs",
                    lowest_ratio * expected_hz, highest_ratio * expected_hz));
  return {w * expected_hz, ratio};
}

namespace {

/// The largest of the two valleys that part line k from a larger value on either side; an end of the
/// spectrum is no larger value.
double valley_beside(const VectorXd& spectrum, Index k) {
  double deepest_needed = 0;
  for (const Index direction : {-1, 1}) {
    double valley = spectrum[k];
    for (Index j = k + direction; j >= 0 && j < spectrum.size(); j += direction) {
      valley = std::min(valley, spectrum[j]);
      if (spectrum[j] <= spectrum[k]) continue;
      deepest_needed = std::max(deepest_needed, valley);
      break;
    }
  }
  return deepest_needed;
}

/// The upper median of a window that moves along values. The first questions count the values of their
/// window; from there on a tree of counts over ranks answers in O(log N) [fenwick1994], whose sorting takes
/// as long as 80 windows of a million values.
class MovingMedian {
 public:
  /// The values must outlive this.
  explicit MovingMedian(const VectorXd& values) : values_(values) {}

  /// Whether value < times the median of the values left .. right, none of them before those of the last
  /// window.
  bool is_below(double value, double times, Index left, Index right) {
    constexpr int first_ones = 32;
    const auto is_low = [&](double one) { return times * one <= value; };
    const Index half = (right + 1 - left) / 2;
    if (asked_++ < first_ones)
      return std::ranges::count_if(values_.segment(left, right + 1 - left), is_low) <= half;
    if (sorted_.size() == 0) sort();
    for (; end_ <= right; ++end_) add(end_, 1);
    for (; begin_ < left; ++begin_) add(begin_, -1);
    const auto above = std::partition_point(sorted_.begin(), sorted_.end(), is_low);
    Index within = 0;
    for (auto node = above - sorted_.begin(); node > 0; node -= node & -node)
      within += counts_[static_cast<std::size_t>(node)];
    return within <= half;
  }

 private:
  const VectorXd& values_;
  int asked_ = 0;
  VectorXd sorted_;
  Eigen::VectorX<Index> ranks_;
  std::vector<Index> counts_;  ///< a tree, from 1 on
  Index begin_ = 0, end_ = 0;

  void sort() {
    std::vector<Index> order(static_cast<std::size_t>(values_.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::sort(order, {}, [&](Index k) { return values_[k]; });
    sorted_ = values_(order);
    ranks_.resize(values_.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank) ranks_[order[rank]] = static_cast<Index>(rank);
    counts_.assign(order.size() + 1, 0);
  }
  void add(Index k, Index count) {
    for (Index node = ranks_[k] + 1; node < std::ssize(counts_); node += node & -node)
      counts_[static_cast<std::size_t>(node)] += count;
  }
};

}  // namespace

std::vector<SpectralLine> spectral_lines(const Eigen::MatrixXd& outputs, double interval,
                                         const LineSettings& settings) {
  AmplitudeSpectrum first = amplitude_spectrum(outputs.row(0).transpose(), interval);
  VectorXd spectrum = first.amplitude.cwiseAbs2();
  for (Index i = 1; i < outputs.rows(); ++i)
    spectrum += amplitude_spectrum(outputs.row(i).transpose(), interval).amplitude.cwiseAbs2();
  spectrum = spectrum.cwiseSqrt();
  const double line = 1 / (interval * static_cast<double>(outputs.cols()));
  const double step = first.frequency_hz[1];
  const auto lobe = static_cast<Index>(2 * line / step);
  const Index around = std::max<Index>(16 * lobe, spectrum.size() / 8);
  const double least = settings.least * spectrum.maxCoeff();
  std::vector<SpectralLine> lines;
  MovingMedian noise(spectrum);
  for (Index k = lobe; k + 1 < spectrum.size(); ++k) {
    const Index from = std::max<Index>(0, k - lobe), to = std::min(spectrum.size() - 1, k + lobe);
    if (spectrum[k] < least || spectrum[k] < spectrum.segment(from, to - from + 1).maxCoeff()) continue;
    const Index left = std::max<Index>(0, k - around), right = std::min(spectrum.size() - 1, k + around);
    if (noise.is_below(spectrum[k], settings.above_noise, left, right)) continue;
    if (spectrum[k] < settings.above_valley * valley_beside(spectrum, k)) continue;
    lines.push_back({first.frequency_hz[k], spectrum[k]});
  }
  return lines;
}

std::vector<double> spectral_peaks(const Eigen::MatrixXd& outputs, double interval) {
  std::vector<double> peaks;
  for (const SpectralLine& line : spectral_lines(outputs, interval)) peaks.push_back(line.frequency_hz);
  return peaks;
}

namespace {

using Complex = std::complex<double>;

/// In the channel where it is largest.
IsolatedMode isolated(const MatrixXd& outputs, double interval, double frequency_hz,
                      const std::vector<Complex>& all) {
  std::optional<IsolatedMode> best;
  for (Index i = 0; i < outputs.rows(); ++i) {
    IsolatedMode mode = isolate(outputs.row(i).transpose(), interval, frequency_hz, all);
    if (!best || std::abs(mode.values[0]) > std::abs(best->values[0])) best = std::move(mode);
  }
  return *best;
}

Pole pole_of(const ModeAnswer& answer, Index outputs) {
  Pole pole{answer.rate, Eigen::VectorXcd::Ones(outputs)};
  const double df = answer.frequency_deviation, dd = answer.damping_rate_deviation;
  pole.take_deviations(Eigen::Vector2d(df * df, dd * dd).asDiagonal());
  return pole;
}

std::string mode_by_mode_objection_to(const Pole& pole) {
  const double ratio = pole.damping_ratio(), deviation = pole.damping_ratio_deviation;
  const double room = deviation > 0 ? 2 * deviation : 0;
  if (!(ratio + room > 0)) return fmt::format("does not decay, damping ratio {:.3g} %", 100 * ratio);
  if (!(ratio > 0) || deviation > ratio)
    return fmt::format("too uncertain, damping ratio {:.2g} % with standard deviation {:.2g} %", 100 * ratio,
                       100 * deviation);
  return "";
}

}  // namespace

PoleSearch ModeByModeMethod::search(const MatrixXd& outputs, double interval, int) const {
  PoleSearch found;
  found.decays = outputs;
  found.orders.push_back({0, {}});
  std::vector<Complex> all;
  for (const double f : spectral_peaks(outputs, interval)) all.emplace_back(0, 2 * std::numbers::pi * f);
  for (const Complex& peak : all) {
    Pole pole{Complex(0, peak.imag()), Eigen::VectorXcd::Ones(outputs.rows())};
    std::string objection, remark;
    try {
      const ModeAnswer answer =
          estimate(isolated(outputs, interval, peak.imag() / (2 * std::numbers::pi), all));
      pole = pole_of(answer, outputs.rows());
      objection = mode_by_mode_objection_to(pole);
      remark = answer.remark;
    } catch (const std::invalid_argument& error) {
      objection = error.what();
    }
    if (!objection.empty()) {
      found.refused.push_back({pole, objection});
      continue;
    }
    found.orders.back().poles.push_back(pole);
    if (!remark.empty()) found.remarks.push_back(remark);
  }
  return found;
}

}  // namespace beamid::experiments
