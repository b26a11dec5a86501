// What a record shows by itself: worked out once, whatever models it is identified with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/verdict/amplitude_sections.hpp"
#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/modal/close_pair.hpp"
#include "experiments/modal/decay_jump.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/phase_walk.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

// Higher modes are no noise: they are kept from a filter that knows one mode.

/// A step `decimate` to eight samples per cycle, where the spectrum of what the mode leaves has a line above
/// twice its frequency more than six times the noise at the mode: a filter of one mode takes that for white
/// noise, errs by a share of its deviation that grows with that ratio (1 at a ratio of 40 over 30 cycles),
/// and loses the mode where another is larger. Finite low-passes leave frequency and damping as they are.
/// Nothing where no line is as high, or the record has too few samples per cycle.
/// @throws as identify_record()
std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record);

// What frequency a record shows, whatever model looks at it: an aid, never a condition.

/// A frequency that a record shows by itself.
struct RecordedFrequency {
  std::optional<double> value_hz;  ///< absent: could not be had
  std::string failure;             ///< why not
};

/// Of the mode near the expected frequency: with measured inputs from the response to them (forced_mode),
/// without any as a free decay (dominant_mode).
/// @param output (N), @param inputs (m x N), m may be 0
RecordedFrequency recorded_frequency(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs,
                                     double interval, double expected_hz);

// Whether the channels of a free decay are as large, beside each other, as the mode's shape makes them.

struct RecordAnalysis;

/// In the mode s of a free decay, y_i = Re(a_i e^(st)), the structure as described moves by u_i where channel
/// i sits, so that
///
///     a_i / a_1 = (u_i s^k_i) / (u_1 s^k_1),   k = 0, 1, 2 of displacement and strain, velocity,
///     acceleration
///
/// A channel whose unit is wrong is off by a large factor, which no K and C make up for: the filter shares
/// the contradiction among them. A place that is 10 % of the length off makes a factor of 1.2 or so.
struct ChannelAmplitudes {
  std::string text;  ///< names channels off by a factor of 1.5 or more, beyond their noise, or with the wrong
                     ///< sign; empty: none is, the motion is forced, or the analysis has no mode
  bool contradict =
      false;  ///< one by a factor of 3 or its sign, which no place that is not quite right makes
};

ChannelAmplitudes channel_amplitudes(const Experiment& experiment, const RecordAnalysis& analysis);

/// Smallest noise taken from a record, relative to its size. One simulated without noise would else make P0
/// and R differ by more digits than double precision has.
inline constexpr double smallest_relative_noise = 1e-6;

/// Beside the record itself: its even form, its mode, the noise at it.
struct RecordAnalysis {
  Record record;          ///< every channel knows its place; stamps as they are, NaN where nothing was read
  AnalysableRecord even;  ///< what a spectrum or a low-pass takes: even stamps, short gaps filled
  double beam_frequency_hz = 0;            ///< first mode of the beam as described
  double expected_hz = 0;                  ///< of the mode looked for, as this sampling rate shows it
  bool aliased = false;                    ///< the beam's first mode lies above half the sampling rate
  std::optional<ModalEstimate> modal;      ///< of the first output, of a free decay; absent: none was found
  std::string modal_failure;               ///< why not: its least squares
  std::string modal_refusal;               ///< why not: what the record is
  Eigen::VectorXd mode_noise;              ///< residual_noise() of `modal`; empty without one (p)
  std::optional<NoiseNearMode> near_mode;  ///< noise_at() `modal`
  std::optional<FoundMode> mode;           ///< what models are checked against; a force may drive it
  AmplitudeSections sections;              ///< of the first output, where asks_free_oscillator() and `modal`
  std::optional<DecayJump> jump;           ///< of the first output of `even`, from its first sample
  std::optional<ThirdOvertone> overtone;   ///< of the first output
  std::optional<ClosePair> pair;           ///< in the place of `modal`
  std::optional<PhaseWalk> walk;           ///< of K and C; no pair or jump explains it
  ChannelAmplitudes channels;              ///< of all outputs, beside each other
  std::vector<std::string> notes;
  std::vector<Objection> objections;

  bool forced() const;  ///< whether a force was measured
  /// The record itself where its stamps are even, missing samples and all; else `even`.
  const Record& evenly_stamped() const;
  /// Standard deviation of what the mode leaves of every output (p), at least 1e-6 of the largest reading.
  Eigen::VectorXd residual_noise(const ModalEstimate& mode) const;
  /// Of the first output, of one reading.
  NoiseNearMode noise_at(const ModalEstimate& mode) const;
};

/// Places of the channels, even stamps, the mode near the one that the beam as described leads to expect, or
/// prior.stiffness_n_per_m of one degree of freedom.
///
/// A modal analysis that fails ends nothing: the reason is kept, and the frequency of the response to
/// measured forces, or the beam's, takes its place.
/// @throws std::invalid_argument without a channel of motion, with a dead one or one at an unknown place
RecordAnalysis analyse(const Experiment& experiment, const Record& record);

/// As analyse(), for decisions before the identification: no overtone, no jump of the frequency, no sections,
/// no comparison of the channels. @throws as analyse()
RecordAnalysis analyse_mode(const Experiment& experiment, const Record& record);

/// Whether K and C of a free decay are asked, which have a verdict and a report of their own.
bool asks_free_oscillator(const Experiment& experiment, const Record& record);

/// Of the mode that is looked for [Hz], as it is and not as the sampling rate shows it.
double described_frequency_hz(const Experiment& experiment, const Record& record);

/// The frequency at which a record of this rate shows a mode: below half the rate its own, above it another.
double shown_at(double frequency_hz, double sampling_rate_hz);

// What in a free decay speaks against any one frequency and damping ratio of it (verdict/free_modes.cpp).

/// What speaks against one frequency and damping ratio of a free decay.
struct DecayObjection {
  Objection objection;
  bool contradicts = false;  ///< the estimates are not to be relied on
};

/// - A frequency that follows the amplitude by 0.2 % and five standard deviations (amplitude_trend() of the
///   sections), and by half of the half-power width. Where it moves by more than that width and the damping
///   ratio as identified is that of no part of the decay, it contradicts.
/// - A jump of the motion (decay_jump.hpp) in what was identified: no single decay goes across it. By a
///   twentieth of the amplitude, or of a radian, or of its frequency, it contradicts.
/// - The overtone of a sensor that saturates softly (amplitude_dependence.hpp), where the damping ratio is
/// wrong by
///   more than its interval through it, and the frequency does not follow the amplitude as that of a spring
///   would; it contradicts from twice the interval on.
/// - Two modes in the place of a model's only one (close_pair.hpp); where they win, or nothing is determined,
///   it contradicts.
/// - Phases that wander (phase_walk.hpp), which the deviations allow for.
/// @param mode as identified, with its deviations as they are reported
/// @param alone whether the model has no other mode
std::vector<DecayObjection> decay_objections(const RecordAnalysis& analysis, const FoundMode& mode,
                                             bool alone);

}  // namespace beamid::experiments
