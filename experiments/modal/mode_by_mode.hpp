// Methods that take one mode of a free decay at a time, at the peaks of its spectrum.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {

// A mode of a record that was driven throughout by measured inputs.

// One mode of a free decay, cut out of the others.

/// The mode's analytic signal, turned back by w and freed from its neighbours (demodulate), as far as it
/// stands five times above what a straight line through its logarithm leaves.
struct IsolatedMode {
  double turned_back = 0;      ///< w [rad/s]
  Eigen::VectorXcd values;     ///< (M) z(t), half the amplitude's complex envelope
  double interval = 0;         ///< [s]
  double correlation = 0;      ///< length over which noise stays correlated [s]
  double noise = 0;            ///< rms of z less the line [unit of the signal]
  EnvelopeLine line;           ///< through log z
  Eigen::VectorXcd logarithm;  ///< (M)

  std::complex<double> rate() const { return line.slope + std::complex<double>(0, turned_back); }
  /// Of the values, those that the noise makes independent, per value.
  double independent() const { return interval / correlation; }
};

/// @param others rates of all modes of the signal, by which the kernel is chosen (demodulate); this one's
/// own, of that very frequency, does not count
/// @throws std::invalid_argument when the signal is shorter than 1.5 kernels.
IsolatedMode isolate(const Eigen::VectorXd& signal, double interval, double frequency_hz,
                     const std::vector<std::complex<double>>& others);

struct ForcedMode {
  double frequency_hz = 0;  ///< undamped
  double damping_ratio = 0;
};

/// The mode near an expected frequency, from the lines s = i 2 pi k / T of output and inputs between 0.7 and
/// 1.4 times it. Whatever the motion begins and ends with, a record of length T obeys
///
///     (s^2 + 2 xi w s + w^2) Y = sum_j (b_j0 + b_j1 s + b_j2 s^2) U_j + c_0 + c_1 s + c_2 s^2
///
/// the c being what start and end differ by, the b with the modes outside the band. Linear least squares in
/// all coefficients, the lines weighed by the left side's factor of the iteration before [sanathanan1963].
///
/// It is meant for a first estimate: noise of the inputs biases it, and so does, by up to half an interval,
/// how they ran between samples.
/// @param output (N), @param inputs (m x N); what is missing is bridged
/// @throws std::invalid_argument when the band holds too few lines, or no mode that explains half of them.
ForcedMode forced_mode(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs, double interval,
                       double expected_hz);

// Peaks of a spectrum that stand out of noise and of each other's skirts.

/// A peak of the root of the summed squares of all channels' amplitude spectra.
struct SpectralLine {
  double frequency_hz = 0, amplitude = 0;
};

/// What makes a value of the spectrum a line.
struct LineSettings {
  double above_noise = 4;   ///< times the median of the spectrum around
  double above_valley = 2;  ///< times the valley between it and any larger line
  double least = 0;         ///< of the largest value of the spectrum
};

/// Lines by rising frequency, in the root of the summed squares of all channels' amplitude spectra (Hann
/// window). A line
///   - is the largest value within two resolutions 1 / T to either side, the window's main lobe;
///   - lies above 4 times the median of the spectrum around it, which of Rayleigh-distributed noise a value
///     exceeds with probability 2^-16 (6 times: 2^-36);
///   - rises to twice the valley between it and any larger line.
/// @param outputs (p x N), one column per instant, channels of about the same size
std::vector<SpectralLine> spectral_lines(const Eigen::MatrixXd& outputs, double interval,
                                         const LineSettings& settings = {});

/// Their frequencies [Hz].
std::vector<double> spectral_peaks(const Eigen::MatrixXd& outputs, double interval);

/// What a method makes of one isolated mode. Deviations [rad/s] are NaN where unknown.
struct ModeAnswer {
  std::complex<double> rate;  ///< [rad/s]
  double frequency_deviation = Pole::unknown, damping_rate_deviation = Pole::unknown;
  std::string remark = {};  ///< a sentence; empty: none
};

/// search() finds the peaks (spectral_peaks), isolates each mode in the channel where it is largest and asks
/// estimate(); a mode that cannot be isolated, does not decay or is less certain than its own size is
/// refused, with the reason.
class ModeByModeMethod : public ModalMethod {
 public:
  PoleSearch search(const Eigen::MatrixXd& outputs, double interval, int largest_order) const final;

 private:
  /// @throws std::invalid_argument when the mode is too short for the method.
  virtual ModeAnswer estimate(const IsolatedMode& mode) const = 0;
};

}  // namespace beamid::experiments
