// Which damping law a free decay supports: viscous, Coulomb, quadratic, or both of these.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/text/objection.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

// A record in which one slow mode is left, and the noise near it.

/// Low-passed and decimated (signal/decimation.hpp) to about eight samples per period.
struct SlowRecord {
  Eigen::VectorXd time;        ///< (M) [s]
  Eigen::MatrixXd samples;     ///< (p x M)
  double interval = 0.0;       ///< between them [s]
  int factor = 1;              ///< of the decimation
  int steps = 1;               ///< of the motion between two samples
  filters::Measurements fine;  ///< the same at every step, outputs NaN where there is no sample

  /// Columns of the samples among those of all steps (p x M).
  Eigen::MatrixXd measured(const Eigen::MatrixXd& fine_columns) const;
};

/// @param inputs of the record, m; @param frequency_hz of the mode
SlowRecord slow_record(const filters::Measurements& record, Eigen::Index inputs, double frequency_hz);

/// Deviation of white noise as dense as what is left of a record near a frequency, between half and one and a
/// half times it, or as all of it where that is more (p).
/// @param left (p x M); @param fitted numbers of unknowns that took their part of it away
Eigen::VectorXd noise_near(const Eigen::MatrixXd& left, double interval, double frequency_hz, double fitted);

/// "viscous", "coulomb", "quadratic", "both": C x' and these terms beside it.
const std::vector<std::string>& damping_laws();

/// One law fitted by maximum likelihood.
struct FittedLaw {
  std::string name;
  JointModel model;
  bool possible = false;            ///< determined by the record, and no term feeds energy in
  std::string reason;               ///< why not
  std::vector<Estimate> estimates;  ///< of the unknowns; empty where the fit failed
  Eigen::VectorXd state;            ///< the start, parameters included
  double log_likelihood = 0.0;
  Eigen::Index unknowns = 0;  ///< start, offsets and parameters
  double aic = 0.0, bic = 0.0;
  Eigen::MatrixXd left;  ///< residuals of the samples used (p x M)

  double value(const std::string& quantity) const;  ///< of an unknown; 0 where the law has no such term

  /// C + 4 F_c / (pi a w) + 8 c_2 a w / (3 pi) over 2 sqrt(K M): of the viscous damping that dissipates as
  /// much in a cycle of amplitude a [m] [jacobsen1930].
  double damping_ratio(double amplitude) const;
  double frequency_hz(double amplitude) const;  ///< sqrt((K + 3/4 K3 a^2) / M) / 2 pi
};

/// What a law leaves of frequency and damping ratio in sections of a decay.
struct LawMisfit {
  Eigen::Index sections = 0, freedom = 0;
  double chi_square = 0;
  bool tested = false;      ///< there are more values than unknowns
  bool lacks = false;       ///< chi^2 above its 95 %
  double largest = 0;       ///< of the damping ratio, relative to the law's
  double at_amplitude = 0;  ///< there [m]
};

/// What a record says of its damping.
struct DampingLawStudy {
  ModalEstimate modal;      ///< of the first channel
  Eigen::VectorXd time;     ///< of the samples used (M) [s]
  Eigen::MatrixXd samples;  ///< used: low-passed, decimated (p x M)
  Eigen::VectorXd noise;    ///< of all fits alike (p)
  int decimation = 1;
  double friction_velocity = 0.0;  ///< [m/s]
  /// Of the displacement [m]: at the record's beginning, and where it ends or noise hides its damping.
  double first_amplitude = 0.0, last_amplitude = 0.0;
  std::vector<AmplitudePoint> sections;  ///< that share no sample, amplitudes as displacement [m]
  LawMisfit misfit;                      ///< of the law supported
  std::vector<Objection> objections;     ///< to the record
  std::vector<std::string> remarks;      ///< on the record
  std::vector<FittedLaw> laws;           ///< in the order of damping_laws(), or viscous and the one named
  std::size_t chosen = 0;                ///< of laws: the lowest BIC of those possible, or the one named
  bool named = false;

  const FittedLaw& supported() const { return laws[chosen]; }
};

/// Fits the laws to one record with one noise (model `damped`, cubic stiffness asked in all of them). Missing
/// readings (NaN) end the part that is taken.
///
/// The record is low-passed and decimated to about eight samples per period, which ends modes above four
/// times the frequency; the motion is integrated in 48 steps per period. The noise of each channel is what
/// the richest law leaves, and where that is denser near the mode, white noise as dense as that (between half
/// and one and a half times the frequency): a law is not preferred because it fits a neighbour's beat. The
/// best of the laws may be wrong all the same: it is held against frequency and damping ratio in sections of
/// the decay, found without it (damping_law.hpp).
///
///     AIC = 2 k - 2 ln L [akaike1974],   BIC = k ln M - 2 ln L [schwarz1978]
///
/// @param law "auto" or one of damping_laws()
/// @throws std::invalid_argument on another law, or where the record shows no mode or no law can be fitted.
DampingLawStudy study_damping_law(const Experiment& experiment, const Record& record, const std::string& law,
                                  const std::filesystem::path& folder = {});

// A damping law against sections of the decay that it was fitted to.

struct DecaySections {
  std::vector<AmplitudePoint> sections;
  double last_amplitude = 0;  ///< at the end of the last one, behind which noise hides the damping [m]
};

/// Frequency and damping ratio of the first channel's mode in sections that share no sample, along the decay
/// (amplitude_dependence.hpp), amplitudes as displacement [m]. The noise of the mode's envelope is the same
/// in all of them: deviations are the median of deviation times amplitude, over the amplitude. A section's
/// own, from a few values, is uncertain, and larger where the damping changes within it. Empty where the
/// record is too short for any.
DecaySections decay_sections(const Record& record, const ModalEstimate& modal);

/// What a law leaves of sections: chi^2 = sum ((xi_i - xi(a_i)) / d_i)^2 + ((f_i - f(a_i)) / e_i)^2.
/// @param fitted numbers of the law that these sections had a part in
LawMisfit misfit_of(const FittedLaw& law, const std::vector<AmplitudePoint>& sections, Eigen::Index fitted);

/// Displacement that an acceleration, a velocity or a displacement of 1 has at a frequency [m].
double displacement_per_reading(Quantity quantity, double frequency_hz);

}  // namespace beamid::experiments
