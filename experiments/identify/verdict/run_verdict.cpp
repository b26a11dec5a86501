#include "experiments/identify/verdict/run_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/measured_force.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// What the measured input makes of the structure as described, beside what the record shows.

// (p x N)
MatrixXd response_as_described(const JointModel& model, const filters::Measurements& record) {
  const Index p = record.outputs.rows();
  VectorXd start = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size())), output(p);
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    start[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  const auto discrete = finest(model, record.interval(), MatrixXd::Identity(p, p));
  MatrixXd response(p, record.size()), no_directions(start.size(), 0);
  filters::walk_samples(*discrete, record, record.size(), start, no_directions,
                        [&](Index step, const auto& x, const auto& input) {
                          discrete->output(x, input, output);
                          response.col(step) = output;
                        });
  return response;
}

/// From rest and at the guesses, y_d(t), with the gain rms(y_d) / rms(y) over all channels, each in units of
/// its own size. A description that is wrong by some per cent moves it by a factor of two at most under a
/// force of many frequencies; a unit by more.
/// @returns where a forced run has no estimate that makes the record: a sentence that names a gain beyond 4,
/// or a sign that is turned; else empty
std::string described_response_text(const RunContext& context, const ComparedRun& run) {
  constexpr double far = 4.0, alike = 0.5, near = 0.25;  // near: of a logarithm
  if (!context.analysis.forced() || !run.model) return {};
  try {
    const filters::Measurements record = measurements(context.analysis.record);
    const MatrixXd response = response_as_described(*run.model, record);
    if (!response.allFinite()) return {};
    double sizes = 0.0, product = 0.0;
    for (Index i = 0; i < response.rows(); ++i) {
      const auto read = record.outputs.row(i).array().isFinite();
      const Eigen::ArrayXd y = read.select(record.outputs.row(i).array(), 0.0).transpose(),
                           d = read.select(response.row(i).array(), 0.0).transpose();
      const double square = std::max(y.square().sum(), 1e-300);
      sizes += d.square().sum() / square;
      product += (y * d).sum() / square;
    }
    const double channels = static_cast<double>(response.rows()), gain = std::sqrt(sizes / channels);
    const bool turned = product < -alike * gain * channels;
    if (!(gain > 0.0) || (!turned && gain < far && far * gain > 1.0)) return {};
    return fmt::format(
        "The structure as described, moved by the measured input, moves {:.3g} times as much as the record "
        "shows{}{}. The unit, gain or sign of the input or of the motion is the likely cause: check "
        "[record].",
        gain, turned ? ", and against it" : "",
        usual_scale(gain, near, measures_force(context.analysis.record)));
  } catch (const std::exception&) {  // a guess that has no motion
    return {};
  }
}

// A model's lowest mode beside the modal analysis of the record.

constexpr double surely = 3.0;  // of both standard deviations together

// "the damping ratio 0.56 % (modal analysis 0.40 %, 12 standard deviations)", where it is many of them.
void add_difference(const char* what, double found, double deviation, double modal, double modal_deviation,
                    double shown, const char* unit, std::string& text) {
  const double apart = std::abs(found - modal) / std::hypot(deviation, modal_deviation);
  if (!(apart > surely)) return;
  text += fmt::format(
      "{}{} {:.5g} {} ({:+.3g} % from the {:.5g} {} of the modal analysis, {:.3g} standard "
      "deviations)",
      text.empty() ? "" : ", ", what, shown * found, unit, 100.0 * (found / modal - 1.0), shown * modal, unit,
      apart);
}

std::string difference_text(const ModalEstimate& modal, const ComparedRun& run) {
  std::string text;
  add_difference("frequency", run.mode->frequency_hz, run.mode->frequency_deviation_hz, modal.frequency_hz,
                 modal.frequency_standard_deviation_hz, 1.0, "Hz", text);
  add_difference("damping ratio", run.mode->damping_ratio, run.mode->damping_ratio_deviation,
                 modal.damping_ratio, modal.damping_ratio_standard_deviation, 100.0, "%", text);
  if (text.empty()) return {};
  return "The model and the modal analysis of the first channel DISAGREE: " + text +
         ". The modal analysis assumes no model: trust it, or give the model the modes that it lacks. "
         "Intervals are widened until they hold both.";
}

