// Where in frequency a signal is strongest.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

// What frequencies a signal holds.

struct AmplitudeSpectrum {
  Eigen::VectorXd frequency_hz;
  Eigen::VectorXd amplitude;  ///< in the signal's unit
};

/// Amplitudes at 0 to half the sampling rate of a signal (N) without its mean, under a Hann window, padded
/// with zeros to at least 2 N: a steady sine of amplitude a peaks at a.
AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& signal, double interval);

/// What lies within a tenth of a frequency [Hz].
struct SpectrumShare {
  double squares = 0, lines = 0;  ///< of all squares, and of all lines
};
SpectrumShare share_near(const AmplitudeSpectrum& spectrum, double frequency_hz);

/// Frequency [Hz] of the largest magnitude in the spectrum of a signal (N), its mean removed, under a Hann
/// window and zero-padded to at least 2 N; the peak is refined by a parabola through the logarithms.
///
/// Frequencies with fewer than two cycles in the signal are left out: the window cannot tell them from a
/// trend.
/// @throws std::invalid_argument when the signal has fewer than 16 samples or does not vary.
double strongest_frequency(const Eigen::VectorXd& signal, double interval);

/// Discrete Fourier transforms of the first N samples of every row, divided by sqrt(N), at the lines 1, 2,
/// ..., L (p x L): white noise of deviation sigma has E |X|^2 = sigma^2 at every line.
Eigen::MatrixXcd spectrum_lines(const Eigen::MatrixXd& signals, Eigen::Index samples, Eigen::Index lines);

/// Discrete Fourier transforms of the columns of x (N x c) at the lines first, ..., first + count - 1 (c x
/// count): X_k = sum_j x_j exp(-2 pi i j k / N). Few products are summed directly; more of them take
/// Bluestein's chirp transform, O((N + count) log(N + count)) for any N, prime ones included.
Eigen::MatrixXcd lines_between(const Eigen::MatrixXd& columns, Eigen::Index first, Eigen::Index count);

/// The last line up to which all but a thousandth of every row's squares lie. @param lines (p x L)
Eigen::Index last_strong_line(const Eigen::MatrixXcd& lines);

/// Complex lines as real rows: real parts of all, then imaginary ones (2 rows).
Eigen::MatrixXd line_rows(const Eigen::MatrixXcd& lines);

}  // namespace beamid::experiments
