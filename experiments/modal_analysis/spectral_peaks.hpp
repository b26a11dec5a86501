// Peaks of a spectrum that stand out of noise and of each other's skirts.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::experiments {

/// Frequencies of the peaks [Hz], rising, in the root of the summed squares of all channels' amplitude
/// spectra (Hann window). A peak
///   - is the largest value within two lines 1 / T to either side, the window's main lobe;
///   - lies above 4 times the median of the spectrum around it, which of Rayleigh-distributed noise a line
///     exceeds with probability 2^-16;
///   - rises to twice the valley between it and any larger peak.
/// @param outputs (p x N), one column per instant, channels of about the same size
std::vector<double> spectral_peaks(const Eigen::MatrixXd& outputs, double interval);

}  // namespace beamid::experiments
