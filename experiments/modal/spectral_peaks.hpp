// Peaks of a spectrum that stand out of noise and of each other's skirts.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
