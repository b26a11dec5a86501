#include "experiments/modal/steady_lines.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/sway.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr Index tapers = 9;

MatrixXd without_means(const MatrixXd& outputs) {
  return outputs.colwise() - outputs.rowwise().mean();
}

/// sum_t y_t e^(-i w t) of every channel, w in radians a sample.
VectorXcd transform_at(const MatrixXd& outputs, double w) {
  VectorXcd turned(outputs.cols());
  for (Index t = 0; t < turned.size(); ++t) turned[t] = std::polar(1.0, -w * static_cast<double>(t));
  return outputs.cast<Complex>() * turned;
}

/// F at i / (2 (N + 1)) of a sample, 0 where a band's end lies beyond 0 or Nyquist's frequency. One transform
/// serves all tapers: 2 i J_k(m) = sqrt(2 / (N + 1)) (Y(m - k) - Y(m + k)).
VectorXd harmonic_statistic(const MatrixXd& outputs) {
  const Index half = fast_length_within(outputs.cols() + 1), samples = half - 1;
  const MatrixXd used = without_means(outputs.leftCols(samples));
  VectorXd size = VectorXd::Zero(tapers);  // H_k
  for (Index k = 1; k <= tapers; k += 2)
    size[k - 1] = std::sqrt(2.0 / static_cast<double>(half)) /
                  std::tan(0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(half));
  VectorXd line = VectorXd::Zero(half), rest = VectorXd::Zero(half);
  Eigen::FFT<double> transform;
  for (Index c = 0; c < used.rows(); ++c) {
    VectorXd padded = VectorXd::Zero(2 * half);
    padded.segment(1, samples) = used.row(c).transpose();
    VectorXcd spectrum;
    transform.fwd(spectrum, padded);
    for (Index m = tapers; m + tapers < half; ++m) {
      VectorXcd tapered(tapers);
      for (Index k = 1; k <= tapers; ++k)
        tapered[k - 1] = Complex(0.0, -0.5) * std::sqrt(2.0 / static_cast<double>(half)) *
                         (spectrum[m - k] - spectrum[m + k]);
      const Complex mean = size.cast<Complex>().dot(tapered) / size.squaredNorm();
      line[m] += std::norm(mean) * size.squaredNorm();
      rest[m] += (tapered - mean * size.cast<Complex>()).squaredNorm();
    }
  }
  return (rest.array() > 0.0).select(static_cast<double>(tapers - 1) * line.array() / rest.array(), 0.0);
}

/// Where the statistic is largest among what is lasting; 0: nowhere beyond chance. P(F(2, 2 K - 2) > x) =
/// (1 + x / (K - 1))^(1 - K).
double likeliest_line(const MatrixXd& outputs) {
  constexpr double by_chance = 1e-3, as_steady = 1.5;
  VectorXd statistic = harmonic_statistic(outputs);
  const auto tried = static_cast<double>(statistic.size()), degrees = static_cast<double>(tapers - 1);
  const double limit = degrees * (std::pow(by_chance / tried, -1.0 / degrees) - 1.0);
  const Index half = outputs.cols() / 2;
  for (Index at = 0; statistic.maxCoeff(&at) > limit; statistic[at] = 0.0) {
    const double step = std::numbers::pi / tried;
    const auto power = [&](double w) { return -transform_at(without_means(outputs), w).squaredNorm(); };
    const double middle = step * static_cast<double>(at);
    const double w = boost::math::tools::brent_find_minima(power, middle - step, middle + step, 40).first;
    const double early = transform_at(without_means(outputs.leftCols(half)), w).norm(),
                 late = transform_at(without_means(outputs.rightCols(half)), w).norm();
    if (std::max(early, late) < as_steady * std::min(early, late)) return w;
  }
  return 0.0;
}

/// The record without its parts at these frequencies, least squares of all at once.
MatrixXd without_sines(const MatrixXd& outputs, const std::vector<double>& lines) {
  const auto count = static_cast<Index>(lines.size());
  MatrixXd waves(outputs.cols(), 2 * count + 1);
  waves.col(2 * count).setOnes();
  for (Index j = 0; j < count; ++j)
    for (Index t = 0; t < waves.rows(); ++t) {
      const double angle = lines[static_cast<std::size_t>(j)] * static_cast<double>(t);
      waves(t, 2 * j) = std::cos(angle);
      waves(t, 2 * j + 1) = std::sin(angle);
    }
  const MatrixXd amplitudes =
      (waves.transpose() * waves).ldlt().solve(waves.transpose() * outputs.transpose());
  const Index sines = 2 * count;
  return outputs - (waves.leftCols(sines) * amplitudes.topRows(sines)).transpose();
}

}  // namespace

SteadyLines steady_lines(const MatrixXd& outputs, double interval) {
  constexpr std::size_t most = 20;
  constexpr Index fewest = 100;  // samples
  SteadyLines found{{}, outputs};
  if (outputs.cols() < fewest) return found;
  const double whole = without_means(outputs).squaredNorm();
  std::vector<double> lines;
  while (lines.size() < most) {
    const double w = likeliest_line(found.rest);
    if (w == 0.0) break;
    const double before = without_means(found.rest).squaredNorm();
    lines.push_back(w);
    found.rest = without_sines(outputs, lines);
    found.lines.push_back(
        {w / (2.0 * std::numbers::pi * interval),
         std::sqrt(std::max(0.0, before - without_means(found.rest).squaredNorm()) / whole)});
  }
  std::sort(found.lines.begin(), found.lines.end(),
            [](const SteadyLine& a, const SteadyLine& b) { return a.frequency_hz < b.frequency_hz; });
  return found;
}

std::optional<DriftFree> without_drift(const Record& record, double lowest_hz) {
  constexpr double least = 0.02, steep = 0.8;
  const double interval = record.interval();
  const double period = 1.0 / lowest_hz;
  Drift largest;
  for (const auto& row : record.samples.rowwise()) {
    const Drift drift = drift_beneath(row.transpose(), interval, period);
    if (drift.share > largest.share) largest = drift;
  }
  if (largest.share < least || largest.steepness > steep) return {};
  DriftFree found{record, period, largest.share};
  const auto edge = static_cast<Index>(std::lround(period / interval));
  const Index left = record.size() - 2 * edge;
  found.record.time = record.time.segment(edge, left);
  found.record.samples.resize(record.samples.rows(), left);
  DecimatedSignal signal;
  signal.interval = interval;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    signal.samples = record.samples.row(i).transpose();
    found.record.samples.row(i) = without_sway(signal, period).samples.transpose();
  }
  return found;
}

}  // namespace beamid::experiments
