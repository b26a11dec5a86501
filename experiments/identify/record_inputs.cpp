#include "experiments/identify/record_inputs.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/identify/model_setting.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double unevenness = 0.01;  // of the mean interval

// Paths of the lower degree, with these inputs from the higher (m (d + 1) x N).
MatrixXd with_smooth_rows(const MatrixXd& low, const MatrixXd& smooth, Index inputs,
                          const std::vector<Index>& rows) {
  MatrixXd paths = MatrixXd::Zero(smooth.rows(), smooth.cols());
  paths.topRows(low.rows()) = low;
  for (const Index row : rows)
    for (Index j = row; j < smooth.rows(); j += inputs) paths.row(j) = smooth.row(j);
  return paths;
}

}  // namespace

const char* to_string(InputPath path) {
  switch (path) {
    case InputPath::band_limited:
      return "band_limited";
    case InputPath::linear:
      return "linear";
    case InputPath::held:
      return "held";
  }
  return "";
}

std::vector<Index> imposed_inputs(const Record& record) {
  const std::vector<Index> inputs = input_channels(record);
  std::vector<Index> imposed;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (is_imposed(record.channels[static_cast<std::size_t>(inputs[i])].quantity))
      imposed.push_back(static_cast<Index>(i));
  return imposed;
}

RecordInputs take_inputs(const MatrixXd& samples, std::optional<InputPath> stated, filters::Measurements& to,
                         const std::vector<Index>& imposed) {
  if (const Index missing = samples.size() - samples.array().isFinite().count(); missing > 0)
    throw std::invalid_argument(
        fmt::format("{} readings of measured inputs are missing or not finite; expected all of them, for the "
                    "motion depends on every one, or [record] missing_input = \"leave_out\" or \"zero\"",
                    missing));
  RecordInputs result{stated.value_or(InputPath::linear), stated.has_value(), to.size() - 1, 0};
  const bool held = stated == InputPath::held;
  to.inputs = held ? samples : filters::straight_path(samples).columns;
  const bool all_stated = stated && stated != InputPath::band_limited;
  if ((all_stated && imposed.empty()) || result.steps < 1) return result;
  const filters::InputPaths smooth =
      filters::band_limited_path(to.time, samples, unevenness * to.interval() + 2.0 * to.time_resolution);
  if (stated == InputPath::band_limited && smooth.band_limited == 0)
    throw std::invalid_argument(
        "input is 'band_limited', and no stamps are even; expected 'linear', or a record that is resampled "
        "first");
  if (stated != InputPath::band_limited && 2 * smooth.band_limited < result.steps) return result;
  if (all_stated) {
    to.inputs = with_smooth_rows(to.inputs, smooth.columns, samples.rows(), imposed);
    return result;
  }
  to.inputs = smooth.columns;
  result.path = InputPath::band_limited;
  result.straight = result.steps - smooth.band_limited;
  return result;
}

filters::InputPaths decimated_inputs(const filters::Measurements& from, Index inputs, int factor,
                                     const Eigen::VectorXd& time) {
  if (from.inputs.size() == 0 || inputs == 0) return {};
  const auto degree = static_cast<int>(from.inputs.rows() / inputs) - 1;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  return filters::input_path(degree, time, decimate_channels(from.inputs.topRows(inputs), factor),
                             unevenness * interval);
}

std::optional<RecordInputs> record_inputs(const Record& record) {
  const std::vector<Index> forces = input_channels(record);
  if (forces.empty()) return {};
  filters::Measurements unused;
  unused.time = record.time;
  if (record.time_resolution < 0.5 * record.interval()) unused.time_resolution = record.time_resolution;
  return take_inputs(record.samples(forces, Eigen::all), record.input_path, unused, imposed_inputs(record));
}

std::string words(const RecordInputs& inputs) {
  std::string how;
  switch (inputs.path) {
    case InputPath::band_limited:
      how = "band-limited between their samples, as an anti-aliased converter records them";
      break;
    case InputPath::linear:
      how = "straight between their samples";
      break;
    case InputPath::held:
      how = "held, each sample until the next, and so late by half an interval";
      break;
  }
  std::string gaps;
  if (inputs.straight > 0)
    gaps = fmt::format("; straight over {} of {} intervals, at uneven stamps", inputs.straight, inputs.steps);
  return fmt::format("Measured inputs are taken as {}{} (input = \"{}\"{}).", how, gaps,
                     to_string(inputs.path), inputs.stated ? "" : ", chosen by the stamps");
}

}  // namespace beamid::experiments
