// From an experiment and its record to what a model is made from.
#pragma once

#include <filesystem>

#include "experiments/config/experiment.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {

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
/// their samples as the record says (record_inputs.hpp), the rest outputs, in the record's order; stamps that
/// lie on a regular grid to within their printed precision count as regular.
filters::Measurements measurements(const Record& record);

/// Rows of the record that are outputs, or inputs.
std::vector<Eigen::Index> output_channels(const Record& record);
std::vector<Eigen::Index> input_channels(const Record& record);

}  // namespace beamid::experiments
