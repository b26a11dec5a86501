#include "experiments/identify/compare/run_verdict.hpp"

#include <fmt/format.h>

#include <string>

#include "experiments/identify/compare/against_description.hpp"
#include "experiments/identify/compare/against_modal_analysis.hpp"
#include "experiments/identify/compare/described_response.hpp"
#include "experiments/identify/compare/input_faults.hpp"
#include "experiments/identify/compare/motion_left.hpp"
#include "experiments/identify/compare/reduction_error.hpp"
#include "experiments/identify/compare/step_error.hpp"
#include "experiments/identify/compare/widened_interval.hpp"
#include "experiments/identify/decay_objections.hpp"
#include "experiments/identify/record_identification.hpp"

namespace beamid::experiments {
namespace {

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

// Collapsed particles, or a filter linearised elsewhere: the truth may lie many of its intervals away.
void judge_certainty(ComparedRun& run) {
  constexpr double far_surer = 0.5;
  std::string names;
  for (const ComparedParameter& p : run.parameters)
    if (p.overconfidence < far_surer) names += (names.empty() ? "" : ", ") + p.estimate.name;
  if (names.empty()) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = "the filter is more than twice as sure of " + names + " as the record allows";
  run.warnings.insert(run.warnings.begin(),
                      "CONTRADICTED: " + run.reason +
                          ", so that the truth may lie many of its intervals away. Expected nearer initial "
                          "estimates, more passes ([compare] passes), a reduction in place of the mesh, or "
                          "`identify` in place of `compare`, which asks all samples at once.");
}

// Of the general model: its lowest mode beside the modal analysis, its innovations.
void judge_model(const RunContext& context, ComparedRun& run) {
  widen_intervals(context, run);
  if (const std::string text = reduction_error(context, run); !text.empty())
    run.warnings.insert(run.warnings.begin(), text);
  if (const std::string text = step_error(context, run); !text.empty())
    run.warnings.insert(run.warnings.begin(), text);
  judge_settling(run);
  judge_motion_left(context, run);
  if (!judge_faults(run)) judge_inputs(context, run);
  judge_decay(context, run);
  judge_moved_mass(run);
  judge_what_is_said(run);
  if (run.answers())
    judge_description(context, run);
  else
    judge_size(context, run);
  judge_against_modal_analysis(context, run);
  judge_certainty(run);
  judge_innovations(context, run);
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
  if (!channels.text.empty()) run.warnings.push_back(channels.text);
  if (!channels.contradict || run.status != ComparedRun::Status::converged) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = channels.text;
}

}  // namespace

void judge_what_is_said(ComparedRun& run) {
  // Of the prior deviation: half of the information is the prior's.
  constexpr double next_to_nothing = 0.7;
  std::string text;
  for (const ComparedParameter& p : run.parameters)
    if (const double share = p.estimate.deviation / p.estimate.prior_deviation;
        !p.estimate.nuisance && share > next_to_nothing)
      text += fmt::format("{}{} ({:.2g})", text.empty() ? "" : ", ", p.estimate.name, share);
  if (!text.empty())
    run.warnings.push_back("NOT DETERMINED: the record says next to nothing of " + text +
                           "; what is printed is the prior, in brackets the standard deviation "
                           "over the prior one.");
}

void judge_run(const RunContext& context, ComparedRun& run) {
  if (run.status == ComparedRun::Status::refused || context.compared.has_open_clocks()) return;
  if (run.noise.size() == 0) return;  // no pass has begun: there was no motion to filter about
  if (asks_free_oscillator(context.experiment, context.analysis.record))
    judge_oscillator(context, run);
  else if (run.answers())
    judge_model(context, run);
  else {
    run.warnings.insert(run.warnings.begin(),
                        "DIVERGED: " + run.reason + ". There is no estimate to rely on.");
    judge_size(context, run);
  }
  if (run.oscillator) return;  // whose own verdict holds them
  judge_channels(context, run);
  judge_clock_scatter(context, run);
}

}  // namespace beamid::experiments