// As K and C of one degree of freedom are judged (record_identification.cpp): damping that is not the
// record's is no estimate.
bool has_another_damping(const ModalEstimate& modal, const ComparedRun& run) {
  constexpr double twice = 2.0;
  const FoundMode& mode = *run.mode;
  const double apart = std::abs(mode.damping_ratio - modal.damping_ratio) /
                       std::hypot(mode.damping_ratio_deviation, modal.damping_ratio_standard_deviation);
  return apart > surely && !(mode.damping_ratio < twice * modal.damping_ratio &&
                             twice * mode.damping_ratio > modal.damping_ratio);
}

// Deviations grow until the intervals of the mode hold those of the modal analysis, where these surely
// differ: those of all unknowns by the larger factor, as any of them may have made the difference.
void hold_modal_analysis(const ModalEstimate& modal, ComparedRun& run) {
  const auto factor = [](double found, double deviation, double other, double other_deviation) {
    if (!(deviation > 0.0) || !(std::abs(found - other) > surely * std::hypot(deviation, other_deviation)))
      return 1.0;
    return factor_to_hold(found, deviation, other, other_deviation);
  };
  FoundMode& mode = *run.mode;
  const double of_frequency = factor(mode.frequency_hz, mode.frequency_deviation_hz, modal.frequency_hz,
                                     modal.frequency_standard_deviation_hz),
               of_damping = factor(mode.damping_ratio, mode.damping_ratio_deviation, modal.damping_ratio,
                                   modal.damping_ratio_standard_deviation);
  mode.frequency_deviation_hz *= of_frequency, mode.damping_ratio_deviation *= of_damping;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) widen(run, j, std::max(of_frequency, of_damping));
}

/// A warning where frequency or damping ratio at the estimate and in the modal analysis of the first channel
/// differ by more than three of their standard deviations together. The run is contradicted where the damping
/// ratios differ by more than a factor of two besides: such damping is not the record's. Records driven by a
/// measured force have no modal analysis, and models that are not linear no mode.
void judge_against_modal_analysis(const RunContext& context, ComparedRun& run) {
  const auto& modal = context.analysis.modal;
  // A model that has the mode's companions does not have its frequency alone, and an aliased one has another.
  const bool one_mode =
      !context.analysis.aliased && (run.coordinates == 1 || (modal && modal->companions.empty()));
  if (!modal || !run.mode || !one_mode) return;
  const std::string text = difference_text(*modal, run);
  if (text.empty()) return;
  run.objections.emplace_back("modal_disagreement", text);
  const bool another_damping = has_another_damping(*modal, run);
  hold_modal_analysis(*modal, run);
  if (!another_damping) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = fmt::format("damping ratio {:.3g} %, where the modal analysis of the record has {:.3g} %",
                           100.0 * run.mode->damping_ratio, 100.0 * modal->damping_ratio);
}

// Passes that still move by many deviations have found nothing yet, whatever the record is. Where a model
// does not make the record the filter's own deviations are too small: a move within the reported ones is no
// contradiction.
void judge_settling(ComparedRun& run) {
  double least_widened = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < run.parameters.size(); ++j)
    if (const double formal = formal_deviation(run, j); !run.unknowns[j].nuisance && formal > 0.0)
      least_widened = std::min(least_widened, run.parameters[j].estimate.deviation / formal);
  const bool is_within = std::isfinite(least_widened) && run.last_move < settled_move * least_widened;
  if (!(run.last_move > unsettled_move) || is_within) return;
  const std::string moved =
      fmt::format("the last pass moved an unknown by {:.2g} standard deviations", run.last_move);
  const Objection objection{"not_settled",
                            "NOT SETTLED: " + moved +
                                ". The estimates are not to be relied on; expected more passes "
                                "([compare] passes) or nearer initial estimates.",
                            run.last_move, unsettled_move};
  if (run.answers())
    run.contradict("the passes have not settled: " + moved, objection);
  else
    run.object(objection);
}

