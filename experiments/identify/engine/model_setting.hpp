// From an experiment and its record to what a model is made from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/record.hpp"
#include "filters/filter_run.hpp"
#include "filters/measurements.hpp"
#include "filters/step_input.hpp"

namespace beamid::experiments {

// What a record's measured forces do between its samples.

/// How inputs were taken to run.
struct RecordInputs {
  InputPath path = InputPath::linear;
  bool stated = false;        ///< as the experiment says; else by the record's stamps
  Eigen::Index steps = 0;     ///< from sample to sample
  Eigen::Index straight = 0;  ///< of a band-limited path: those at uneven stamps, which are straight
};

/// "band_limited", "linear", "held".
const char* to_string(InputPath path);

/// Takes the inputs' samples (m x N) into `to`, whose stamps are set: band-limited where at least half of the
/// stamps are even, else straight, unless the path is stated. Intervals count as even within 1 % of their
/// mean and what the stamps are printed to.
/// @param imposed rows that are motions of supports: band-limited as all motion of a structure is, whatever
/// is stated of the others
/// @throws std::invalid_argument when a band-limited path is stated and no stamps are even, or a reading is
/// not finite.
RecordInputs take_inputs(const Eigen::MatrixXd& samples, std::optional<InputPath> stated,
                         filters::Measurements& to, const std::vector<Eigen::Index>& imposed = {});

/// Which of a record's inputs are motions of supports.
std::vector<Eigen::Index> imposed_inputs(const Record& record);

/// The m inputs of a record low-passed and decimated (signal/decimation.hpp) to even stamps, on the same kind
/// of path; none without inputs.
filters::InputPaths decimated_inputs(const filters::Measurements& from, Eigen::Index inputs, int factor,
                                     const Eigen::VectorXd& time);

/// Of a record with forces; absent without.
std::optional<RecordInputs> record_inputs(const Record& record);

/// "Measured forces are taken as straight between their samples (input = "linear")."
std::string words(const RecordInputs& inputs);

// Noise from where it is alone, or from what the filter makes of the whole record.

/// Of every channel of motion, forces left out, 1.4826 times the median deviation from the median before its
/// first event, or before the first of any channel where that is earlier (find_onsets).
/// @param whole the record before any window.
/// @throws std::invalid_argument when no event is found or fewer than 32 samples lie before it.
Eigen::VectorXd noise_before_event(const Record& whole);

struct LikeliestNoise {
  Eigen::VectorXd deviation;           ///< of every output, stated ones as stated (p)
  Eigen::VectorXd relative_deviation;  ///< standard errors of it, relative; 0: stated (p)
};

/// Noise levels that maximise the filter's log-likelihood of the record, one for every quantity whose noise
/// the experiment does not state (filters/noise_estimation.hpp), from the unknowns that a run ended with.
/// @param last of that run
/// @throws std::invalid_argument when the filter cannot go through the record or every noise is stated.
LikeliestNoise likeliest_noise(const Experiment& experiment, const Record& record, const JointModel& model,
                               const IdentificationSettings& settings, const filters::Gaussian& last);

/// The beam as described, an output row where each channel of the record sits, an input where each force
/// acts.
///
/// A proper orthogonal decomposition learns from the record where its `response` is "record": from the
/// channels of the first one's quantity, which must be at different places for more than one shape.
/// @param reduction its place is blamed when the beam cannot be reduced this way.
/// @param folder in which the file of a given shape is looked for.
/// @throws InputError, std::invalid_argument as fem::assemble.
ModelSetting model_setting(const Experiment& experiment, const Record& record, const Choice& reduction,
                           const std::filesystem::path& folder = {});

/// The record as a filter takes it: forces and the acceleration of the base are inputs, which run between
/// their samples as the record says (model_setting.hpp), the rest outputs, in the record's order; stamps that
/// lie on a regular grid to within their printed precision count as regular.
filters::Measurements measurements(const Record& record);

/// Rows of the record that are outputs, or inputs.
std::vector<Eigen::Index> output_channels(const Record& record);
std::vector<Eigen::Index> input_channels(const Record& record);

}  // namespace beamid::experiments
