#include "experiments/identify/compare/input_faults.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "experiments/identify/model_setting.hpp"
#include "experiments/record/column_name.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

const Channel& channel_of(const Record& record, Index place) {
  return record.channels[static_cast<std::size_t>(place)];
}

// "acceleration_x1m is 2.50 +- 0.04 ms behind the rest"
std::string lag_text(const Record& record, const LikeliestLag& found, double deviation) {
  const auto outputs = output_channels(record), inputs = input_channels(record);
  std::string who = "All motion", to = inputs.size() > 1 ? "the inputs" : channel_of(record, inputs[0]).name;
  if (found.output) {
    who = channel_of(record, outputs[static_cast<std::size_t>(*found.output)]).name;
    to = "the rest";
  } else if (outputs.size() == 1) {
    who = channel_of(record, outputs[0]).name;
  }
  return fmt::format("{} is {:.3g} +- {:.2g} ms {} {}", who, 1e3 * std::abs(found.lag()),
                     1e3 * quantile_95 * deviation, found.lag() > 0.0 ? "behind" : "ahead of", to);
}

// What a user may do about it.
std::string advice(const Record& record, const LikeliestLag& found, double deviation) {
  constexpr double far = 4.0;
  const double half = 0.5 * record.interval();
  std::string text;
  if (!found.output && std::abs(std::abs(found.lag()) - half) < far * deviation)
    text = "It is half an interval: look at input in [record], how the input runs between its samples. ";
  const auto inputs = input_channels(record);
  if (!found.output && inputs.size() > 1)
    return text + "Expected [[record.prepare]] step = \"shift\" that takes it out.";
  const Index channel =
      found.output ? output_channels(record)[static_cast<std::size_t>(*found.output)] : inputs[0];
  return text + fmt::format("own_clock = [\"{}\"] in [record] finds the lag with the parameters.",
                            channel_of(record, channel).name);
}

// How far the lag turns the phase of the motion [rad]: a linear step holds for a fraction of one.
double phase_of(const ComparedRun& run, double lag, double interval) {
  const Eigen::MatrixXd& y = run.reproduced;
  const Index n = y.cols() - 1;
  return std::abs(lag) / interval * (y.rightCols(n) - y.leftCols(n)).norm() / y.norm();
}

// What speaks against the inputs, and how far it moves the unknown that it moves most.
struct InputFault {
  std::string text, advice;
  Index unknown = 0;
  double moved = 0.0;       ///< in deviations as they are reported
  double explained = 0.0;   ///< of the squares that are left
  bool is_material = true;  ///< and not of the size of what an interpolation does
};

std::optional<InputFault> of_clocks(const RunContext& context, const ComparedRun& run) {
  constexpr double surely = 4.5, small = 0.5;  // deviations: by chance in one of 10^5 records; rad
  constexpr double material = 0.01;            // of an interval
  if (!run.likeliest_lag) return {};
  const Record& record = context.analysis.record;
  const LikeliestLag& found = *run.likeliest_lag;
  const double deviation = run.interval_factor * found.deviation();
  if (!(std::abs(found.lag()) > surely * deviation) ||
      !(phase_of(run, found.lag(), record.interval()) < small))
    return {};
  InputFault fault{lag_text(record, found, deviation), advice(record, found, deviation)};
  fault.moved = found.step.shift.cwiseAbs().maxCoeff(&fault.unknown) / run.interval_factor;
  fault.explained = 1.0 - found.step.left_share;
  fault.is_material = std::abs(found.lag()) > material * record.interval();
  return fault;
}

std::optional<InputFault> of_noise(const RunContext& context, const ComparedRun& run) {
  constexpr double surely = 10.0;  // of a logarithm of likelihood: 4.5 deviations
  if (!run.likeliest_input_noise || !(run.likeliest_input_noise->gain > surely)) return {};
  const Record& record = context.analysis.record;
  const auto inputs = input_channels(record);
  InputFault fault;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const Channel& channel = channel_of(record, inputs[j]);
    const double noise = run.likeliest_input_noise->deviation[static_cast<Index>(j)];
    fault.text += fmt::format("{}{:.2g} {} of noise in {}", j > 0 ? ", " : "", noise,
                              si_unit(channel.quantity), channel.name);
    fault.advice += fmt::format("{}{} = {:.2g}", j > 0 ? ", " : "", quantity_key(channel.quantity), noise);
  }
  fault.text += " would leave motion as it is left here";
  fault.advice = "State it: [noise] " + fault.advice + ".";
  const VectorXd moved = run.likeliest_input_noise->moved;
  if (moved.size() > 0) fault.moved = moved.cwiseAbs().maxCoeff(&fault.unknown) / run.interval_factor;
  return fault;
}

}  // namespace

void judge_inputs(const RunContext& context, ComparedRun& run) {
  if (run.parameters.empty()) return;
  std::optional<InputFault> fault = of_clocks(context, run);
  if (!fault) fault = of_noise(context, run);
  constexpr double mostly = 0.5;  // what is left is no noise then, and the deviations are none
  if (!fault) return;
  const bool excluded = (fault->moved > quantile_95 && fault->is_material) || fault->explained > mostly;
  if (!excluded && !(fault->moved > 1.0)) return;
  const std::string explained =
      fault->explained > mostly
          ? fmt::format(" and makes {:.0f} % of what is left, in squares", 100.0 * fault->explained)
          : "";
  const bool said = run.status == ComparedRun::Status::contradicted;  // by all that is left
  run.warnings.insert(
      run.warnings.begin() + (said ? 1 : 0),
      fmt::format("{}{}, or the model lacks what looks so: allowed for, it moves {} by {:.2g} of its "
                  "deviations{}. {}",
                  excluded && !said ? "CONTRADICTED: " : "", fault->text,
                  run.parameters[static_cast<std::size_t>(fault->unknown)].estimate.name, fault->moved,
                  explained, fault->advice));
  if (!excluded || said) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = fault->text;
}

}  // namespace beamid::experiments
