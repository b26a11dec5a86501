// Fewer samples per second, with frequency and damping intact.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace beamid::experiments {

/// A low-passed signal, every `factor`-th sample of it.
struct DecimatedSignal {
  Eigen::VectorXd samples;  ///< (M)
  double interval = 0;      ///< between the samples kept [s]
  double start = 0;         ///< first sample kept, after the first one given [s]
  int factor = 1;
  Eigen::VectorXd kernel;  ///< of the low-pass, symmetric, sum 1

  /// sum_k h_k e^(s (k - centre) dt): what became of e^(s t). Nearly 1 up to 0.3 of the new sampling rate.
  std::complex<double> response(std::complex<double> rate) const;
};

/// The whole number at or below `wanted`, from 1 to `most`.
int decimation_factor(double wanted, Eigen::Index most);

/// Low-pass by a symmetric finite impulse response (sinc under a Kaiser window, 60 dB [kaiser1974]) of
/// 10 factor + 1 samples, where it lies wholly inside the signal (N), at every `factor`-th sample.
///
/// A finite response has no poles: what remains of a free decay has exactly its frequency and damping from
/// the first sample to the last, without transients. A recursive low-pass would keep them only after its own
/// transient, a zero-phase one only between two. The price is 5 factor samples at each end.
/// Passes up to 0.3 of the new sampling rate; what lies above 0.7 of it is stopped, so that nothing folds
/// back below 0.3. Factor 1 returns the signal itself.
/// @throws std::invalid_argument when the factor is below 1 or the signal shorter than the kernel.
DecimatedSignal decimate(const Eigen::VectorXd& signal, double interval, int factor);

/// The same of every channel, a row each (p x N): what is kept of them (p x M). The first column lies
/// 5 factor samples after the first one given, or is it for factor 1.
Eigen::MatrixXd decimate_channels(const Eigen::MatrixXd& channels, int factor);

}  // namespace beamid::experiments
