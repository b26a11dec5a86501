#include "experiments/identify/compare/run_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/against_description.hpp"
#include "experiments/identify/compare/described_response.hpp"
#include "experiments/identify/compare/reduction_error.hpp"
#include "experiments/identify/compare/widened_interval.hpp"
#include "experiments/identify/decay_objections.hpp"
#include "experiments/identify/noise_near_mode.hpp"
#include "experiments/identify/record_identification.hpp"
#include "experiments/models/finest_discretisation.hpp"

namespace beamid::experiments {
namespace {

// @param misfit_percent of the record, motion that is left; 0: not said
std::string innovations_text(const filters::InnovationConsistency& c, double misfit_percent) {
  // One healthy record in a thousand: the band of the worst of ten windows, 2.8 deviations, goes to 3.9.
  constexpr double surely_coloured = 1e-3, surely_unsteady = 1.4;
  const bool white = c.whiteness_p_value >= surely_coloured,
             steady = c.windows.maxCoeff() - 1.0 <= surely_unsteady * (c.window_upper_95 - 1.0) &&
                      1.0 - c.windows.minCoeff() <= surely_unsteady * (1.0 - c.window_lower_95);
  if (white && steady) return {};
  const char* const what = white    ? "white, but their size changes along the record"
                           : steady ? "of steady size, but not white"
                                    : "neither white nor of steady size";
  const std::string motion = misfit_percent > 0.0 ? fmt::format("{:.2g} % of the record is", misfit_percent)
                                                  : std::string("the record holds");
  return fmt::format(
      "The innovations are {} (Ljung-Box p = {:.2g}, mean normalised square {:.3g}): {} motion that the "
      "model does not{}, and the intervals are a lower limit of the uncertainty{}.",
      what, c.whiteness_p_value, c.mean_normalised_square, motion, misfit_percent > 0.0 ? " make" : "",
      misfit_percent > 0.0 ? ": a mass, a place or a gain believed wrongly moves estimates by more" : "");
}

// What counts for frequency and damping is the density of the noise at the mode, whatever R says of all of
// it.
std::vector<double> by_mode(const RunContext& context, ComparedRun& run) {
  const NoiseNearMode& near = *context.analysis.near_mode;
  const double density = near.deviation / run.noise[0], factor = near.student() * density;
  run.near_mode = near;
  if (factor > 1.0) {
    run.noise_ratio = density;
    run.noise_freedom = near.freedom;
    run.interval_factor = factor;
    run.remarks.push_back(fmt::format(
        "Near the mode the noise density, from {} spectral lines, is {:.3g} times that of white noise of the "
        "deviation assumed: intervals are widened by {:.3g}.",
        near.lines, density, factor));
  }
  return std::vector<double>(run.parameters.size(), run.interval_factor);
}

std::vector<double> by_influence(ComparedRun& run) {
  std::vector<double> factors(run.parameters.size(), 1.0);
  std::string widened;
  for (std::size_t j = 0; j < factors.size() && j < run.noise_in.size(); ++j) {
    const NoiseInEstimate& noise = run.noise_in[j];
    factors[j] = std::max(1.0, student_factor(noise.freedom) * noise.ratio);
    if (factors[j] > run.interval_factor) {
      run.interval_factor = factors[j];
      run.noise_ratio = std::max(noise.ratio, 1.0);
      run.noise_freedom = noise.freedom;
    }
    constexpr double worth_saying = 1.1;
    if (factors[j] > worth_saying)
      widened += fmt::format("{}{} by {:.3g}", widened.empty() ? "" : ", ", run.parameters[j].estimate.name,
                             factors[j]);
  }
  if (!widened.empty())
    run.remarks.push_back(
        "The record's noise is denser where these are determined than white noise of the deviation assumed: "
        "intervals are widened, " +
        widened + ".");
  return factors;
}

// A filter that is surer than record and prior allow has been linearised elsewhere, or has lost its spread:
// its deviation becomes the least there is.
double to_bound(ComparedParameter& p, double factor) {
  if (!p.bound) return factor;
  const double part = overconfidence(factor * p.estimate.deviation, *p.bound, p.estimate.prior_deviation);
  if (!(part > 0.0)) return factor;
  if (part < 1.0) p.overconfidence = part;
  return factor / part;
}

void widen(ComparedRun& run, std::size_t j, double factor) {
  factor = to_bound(run.parameters[j], factor);
  run.parameters[j].estimate.deviation *= factor;
  set_interval(run, j, factor);
}

// "the damping ratio 0.56 % (modal analysis 0.40 %, 12 standard deviations)", where it is many of them.
void add_difference(const char* what, double found, double deviation, double modal, double modal_deviation,
                    double shown, const char* unit, std::string& text) {
  constexpr double many = 3.0;
  const double apart = std::abs(found - modal) / std::hypot(deviation, modal_deviation);
  if (!(apart > many)) return;
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
         ". The modal analysis knows no model: trust it, or give the model the modes that it lacks.";
}

// As K and C of one degree of freedom are judged (judgement.cpp): damping that is not the record's is no
// estimate.
bool has_another_damping(const ModalEstimate& modal, const ComparedRun& run) {
  constexpr double twice = 2.0, many = 3.0;
  const FoundMode& mode = *run.mode;
  const double apart = std::abs(mode.damping_ratio - modal.damping_ratio) /
                       std::hypot(mode.damping_ratio_deviation, modal.damping_ratio_standard_deviation);
  return apart > many && !(mode.damping_ratio < twice * modal.damping_ratio &&
                           twice * mode.damping_ratio > modal.damping_ratio);
}

// A measured input leaves the model no freedom but its parameters: what the best of them leave is no decay
// that started otherwise. Nor is it where storeys follow laws, which no mode beside them can stand in for. A
// free decay may hold modes that the model lacks, but not for the greater part.
void judge_motion_left(const RunContext& context, ComparedRun& run) {
  // A sensor a storey off leaves 40, a mass off by half 20, no defect 0.4.
  constexpr double too_much_driven = 10.0, too_much_free = 50.0;
  const bool forced = context.analysis.forced();
  const double too_much = forced || has_storey_laws(*run.model) ? too_much_driven : too_much_free;
  if (!(run.misfit_percent > too_much)) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = fmt::format(
      "{}: {:.3g} % of it is left, and is no noise. {}",
      forced ? "the measured input does not make the record's motion of this model"
             : "no start of this model makes the record's motion",
      run.misfit_percent,
      run.step_cause.empty()
          ? fmt::format("The record holds modes that the model lacks, a sensor's place, a sign, a unit or a "
                        "clock is wrong, an input is missing, a mass or the damping is not as described, or "
                        "the {} on a wrong answer",
                        forced ? "filter has settled" : "search has ended")
          : run.step_cause);
  if (run.reason.ends_with('.')) run.reason.pop_back();
  run.warnings.insert(run.warnings.begin(), "CONTRADICTED: " + run.reason + ".");
}

// Passes that still move by many deviations have found nothing yet, whatever the record is.
void judge_settling(ComparedRun& run) {
  constexpr double many = 5.0;
  if (!(run.last_move > many)) return;
  const std::string moved =
      fmt::format("the last one moved an unknown by {:.2g} of its standard deviations", run.last_move);
  run.status = ComparedRun::Status::contradicted;
  run.reason = "the passes have not settled: " + moved;
  run.warnings.insert(run.warnings.begin(),
                      "NOT SETTLED: " + moved +
                          ". The estimates are not to be relied on; expected more passes "
                          "([compare] passes) or nearer initial estimates.");
}

void judge_decay(const RunContext& context, ComparedRun& run) {
  if (!run.mode) return;
  for (const DecayObjection& one : decay_objections(context.analysis, *run.mode)) {
    run.warnings.insert(run.warnings.begin(), one.text);
    if (!one.contradicts) continue;
    run.status = ComparedRun::Status::contradicted;
    run.reason = "the record is no free decay of one damping ratio";
  }
}

// What the base moves beyond the model's coordinates is in the record, too.
void judge_moved_mass(ComparedRun& run) {
  constexpr double enough = 0.95;
  if (run.model->moved_share >= enough) return;
  run.warnings.push_back(fmt::format(
      "The {} coordinates of this model hold {:.3g} % of the mass that the base moves; the rest is in the "
      "record and not in the model. Expected more of them: [reduction] modes.",
      run.coordinates, 100.0 * run.model->moved_share));
}

// A unit that is wrong, of a forced motion that nothing makes by its size.
void judge_size(const RunContext& context, ComparedRun& run) {
  if (const std::string text = described_response_text(context, run); !text.empty())
    run.warnings.push_back(text);
}

// Of the general model: its lowest mode beside the modal analysis, its innovations.
void judge_model(const RunContext& context, ComparedRun& run) {
  const auto& modal = context.analysis.modal;
  const std::vector<double> factors =
      run.noise_in.empty() && modal ? by_mode(context, run) : by_influence(run);
  for (std::size_t j = 0; j < factors.size(); ++j) widen(run, j, factors[j]);
  if (run.mode) {
    run.mode->damping_ratio_deviation *= run.interval_factor;
    run.mode->frequency_deviation_hz *= run.interval_factor;
  }
  if (const std::string text = reduction_error(context, run); !text.empty())
    run.warnings.insert(run.warnings.begin(), text);
  judge_settling(run);
  judge_motion_left(context, run);
  judge_decay(context, run);
  judge_moved_mass(run);
  judge_what_is_said(run);
  if (run.status == ComparedRun::Status::converged)
    judge_description(context, run);
  else
    judge_size(context, run);
  // A model that has the mode's companions does not have its frequency alone, and an aliased one has another.
  const bool one_mode =
      !context.analysis.aliased && (run.coordinates == 1 || (modal && modal->companions.empty()));
  if (modal && run.mode && one_mode)
    if (const std::string text = difference_text(*modal, run); !text.empty()) {
      run.warnings.push_back(text);
      if (has_another_damping(*modal, run)) {
        run.status = ComparedRun::Status::contradicted;
        run.reason =
            fmt::format("damping ratio {:.3g} %, where the modal analysis of the record has {:.3g} %",
                        100.0 * run.mode->damping_ratio, 100.0 * modal->damping_ratio);
      }
    }
  constexpr double far_surer = 0.5;
  if (std::any_of(run.parameters.begin(), run.parameters.end(),
                  [](const ComparedParameter& p) { return p.overconfidence < far_surer; }))
    run.warnings.emplace_back(
        "DO NOT RELY on these estimates: the filter is more than twice as sure of them as the record allows, "
        "so that they may lie many of its intervals away. Expected nearer initial estimates, more passes "
        "([compare] passes), a reduction in place of the mesh, or `identify` in place of `compare`, which "
        "asks all samples at once.");
  if (run.diagnostics && run.diagnostics->consistency)
    if (const std::string text = innovations_text(*run.diagnostics->consistency,
                                                  context.analysis.forced() ? run.misfit_percent : 0.0);
        !text.empty())
      run.warnings.push_back(text);
}

// K and C of a free decay: with what is known of one mode and its amplitude.
void judge_oscillator(const RunContext& context, ComparedRun& run) {
  const auto found =
      std::make_shared<const RecordIdentification>(oscillator_of(context.experiment, context.analysis, run));
  run.warnings = found->judgement.messages;
  run.near_mode = found->near_mode;
  run.interval_factor = found->interval_factor;
  if (found->interval_factor > 1.0) {
    run.noise_ratio = found->noise_ratio();
    run.noise_freedom = found->near_mode.freedom;
  }
  if (run.has_estimate()) run.status = found->judgement.verdict;
  run.oscillator = found;
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
  if (!channels.text.empty()) run.warnings.push_back(channels.text);
  if (!channels.contradict || run.status != ComparedRun::Status::converged) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = channels.text;
}

}  // namespace

void judge_what_is_said(ComparedRun& run) {
  // Of the deviation believed: half of the information is the belief's.
  constexpr double next_to_nothing = 0.7;
  std::string text;
  for (const ComparedParameter& p : run.parameters)
    if (const double share = p.estimate.deviation / p.estimate.prior_deviation;
        !p.estimate.nuisance && share > next_to_nothing)
      text += fmt::format("{}{} ({:.2g})", text.empty() ? "" : ", ", p.estimate.name, share);
  if (!text.empty())
    run.warnings.push_back("NOT DETERMINED: the record says next to nothing of " + text +
                           "; what is printed is what was believed beforehand, in brackets the deviation "
                           "over the one believed.");
}

void judge_run(const RunContext& context, ComparedRun& run) {
  if (run.status == ComparedRun::Status::refused || context.compared.has_open_clocks()) return;
  if (run.noise.size() == 0) return;  // no pass has begun: there was no motion to filter about
  if (asks_free_oscillator(context.experiment, context.analysis.record))
    judge_oscillator(context, run);
  else if (run.status == ComparedRun::Status::converged)
    judge_model(context, run);
  else {
    run.warnings.insert(run.warnings.begin(),
                        "DIVERGED: " + run.reason + ". There is no estimate to rely on.");
    judge_size(context, run);
  }
  if (!run.oscillator) judge_channels(context, run);
}

}  // namespace beamid::experiments
