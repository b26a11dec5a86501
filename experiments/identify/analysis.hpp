// What a record shows by itself: worked out once, whatever models it is identified with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/amplitude_sections.hpp"
#include "experiments/identify/channel_amplitudes.hpp"
#include "experiments/identify/noise_near_mode.hpp"
#include "experiments/modal/decay_jump.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/third_overtone.hpp"
#include "experiments/models/divergence.hpp"
#include "experiments/record/prepare/analysable_record.hpp"

namespace beamid::experiments {

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
  ChannelAmplitudes channels;              ///< of all outputs, beside each other
  std::vector<std::string> notes, warnings;

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

/// Whether K and C of a free decay are asked, which have a verdict and a report of their own.
bool asks_free_oscillator(const Experiment& experiment, const Record& record);

/// Of the mode that is looked for [Hz], as it is and not as the sampling rate shows it.
double described_frequency_hz(const Experiment& experiment, const Record& record);

/// The frequency at which a record of this rate shows a mode: below half the rate its own, above it another.
double shown_at(double frequency_hz, double sampling_rate_hz);

}  // namespace beamid::experiments
