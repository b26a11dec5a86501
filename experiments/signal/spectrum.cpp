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

// Transforms of a power of two in place: of a long record the spectrum takes the most memory.

Complex product(const Complex& a, const Complex& b) {  // without the standard's care for infinite factors
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// exp(-2 pi i t(k)) for k < count, where t adds up over the binary digits of k: the product of two, of the
/// upper and of the lower half of the digits, from tables of about sqrt(count) entries.
class Turns {
 public:
  template <class Fraction>
  Turns(std::size_t count, const Fraction& t) : bits_(static_cast<int>(std::bit_width(count)) / 2) {
    const auto turn = [&](std::size_t k) { return std::polar(1.0, -2 * std::numbers::pi * t(k)); };
    for (std::size_t k = 0; k < std::size_t{1} << bits_; ++k) lower_.push_back(turn(k));
    for (std::size_t k = 0; k < count; k += std::size_t{1} << bits_) upper_.push_back(turn(k));
  }
  Complex operator[](std::size_t k) const {
    return product(upper_[k >> bits_], lower_[k & ((std::size_t{1} << bits_) - 1)]);
  }

 private:
  int bits_;
  std::vector<Complex> lower_, upper_;
};

/// The binary digits of k mirrored behind the point: 1/2, 1/4, 3/4, 1/8 of 1, 2, 3, 4.
double mirrored(std::size_t k) {
  double fraction = 0.0;
  for (double digit = 0.5; k > 0; k >>= 1, digit *= 0.5) fraction += k & 1 ? digit : 0.0;
  return fraction;
}

/// z as coefficients of a polynomial modulo x^n - w^2, w = exp(-pi i mirrored(block)): halved into the
/// remainders modulo x^(n/2) - w and x^(n/2) + w, blocks 2 block and 2 block + 1 of half the size, until they
/// are values, in the mirrored order of their lines. Depth first, so that small blocks stay in the cache.
void halve(Complex* z, std::size_t n, std::size_t block, const Turns& turns) {
  if (n < 2) return;
  const std::size_t half = n / 2;
  const Complex w = turns[block];
  for (std::size_t j = 0; j < half; ++j) {
    const Complex low = z[j], high = product(w, z[j + half]);
    z[j] = low + high;
    z[j + half] = low - high;
  }
  halve(z, half, 2 * block, turns);
  halve(z + half, half, 2 * block + 1, turns);
}

/// Z_k = sum_j z_j exp(-2 pi i j k / n), n a power of two.
void transform_in_place(Complex* z, std::size_t n) {
  halve(z, n, 0, Turns(std::max<std::size_t>(1, n / 2), [](std::size_t k) { return 0.5 * mirrored(k); }));
  for (std::size_t k = 0, other = 0; k < n; ++k) {  // other: k with its digits mirrored
    if (k < other) std::swap(z[k], z[other]);
    std::size_t digit = n / 2;
    for (; digit > 0 && (other & digit) != 0; digit /= 2) other ^= digit;
    other |= digit;
  }
}

/// Lines 0 ... n of 2 n real numbers that stand in pairs as z_j = x_2j + i x_2j+1, n a power of two: with
/// their transforms E and O of even and odd entries, X_k = E_k + W^k O_k, W = exp(-pi i / n), and
/// Z_k = E_k + i O_k. @param z (n + 1), the last entry without meaning
void lines_of_pairs(std::vector<Complex>& z) {
  const std::size_t n = z.size() - 1;
  transform_in_place(z.data(), n);
  const Turns turns(n, [n](std::size_t k) { return 0.5 * static_cast<double>(k) / static_cast<double>(n); });
  z[n] = z[0].real() - z[0].imag();
  z[0] = z[0].real() + z[0].imag();
  for (std::size_t k = 1; k <= n / 2; ++k) {
    const Complex a = z[k], b = std::conj(z[n - k]), even = 0.5 * (a + b),
                  odd = product(Complex(0.0, -0.5), a - b), turned = product(turns[k], odd);
    z[k] = even + turned;
    z[n - k] = std::conj(even - turned);
  }
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
  PaddedSpectrum found{std::vector<Complex>(length / 2 + 1), length};
  const auto tapered = [&](std::size_t k) {
    return k < count ? (signal[static_cast<Eigen::Index>(k)] - mean) *
                           (1.0 - std::cos(turn * (static_cast<double>(k) + 0.5)))
                     : 0.0;
  };
  for (std::size_t j = 0; 2 * j < count; ++j) found.lines[j] = {tapered(2 * j), tapered(2 * j + 1)};
  lines_of_pairs(found.lines);
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
  const auto magnitude = [](const Complex& line) { return std::sqrt(std::norm(line)); };
  const auto first = lines.begin() + static_cast<std::ptrdiff_t>(2 * length / count + 1);
  const auto peak = std::ranges::max_element(first, lines.end() - 1, {}, magnitude);
  if (!(magnitude(*peak) > 0)) throw std::invalid_argument("a signal without any variation has no frequency");
  const double left = std::log(magnitude(*(peak - 1))), centre = std::log(magnitude(*peak)),
               right = std::log(magnitude(*(peak + 1)));
  const double curvature = left - 2 * centre + right;
  const double shift = curvature < 0 ? 0.5 * (left - right) / curvature : 0;
  const double frequency = (static_cast<double>(peak - lines.begin()) + (std::isfinite(shift) ? shift : 0)) /
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
