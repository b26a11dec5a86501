// Frequency and damping of a decay section by section: whether one value of each will do.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "experiments/modal/dominant_mode.hpp"

namespace beamid::experiments {

// A decay whose frequency and damping follow its amplitude, fitted as one motion.

/// value + slope (g - pivot): slope and value at the pivot are uncorrelated.
struct LawLine {
  double value = 0, slope = 0, pivot = 0;
  double slope_deviation = 0;

  double at(double g) const { return value + slope * (g - pivot); }
};

/// With which amplitude it follows: g(A) = (A / A0)^power, or log(A / A0) for power 0.
struct AmplitudeShape {
  double power = 1;
  double log_reference = 0;  ///< log A0

  double at(double log_amplitude) const;
};

/// Where the iteration starts: straight lines over g, and the amplitude at the first sample.
struct AmplitudeLawStart {
  double frequency_hz = 0, frequency_slope = 0;
  double damping_ratio = 0, damping_slope = 0;
  double log_amplitude = 0;
};

/// How frequency and damping of a decay follow its amplitude.
struct AmplitudeLaw {
  LawLine frequency_hz, damping_ratio;
  double squares = 0, freedom = 0;  ///< of the residuals
  Eigen::VectorXd shape;            ///< g at the instants asked for
};

/// Least squares of
///
///     y = offset + Re z,    z' = (s0 + s1 g(|z|)) z,    s = -damping rate + i damped angular frequency
///
/// over a signal (N). It knows the phase from one end to the other, where fits of n sections know it within
/// each: its slopes are up to n times as sure. Gauss-Newton steps, g(|z(t)|) taken from the step before;
/// deviations are those for white noise.
/// @param instants after the first sample, rising; below 0 z is continued backwards [s]
/// @throws std::runtime_error when it does not converge.
AmplitudeLaw fit_amplitude_law(const Eigen::VectorXd& signal, double interval, const AmplitudeShape& shape,
                               const AmplitudeLawStart& start, const Eigen::VectorXd& instants);

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
  Eigen::VectorXd
      values;           ///< at instants evenly spread over the decay, by the best law; empty: not above 1 %
  double scatter = 0;   ///< standard deviation of the sections about the laws beyond their noise
  double walk = 0;      ///< standard deviation that a walk of the phase adds (phase_walk.hpp)
  double constant = 1;  ///< probability that it is one
  /// What it is by every law (a column each), with slopes as they may be, at these instants.
  Eigen::MatrixXd possible;
  Eigen::VectorXd weight;  ///< probability of every law; with `constant`, they sum to one

  /// For a report. Intervals do not ask.
  bool varies() const { return values.size() > 0; }
};

/// A decay in sections, and how frequency and damping change from one to the next.
struct AmplitudeSections {
  std::vector<DecaySection> sections;  ///< three at least, or none: too short, or too much is missing
  double noise =
      0;  ///< standard deviation of white noise as dense as what the sections leave [unit of signal]
  SectionTrend frequency, damping;
};

/// Three to ten sections of three periods or more, each fitted by itself (fit_damped_sines) behind the
/// decimation of the modal analysis; then laws v = a + b g(A) of the amplitude A through all of them as one
/// motion (amplitude_sections.hpp), g(A) = A^2, A, sqrt A, log A and 1/A (friction that grows with velocity,
/// ..., Coulomb's). With the likelihood L of the constant and L_g of each law,
///
///     P(constant) = L / (L + sum_g w L_g),   w = 0.05 / 5,   b_g ~ N(0, B_g^2) beforehand,
///
/// B_g making a change over the decay of 0.4 % of the frequency or four fifths of the damping ratio. A report
/// says that the quantity varies where the best law's b is not zero, or the sections scatter about their
/// lines, with a probability below 1 %. Sections whose amplitude has fallen to three deviations of the noise
/// are left out; none are made beside a companion mode, whose beat is not a matter of amplitude.
/// @param signal (N), finite @param read share of its samples that were read, not filled in
AmplitudeSections amplitude_sections(const Eigen::VectorXd& signal, double interval,
                                     const ModalEstimate& modal, double read = 1);

/// Half width h of an interval about an estimate that holds the decay's value in 95 of 100 cases, constant or
/// not, each with its probability:
///
///     P(constant) P(|deviation z| < h) + sum_g P_g mean over the decay of P(|v_g(t) - estimate + s z| < h) =
///     0.95,
///
/// z ~ N(0, 1), s^2 = deviation_where_it_varies^2 + scatter^2. 1.96 deviations where no law was fitted. A
/// walk of the phase adds its variance to that of the deviation, and is part of the scatter.
double section_half_width(const SectionTrend& trend, double estimate, double deviation,
                          double deviation_where_it_varies);

}  // namespace beamid::experiments
