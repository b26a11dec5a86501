#include "experiments/identify/verdict/run_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/record/units.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

const Channel& channel_of(const Record& record, Index place) {
  return record.channels[static_cast<std::size_t>(place)];
}

// Whose clock it is, and beside which: "acceleration_x1m" and "the rest".
std::pair<std::string, std::string> clocks_of(const Record& record, const LikeliestClock& found) {
  const auto outputs = output_channels(record), inputs = input_channels(record);
  if (found.output)
    return {channel_of(record, outputs[static_cast<std::size_t>(*found.output)]).name, "the rest"};
  return {outputs.size() == 1 ? channel_of(record, outputs[0]).name : "All motion",
          inputs.size() > 1 ? "the inputs" : channel_of(record, inputs[0]).name};
}

// "acceleration_x1m is 2.50 +- 0.04 ms behind the rest"
std::string lag_text(const Record& record, const LikeliestClock& found, double deviation) {
  const auto [who, to] = clocks_of(record, found);
  return fmt::format("{} is {:.3g} +- {:.2g} ms {} {}", who, 1e3 * std::abs(found.lag()),
                     1e3 * quantile_95 * deviation, found.lag() > 0.0 ? "behind" : "ahead of", to);
}

// "acceleration_x1m falls behind the rest by 98 +- 5 ppm"
std::string growth_text(const Record& record, const LikeliestClock& found, double deviation) {
  const auto [who, to] = clocks_of(record, found);
  return fmt::format("{} {} {} by {:.3g} +- {:.2g} ppm of the time", who,
                     found.growth() > 0.0 ? "falls behind" : "runs ahead of", to,
                     1e6 * std::abs(found.growth()), 1e6 * quantile_95 * deviation);
}

// What a user may do about it.
std::string advice(const Record& record, const LikeliestClock& found, double deviation) {
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
  std::string name = "input_clock";  ///< of the objection
  std::string text, advice;
  Index unknown = 0;
  double moved = 0.0;      ///< in deviations as they are reported
  VectorXd moves = {};     ///< of all unknowns, in deviations of their state (q); empty: not known
  double explained = 0.0;  ///< of the squares that are left
  double surely = 0.0;     ///< its size in its own standard deviations
  bool is_sure = true;     ///< neither chance nor of the size of what an interpolation does
};

constexpr double sure_deviations = 4.5,
                 likely = 3.3;     // deviations: by chance in one of 10^5 records, of 1000
constexpr double small = 0.5;      // phase [rad]
constexpr double material = 0.01;  // of an interval
constexpr double clearly = 0.5 * sure_deviations * sure_deviations;  // of a logarithm of likelihood
constexpr double mostly = 0.5;  // of the squares left: they are no noise then, and deviations are none

// What a clock would do. @param lag the largest within the record [s]
InputFault clock_fault(const RunContext& context, const ComparedRun& run, const LikeliestClock& found,
                       double lag) {
  InputFault fault;
  fault.moves = found.step.shift;
  fault.moved = fault.moves.cwiseAbs().maxCoeff(&fault.unknown) / run.interval_factor;
  fault.explained = 1.0 - found.step.left_share;
  fault.is_sure = std::abs(lag) > material * context.analysis.record.interval();
  return fault;
}

std::optional<InputFault> of_rates(const RunContext& context, const ComparedRun& run) {
  const Record& record = context.analysis.record;
  if (!run.likeliest_clocks.drifting) return {};
  const LikeliestClock& found = *run.likeliest_clocks.drifting;
  const double deviation = run.interval_factor * found.growth_deviation(),
               most = std::max(std::abs(found.lag()),
                               std::abs(found.lag() + found.growth() * record.interval() *
                                                          static_cast<double>(record.size() - 1)));
  if (!(std::abs(found.growth()) > likely * deviation) || !(phase_of(run, most, record.interval()) < small))
    return {};
  InputFault fault = clock_fault(context, run, found, most);
  // Of one hit a rate is next to a stiffness, and a gain or a mass that is wrong looks like it.
  constexpr double apart = 3.0;
  fault.is_sure = fault.is_sure && std::abs(found.growth()) > sure_deviations * deviation &&
                  found.step.widening.maxCoeff() < apart;
  if (!fault.is_sure) fault.explained = 0.0;
  fault.surely = std::abs(found.growth()) / deviation;
  fault.text = growth_text(record, found, deviation);
  fault.advice = "Expected channels that one clock stamps, or one of them alone (channels in [record]).";
  return fault;
}

std::optional<InputFault> of_lags(const RunContext& context, const ComparedRun& run) {
  if (!run.likeliest_clocks.late) return {};
  const Record& record = context.analysis.record;
  const LikeliestClock& found = *run.likeliest_clocks.late;
  const double deviation = run.interval_factor * found.lag_deviation();
  if (!(std::abs(found.lag()) > sure_deviations * deviation) ||
      !(phase_of(run, found.lag(), record.interval()) < small))
    return {};
  InputFault fault = clock_fault(context, run, found, found.lag());
  fault.surely = std::abs(found.lag()) / deviation;
  fault.text = lag_text(record, found, deviation);
  fault.advice = advice(record, found, deviation);
  return fault;
}

// "0.0031 m/s2 of noise in base_acceleration", and what states it: "base_acceleration_m_per_s2 = 0.0031".
std::pair<std::string, std::string> noise_texts(const Record& record, const VectorXd& noise) {
  const auto inputs = input_channels(record);
  std::string text, stated;
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const Channel& channel = channel_of(record, inputs[j]);
    const double deviation = noise[static_cast<Index>(j)];
    text += fmt::format("{}{:.2g} {} of noise in {}", j > 0 ? ", " : "", deviation, si_unit(channel.quantity),
                        channel.name);
    stated += fmt::format("{}{} = {:.2g}", j > 0 ? ", " : "", quantity_key(channel.quantity), deviation);
  }
  return {text, stated};
}