void judge_decay(const RunContext& context, ComparedRun& run) {
  if (!run.mode) return;
  for (const DecayObjection& one : decay_objections(context.analysis, *run.mode, run.coordinates == 1)) {
    run.object(one.objection);
    if (!one.contradicts) continue;
    run.status = ComparedRun::Status::contradicted;
    run.reason = "the record is no free decay of one damping ratio";
  }
}

// What the base moves beyond the model's coordinates is in the record, too.
void judge_moved_mass(ComparedRun& run) {
  constexpr double enough = 0.95;
  if (run.model->moved_share >= enough) return;
  run.objections.emplace_back(
      "moved_mass",
      fmt::format("The {} coordinates of this model hold {:.3g} % of the mass that the base moves; the rest "
                  "is in the "
                  "record and not in the model. Expected more of them: [reduction] modes.",
                  run.coordinates, 100.0 * run.model->moved_share),
      run.model->moved_share, enough);
}

// A unit that is wrong, of a forced motion that nothing makes by its size.
void judge_size(const RunContext& context, ComparedRun& run) {
  if (const std::string text = described_response_text(context, run); !text.empty())
    run.objections.emplace_back("implausible_response", text);
}

// Collapsed particles, or a filter linearised elsewhere: the truth may lie many of its intervals away.
void judge_certainty(ComparedRun& run) {
  constexpr double far_surer = 0.5;
  std::string names;
  double least = 1.0;
  for (const ComparedParameter& p : run.parameters) {
    least = std::min(least, p.overconfidence);
    if (p.overconfidence < far_surer) names += (names.empty() ? "" : ", ") + p.estimate.name;
  }
  if (names.empty()) return;
  const std::string reason = "the standard deviation of " + names +
                             " is less than half of what the record allows (Cramer-Rao bound)";
  run.contradict(
      reason, {"overconfident",
               "CONTRADICTED: " + reason +
                   ". The filter is overconfident: the true value may lie far outside the interval. Expected "
                   "nearer initial estimates, more passes ([compare] passes), a reduction in place of the "
                   "mesh, or `identify` in place of `compare`, which uses all samples at once.",
               least, far_surer});
}

// Of the general model: its lowest mode beside the modal analysis, its innovations.
void judge_model(const RunContext& context, ComparedRun& run) {
  widen_intervals(context, run);
  if (const std::string text = reduction_error(context, run); !text.empty())
    run.object({"reduction_bias", text});
  if (const std::string text = step_error(context, run); !text.empty()) run.object({"step_bias", text});
  judge_certainty(run);
  judge_motion_left(context, run);  // what the model lacks goes before: it explains the certainty
  judge_settling(run);
  hold_scatter_of_lines(run);
  if (!judge_faults(run)) judge_inputs(context, run);
  judge_decay(context, run);
  judge_moved_mass(run);
  judge_what_is_said(run);
  if (run.answers())
    judge_description(context, run);
  else
    judge_size(context, run);
  judge_free_modes(run);
  judge_against_modal_analysis(context, run);
  judge_innovations(context, run);
}

// K and C of a free decay: with what is known of one mode and its amplitude.
void judge_oscillator(const RunContext& context, ComparedRun& run) {
  const auto found =
      std::make_shared<const RecordIdentification>(oscillator_of(context.experiment, context.analysis, run));
  run.objections = found->judgement.objections;
  run.near_mode = found->near_mode;
  run.interval_factor = found->interval_factor;
  if (found->interval_factor > 1.0) {
    run.noise_ratio = found->noise_ratio();
    run.noise_freedom = found->near_mode.freedom;
  }
  if (run.has_estimate()) run.status = found->judgement.verdict;
  run.oscillator = found;
  for (Eigen::MatrixXd* history : {&run.run.means, &run.run.deviations, &run.run.whitened_innovations})
    history->resize(0, 0);  // it holds them once more
  if (run.parameters.size() != 2) return;
  widen(run, 0, found->frequency_factor());
  widen(run, 1, found->damping_factor());
  if (!run.mode) return;
  run.mode->frequency_deviation_hz *= found->frequency_factor();
  run.mode->damping_ratio_deviation *= found->damping_factor();
}

