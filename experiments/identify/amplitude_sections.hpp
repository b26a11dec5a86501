// Frequency and damping of a decay section by section: whether one value of each will do.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments {

/// A damped sine fitted to a part of the decay.
struct DecaySection {
  double from = 0, to = 0;  ///< after the first sample [s]
  double amplitude = 0;     ///< in its middle [unit of the signal]
  double frequency_hz = 0, frequency_deviation_hz = 0;
  double damping_ratio = 0, damping_ratio_deviation = 0;
};

/// A quantity over the decay, where it is no constant.
struct SectionTrend {
  double probability = 1;  ///< of variation as large where there is none
  /// At instants evenly spread over the decay, six rounds of them: along the line first and last, between
  /// with slopes as its own may be. Empty: taken for a constant.
  Eigen::VectorXd values;
  double scatter = 0;  ///< standard deviation of the sections about the trend beyond their noise

  bool varies() const { return values.size() > 0; }
};

struct AmplitudeSections {
  std::vector<DecaySection> sections;  ///< three at least, or none: too short, or too much is missing
  double noise =
      0;  ///< standard deviation of white noise as dense as what the sections leave [unit of signal]
  SectionTrend frequency, damping;
};

/// Three to ten sections of three periods or more, each fitted by itself (fit_damped_sines) behind the
/// decimation of the modal analysis; then lines v = a + b u through their values, with u = A, log A or 1/A of
/// the section's amplitude A (friction that grows with velocity, any, Coulomb's), the best of the three. The
/// quantity varies where b is not zero, or the sections scatter about the line, with a probability below 1
/// %. Sections whose amplitude has fallen to three deviations of the noise are left out; none are made beside
/// a companion mode, whose beat is not a matter of amplitude.
AmplitudeSections amplitude_sections(const Eigen::VectorXd& signal, double interval,
                                     const ModalEstimate& modal);

/// Half width h of an interval about an estimate that holds a section's value in 95 of 100 cases:
///
///     mean over the decay of P(|v(t) - estimate + s z| < h) = 0.95,   z ~ N(0, 1),  s^2 = deviation^2 +
///     scatter^2
///
/// 1.96 deviations where nothing varies.
double section_half_width(const SectionTrend& trend, double estimate, double deviation);

}  // namespace beamid::experiments
