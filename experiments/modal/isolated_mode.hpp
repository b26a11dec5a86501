// One mode of a free decay, cut out of the others.
#pragma once

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/envelope_line.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