// A unit that is wrong, of a free decay by its channels.
void judge_channels(const RunContext& context, ComparedRun& run) {
  const ChannelAmplitudes& channels = context.analysis.channels;
  if (!channels.text.empty()) run.objections.emplace_back("channel_amplitudes", channels.text);
  if (!channels.contradict || run.status != ComparedRun::Status::converged) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = channels.text;
}

}  // namespace

double factor_to_hold(double estimate, double deviation, double other, double other_deviation) {
  return (std::abs(estimate - other) / quantile_95 + other_deviation) / deviation;
}

Move farthest_move(const ComparedRun& run, const VectorXd& moved) {
  constexpr double material = 1e-3;  // of a value
  Move most;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const auto at = static_cast<Index>(j);
    const Unknown& unknown = run.unknowns[j];
    const Estimate& estimate = run.parameters[j].estimate;
    const double from = run.unknown_state.mean[at],
                 to = from + moved[at] * std::sqrt(run.unknown_state.covariance(at, at)),
                 change = std::abs(unknown.to_physical(to) - unknown.to_physical(from)),
                 deviations = change / estimate.deviation;
    if (deviations > most.deviations) most.deviations = deviations, most.unknown = j;
    most.is_material =
        most.is_material || (deviations > quantile_95 && change > material * std::abs(estimate.value));
  }
  return most;
}

void hold_moved(ComparedRun& run, const VectorXd& moved) {
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const double formal = formal_deviation(run, j),
                 factor = factor_to_hold(0.0, run.parameters[j].estimate.deviation,
                                         moved[static_cast<Index>(j)] * formal, formal);
    if (factor > 1.0) widen(run, j, factor);
  }
}

bool has_small_residual(const ComparedRun& run) {
  constexpr double next_to_nothing = 0.1;  // %
  return run.misfit_percent < next_to_nothing;
}

void judge_what_is_said(ComparedRun& run) {
  // Of the prior deviation: half of the information is the prior's.
  constexpr double next_to_nothing = 0.7;
  std::string text;
  double largest = 0.0;
  for (const ComparedParameter& p : run.parameters)
    if (const double share = p.estimate.deviation / p.estimate.prior_deviation;
        !p.estimate.nuisance && share > next_to_nothing)
      largest = std::max(largest, share),
      text += fmt::format("{}{} ({:.2g})", text.empty() ? "" : ", ", p.estimate.name, share);
  if (!text.empty())
    run.objections.emplace_back("not_determined",
                                "NOT DETERMINED: " + text +
                                    ": the record determines no more than was known beforehand; in brackets "
                                    "the standard deviation over the "
                                    "prior one.",
                                largest, next_to_nothing);
}

void judge_run(const RunContext& context, ComparedRun& run) {
  if (run.status == ComparedRun::Status::refused || context.compared.has_open_clocks()) return;
  if (run.noise.size() == 0) return;  // no pass has begun: there was no motion to filter about
  if (asks_free_oscillator(context.experiment, context.analysis.record))
    judge_oscillator(context, run);
  else if (run.answers())
    judge_model(context, run);
  else {
    run.object({"diverged", "DIVERGED: " + run.reason + ". There is no estimate to rely on."});
    judge_size(context, run);
  }
  if (run.oscillator) return;  // whose own verdict holds them
  judge_channels(context, run);
  judge_clock_scatter(context, run);
}

}  // namespace beamid::experiments