bool is_likelier_with_noise(const ComparedRun& run) {
  return run.likeliest_input_noise && run.likeliest_input_noise->gain > clearly;
}

std::optional<InputFault> of_noise(const RunContext& context, const ComparedRun& run) {
  if (!is_likelier_with_noise(run)) return {};
  InputFault fault;
  fault.name = "input_noise";
  const auto [text, stated] = noise_texts(context.analysis.record, run.likeliest_input_noise->deviation);
  fault.text = "The residual looks like " + text;
  fault.advice = "State it: [noise] " + stated + ".";
  fault.moves = run.likeliest_input_noise->moved;
  if (fault.moves.size() > 0)
    fault.moved = fault.moves.cwiseAbs().maxCoeff(&fault.unknown) / run.interval_factor;
  return fault;
}

// Noise that the record shows and the estimates allow for.
void name_input_noise(const RunContext& context, ComparedRun& run) {
  const auto [text, stated] = noise_texts(context.analysis.record, run.settings.input_noise);
  const double gain = run.likeliest_input_noise->gain;
  run.objections.emplace_back(
      "input_noise",
      fmt::format("The record shows {} (log-likelihood {:+.3g}): estimates and intervals allow for it. A "
                  "noise that is known is stated: [noise] {}.",
                  text, gain, stated),
      gain, clearly);
}

}  // namespace

bool shows_input_noise(const RunContext& context, const ComparedRun& run) {
  if (run.parameters.empty() || !is_likelier_with_noise(run)) return false;
  if (run.likeliest_input_noise->outputs.size() == 0) return false;
  if (run.status == ComparedRun::Status::converged) return true;
  const double gain = run.likeliest_input_noise->gain;
  for (const auto& clock : {of_rates(context, run), of_lags(context, run)})
    if (clock && (clock->explained > mostly || !(0.5 * clock->surely * clock->surely < gain))) return false;
  return std::ranges::all_of(run.description.faults,
                             [&](const DescriptionFault& one) { return one.gain < gain; });
}

void judge_inputs(const RunContext& context, ComparedRun& run) {
  if (run.parameters.empty()) return;
  if (has_noise(run.settings.input_noise)) {
    if (run.likeliest_input_noise) name_input_noise(context, run);
    return;
  }
  const std::optional<InputFault> rate = of_rates(context, run);
  std::optional<InputFault> fault = rate && rate->is_sure ? rate : of_lags(context, run);
  if (!fault) fault = of_noise(context, run);
  if (!fault) fault = rate;
  if (!fault) return;
  // What a model lacks looks like a clock or an input's noise; the cause of most of it is one all the same.
  const bool approximate = run.status == ComparedRun::Status::approximate;
  constexpr double highly_significant = 10.0, material_move = 1.0;  // deviations
  const bool moves =
      fault->moved > quantile_95 || (fault->moved > material_move && fault->surely > highly_significant);
  const bool is_immaterial =
      has_small_residual(run) && (fault->moves.size() == 0 || !farthest_move(run, fault->moves).is_material);
  const bool excluded =
      !is_immaterial && ((moves && fault->is_sure && !approximate) || fault->explained > mostly);
  // Noise of an input is named where the intervals hold it, too: stated, it makes them narrower. So is a
  // clock that differs by ten of its deviations and makes a tenth of the residual.
  constexpr double good_part = 0.1;
  const bool worth_stating = fault->moved > 1.0 || fault->name == "input_noise" ||
                             (fault->surely > highly_significant && fault->explained > good_part);
  if (!excluded && (approximate || !worth_stating)) return;
  // Noise of an input may be there, or may be what the model lacks.
  if ((fault->name == "input_noise" || is_immaterial) && fault->moved > 1.0 && !excluded) {
    hold_moved(run, fault->moves);
    fault->advice += " Intervals are widened to hold the estimates with it.";
  }
  const std::string explained =
      fault->explained > mostly
          ? fmt::format(" and explains {:.0f} % of the residual, in squares", 100.0 * fault->explained)
          : "";
  const bool said = run.status == ComparedRun::Status::contradicted;  // by all that is left
  run.objections.insert(run.objections.begin() + (said ? 1 : 0),
                        {fault->name,
                         fmt::format("{}{}. Allowing for it moves {} by {:.2g} standard deviations{}. {} A "
                                     "model error can look the same.",
                                     excluded && !said ? "CONTRADICTED: " : "", fault->text,
                                     run.parameters[static_cast<std::size_t>(fault->unknown)].estimate.name,
                                     fault->moved, explained, fault->advice),
                         fault->moved, quantile_95});
  if (!excluded || said) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = fault->text;
}

std::string clock_scatter_text(const Record& record, const ClockScatter& scatter) {
  std::vector<std::string> names;
  for (const Index i : output_channels(record)) names.push_back(channel_of(record, i).name);
  return "CONTRADICTED: " + scatter.sentence(names) +
         " No estimate holds for all of them: expected channels that one clock stamps, or one of them alone "
         "(channels in [record]).";
}

void judge_clock_scatter(const RunContext& context, ComparedRun& run) {
  if (!run.clock_scatter || !run.has_estimate()) return;
  run.object({"channel_clocks", clock_scatter_text(context.analysis.record, *run.clock_scatter)});
  if (!run.answers()) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = "the channels do not ring at one frequency";
}

}  // namespace beamid::experiments
