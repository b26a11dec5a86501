// A record identified as its experiment file says: `beamid identify`.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/verdict/amplitude_sections.hpp"
#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/text/objection.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

// Whether the result of an identification may be relied on, and what speaks against it.

struct RecordIdentification;

/// The verdict on an identification, with its reasons.
struct Judgement {
  ComparedRun::Status verdict = ComparedRun::Status::converged;
  std::vector<Objection> objections;  ///< for the first lines of a report, the worst first; empty: none
  /// By which deviations grow until the intervals hold those of a modal analysis that disagrees; 1: it
  /// agrees.
  double frequency_factor = 1, damping_factor = 1;

  void object(Objection worse) { objections.insert(objections.begin(), std::move(worse)); }
};

/// The verdict and, where the filter diverged or its intervals and those of the modal analysis exclude each
/// other, a message with the cause that a test supports, the first of:
///
/// - the discretisation: its closed form makes of the modal analysis' K and C what the filter found;
/// - the prior, where what it states excludes the modal analysis by more than three of its deviations;
/// - a stated noise that is less than a tenth of what the record has near the mode;
/// - two close modes in the place of one;
/// - another mode beside this one, which the modal analysis fitted along;
/// - damping and frequency that vary with amplitude (amplitude_sections.hpp);
/// - noise that is larger where the amplitude is: rattle, or modes that die out;
/// - the modal analysis, where its modes leave more of the record than the filter's does: it then contradicts
///   nothing.
///
/// Where the filter could not be checked, as there is no modal analysis, and where it leaves most of the
/// record, a message says that.
Judgement judge(const Experiment& experiment, const Record& record, const RecordIdentification& found);

/// What a free decay shows of one degree of freedom, before it is put into words.
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
  bool two_modes = false;      ///< where one is fitted (close_pair.hpp)
  IdentificationSettings settings;  ///< of the last pass
  Identification identification;
  int passes = 3;
  std::optional<filters::InnovationConsistency> consistency;  ///< absent when the filter failed early
  std::optional<filters::Diagnostics> diagnostics;            ///< absent below 100 samples
  std::vector<std::string> remarks;                           ///< on the passes, for reports
  Judgement judgement;
  std::vector<filters::Gaussian> smoothed;   ///< of every sample, where a smoother was asked for
  Eigen::MatrixXd reproduced;                ///< (p x N): free decay with the identified K and C
  std::optional<BatchIdentification> batch;  ///< where it was asked for

  /// What deviations of frequency and K, of damping ratio and C, are multiplied by: what holds the
  /// values of 95 % of the decay, constant or not as the record has it (section_half_width), and what a modal
  /// analysis found that disagrees; 1 at least.
  double frequency_factor() const;
  double damping_factor() const;
  /// Deviation of the noise at the mode over that assumed; 1 where R counts.
  double noise_ratio() const;
  /// 100 ||y - reproduced|| / ||y|| over the samples that were measured; NaN where nothing was reproduced.
  double response_error_percent(const Record& record) const;
};

/// K and C of a free decay: a run of model sdof, judged beside the modal analysis.
/// @param run that the filter was not refused
RecordIdentification oscillator_of(const Experiment& experiment, const RecordAnalysis& analysis,
                                   const ComparedRun& run);

/// Identified by the one engine (compare()), with the experiment's own filter. Samples that are NaN were not
/// measured.
/// @throws InputError at the model's or filter's place in the experiment file; std::invalid_argument when the
/// record shows no mode near the beam's, or the noise cannot be had as the experiment says.
/// @param quiet_noise of the channels (p), by noise_before_event(); needed where the experiment wants it.
RecordIdentification identify_record(const Experiment& experiment, const Record& record,
                                     const Eigen::VectorXd& quiet_noise = {});

}  // namespace beamid::experiments
