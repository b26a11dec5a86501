#include "experiments/signal/spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;

// exp(-2 pi i j / n), j = 0 ... n - 1.
Eigen::VectorXcd unit_turns(Eigen::Index n) {
  Eigen::VectorXcd turns(n);
  for (Eigen::Index j = 0; j < n; ++j)
    turns[j] = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(n));
  return turns;
}

Eigen::MatrixXcd summed_lines(const Eigen::MatrixXd& columns, Eigen::Index first, Eigen::Index count) {
  const Eigen::Index n = columns.rows();
  const Eigen::VectorXcd turns = unit_turns(n);
  Eigen::MatrixXcd lines(columns.cols(), count);
  Eigen::VectorXcd turned(n);
  for (Eigen::Index m = 0; m < count; ++m) {
    for (Eigen::Index j = 0; j < n; ++j) turned[j] = turns[(j * (first + m)) % n];
    lines.col(m) = columns.transpose() * turned;
  }
  return lines;
}

// j k = (j^2 + k^2 - (k - j)^2) / 2 makes of the sum a convolution with the chirp exp(pi i q^2 / n); the
// squares are reduced modulo 2 n as whole numbers, so that phases have all their digits.
Eigen::MatrixXcd chirped_lines(const Eigen::MatrixXd& columns, Eigen::Index first, Eigen::Index count) {
  const Eigen::Index n = columns.rows();
  const auto length = static_cast<Eigen::Index>(std::bit_ceil(static_cast<std::size_t>(n + count - 1)));
  const Eigen::VectorXcd turns = unit_turns(2 * n);
  const auto chirp = [&](Eigen::Index q) { return turns[(q * q) % (2 * n)]; };
  Eigen::FFT<double> transform;
  Eigen::VectorXcd kernel = Eigen::VectorXcd::Zero(length), spectrum, padded(length), product;
  for (Eigen::Index q = 1 - n; q < count; ++q) kernel[(q + length) % length] = std::conj(chirp(first + q));
  transform.fwd(spectrum, kernel);
  Eigen::MatrixXcd lines(columns.cols(), count);
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    padded.setZero();
    for (Eigen::Index j = 0; j < n; ++j) padded[j] = columns(j, c) * chirp(j);
    transform.fwd(product, padded);
    product.array() *= spectrum.array();
    transform.inv(padded, product);
    for (Eigen::Index m = 0; m < count; ++m) lines(c, m) = chirp(first + m) * padded[m];
  }
  return lines;
}

/// Lines of a signal without its mean under a Hann window, padded with zeros to a power of two, at least
/// twice its length.
struct PaddedSpectrum {
  std::vector<Complex> lines;
  std::size_t length = 0;
};

PaddedSpectrum padded_spectrum(const Eigen::VectorXd& signal) {
  const auto count = static_cast<std::size_t>(signal.size()), length = std::bit_ceil(2 * count);
  const double mean = signal.mean(), turn = 2.0 * std::numbers::pi / static_cast<double>(count);
  std::vector<double> padded(length, 0.0);
  for (std::size_t k = 0; k < count; ++k)
    padded[k] = (signal[static_cast<Eigen::Index>(k)] - mean) *
                (1.0 - std::cos(turn * (static_cast<double>(k) + 0.5)));
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  PaddedSpectrum found{{}, length};
  transform.fwd(found.lines, padded);
  return found;
}

}  // namespace

AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& signal, double interval) {
  const auto& [spectrum, length] = padded_spectrum(signal);
  const auto count = static_cast<double>(signal.size());
  const auto size = static_cast<Eigen::Index>(spectrum.size());
  AmplitudeSpectrum result{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  for (Eigen::Index k = 0; k < size; ++k) {
    result.frequency_hz[k] = static_cast<double>(k) / (static_cast<double>(length) * interval);
    result.amplitude[k] =
        2.0 / count * std::sqrt(std::norm(spectrum[static_cast<std::size_t>(k)]));  // the window's mean is 1
  }
  return result;
}

SpectrumShare share_near(const AmplitudeSpectrum& spectrum, double frequency_hz) {
  constexpr double near = 0.1;
  const auto squares = spectrum.amplitude.array().square();
  const auto inside = (spectrum.frequency_hz.array() / frequency_hz - 1.0).abs() < near;
  return {inside.select(squares, 0.0).sum() / squares.sum(),
          static_cast<double>(inside.count()) / static_cast<double>(squares.size())};
}

double strongest_frequency(const Eigen::VectorXd& signal, double interval) {
  const auto count = static_cast<std::size_t>(signal.size());
  if (count < 16)
    throw std::invalid_argument("signal of " + std::to_string(count) +
                                " samples; expected at least 16 to find its frequency");
  const auto& [lines, length] = padded_spectrum(signal);
  Eigen::VectorXd magnitude(static_cast<Eigen::Index>(lines.size()));
  std::ranges::transform(lines, magnitude.begin(),
                         [](const Complex& line) { return std::sqrt(std::norm(line)); });
  const auto first = magnitude.begin() + static_cast<std::ptrdiff_t>(2 * length / count + 1);
  const auto peak = std::max_element(first, magnitude.end() - 1);
  if (!(*peak > 0)) throw std::invalid_argument("a signal without any variation has no frequency");
  const double left = std::log(*(peak - 1)), centre = std::log(*peak), right = std::log(*(peak + 1));
  const double curvature = left - 2 * centre + right;
  const double shift = curvature < 0 ? 0.5 * (left - right) / curvature : 0;
  const double frequency =
      (static_cast<double>(peak - magnitude.begin()) + (std::isfinite(shift) ? shift : 0)) /
      (static_cast<double>(length) * interval);
  // At the lower end of the range, which need be no peak, the parabola may lead below zero.
  return std::max(frequency, 1.0 / (static_cast<double>(count) * interval));
}

Eigen::MatrixXcd spectrum_lines(const Eigen::MatrixXd& signals, Eigen::Index samples, Eigen::Index lines) {
  Eigen::MatrixXcd found(signals.rows(), lines);
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> spectrum;
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    const Eigen::VectorXd signal = signals.row(i).head(samples).transpose();
    transform.fwd(spectrum, std::vector<double>(signal.begin(), signal.end()));
    for (Eigen::Index k = 0; k < lines; ++k)
      found(i, k) = spectrum[static_cast<std::size_t>(k + 1)] / std::sqrt(static_cast<double>(samples));
  }
  return found;
}

Eigen::MatrixXcd lines_between(const Eigen::MatrixXd& columns, Eigen::Index first, Eigen::Index count) {
  constexpr Eigen::Index few = 1 << 20;  // products of a column
  if (count < 1 || columns.rows() < 1) return Eigen::MatrixXcd(columns.cols(), 0);
  return columns.rows() <= few / count ? summed_lines(columns, first, count)
                                       : chirped_lines(columns, first, count);
}

Eigen::Index last_strong_line(const Eigen::MatrixXcd& lines) {
  constexpr double all_but = 1e-3;
  Eigen::Index last = 0;
  for (Eigen::Index i = 0; i < lines.rows(); ++i) {
    const Eigen::VectorXd power = lines.row(i).cwiseAbs2().transpose();
    double above = 0.0;
    Eigen::Index k = power.size() - 1;
    for (const double limit = all_but * power.sum(); k > last && (above += power[k]) < limit;) --k;
    last = std::max(last, k);
  }
  return last;
}

Eigen::MatrixXd line_rows(const Eigen::MatrixXcd& lines) {
  Eigen::MatrixXd rows(2 * lines.rows(), lines.cols());
  rows << lines.real(), lines.imag();
  return rows;
}

}  // namespace beamid::experiments
