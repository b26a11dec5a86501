// What frequencies a signal holds.
#pragma once

#include <Eigen/Core>

namespace beamid::experiments {

struct AmplitudeSpectrum {
  Eigen::VectorXd frequency_hz;
  Eigen::VectorXd amplitude;  ///< in the signal's unit
};

/// Amplitudes at 0 to half the sampling rate of a signal (N) without its mean, under a Hann window, padded
/// with zeros to at least 2 N: a steady sine of amplitude a peaks at a.
AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& signal, double interval);

}  // namespace beamid::experiments
