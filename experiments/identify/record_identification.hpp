// A record identified as its experiment file says: `beamid identify`.
#pragma once

#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/amplitude_sections.hpp"
#include "experiments/identify/judgement.hpp"
#include "experiments/identify/noise_near_mode.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/identification.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

/// What all samples at once tell.
struct BatchIdentification {
  filters::BatchEstimate estimate;
  std::optional<Identification> identification;  ///< without a run; absent unless the record determines all
};

/// What a record told, before it is put into words.
struct RecordIdentification {
  JointModel model;
  double beam_frequency_hz = 0;     ///< first mode of the finite-element beam
  ModalEstimate modal;              ///< of the first channel, without any model
  std::string modal_failure;        ///< why there is none, and `modal` is the filter's own; empty: there is
  Eigen::VectorXd noise_deviation;  ///< of every channel (p)
  std::vector<bool> noise_from_record;    ///< whether it is what the modal analysis leaves, or configured (p)
  std::string noise_method = "residual";  ///< of those from the record
  Eigen::VectorXd noise_relative_deviation;  ///< standard errors of them (p); empty: not known
  NoiseNearMode near_mode;                   ///< of the first channel
  double interval_factor = 1;  ///< of deviations: what counts is the noise near the mode, not R; 1 at least
  AmplitudeSections sections;  ///< of the first channel
  IdentificationSettings settings;  ///< of all passes but the last
  filters::Gaussian last_start;     ///< what the last pass began with
  Identification identification;

  int passes() const { return settings.passes + 1; }
  std::optional<filters::InnovationConsistency> consistency;  ///< absent when the filter failed early
  std::optional<filters::Diagnostics> diagnostics;            ///< absent below 100 samples
  Judgement judgement;
  std::vector<filters::Gaussian> smoothed;   ///< of every sample, where a smoother was asked for
  Eigen::MatrixXd reproduced;                ///< (p x N): free decay with the identified K and C
  std::optional<BatchIdentification> batch;  ///< where it was asked for

  /// What deviations of frequency and K, of damping ratio and C, are multiplied by: what holds the
  /// values of 95 % of the decay, constant or not as the record has it (section_half_width); 1 at least.
  double frequency_factor() const;
  double damping_factor() const;
  /// 100 ||y - reproduced|| / ||y|| over the samples that were measured; NaN where nothing was reproduced.
  double response_error_percent(const Record& record) const;
};

/// Of the mode that is looked for: as prior.stiffness, else the beam as described, leads to expect [Hz].
/// @throws std::invalid_argument when the beam cannot be assembled or reduced to one coordinate
double expected_frequency_hz(const Experiment& experiment, const Record& record);

/// All but the filtering: model, modal analysis, noise, initial belief and settings. A modal analysis that
/// does not converge gives way to the expected mode; its reason is kept. @throws as identify_record()
RecordIdentification prepare_identification(const Experiment& experiment, const Record& record);

/// Assemble, reduce, analyse, filter, judge. The initial belief and the noise come from the experiment where
/// it gives them, else from the beam and the record: K and C start where the modal analysis has them. Without
/// a modal analysis they start from the beam, and the noise is what the filter's own motion leaves, pass
/// after pass. Samples that are NaN were not measured.
/// @throws InputError at the model's or filter's place in the experiment file; std::invalid_argument when the
/// record shows no mode near the beam's, or the noise cannot be had as the experiment says.
/// @param quiet_noise of the channels (p), by noise_before_event(); needed where the experiment wants it.
RecordIdentification identify_record(const Experiment& experiment, const Record& record,
                                     const Eigen::VectorXd& quiet_noise = {});

}  // namespace beamid::experiments
