#include "experiments/identify/engine/compared_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/engine/passes.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

KnownNoise known_noise(const Experiment& experiment, const RecordAnalysis& analysis,
                       const ComparedRecord& compared) {
  const std::vector<Index> channels = output_channels(analysis.record);
  const MatrixXd outputs = analysis.record.samples(channels, Eigen::all);
  KnownNoise known{VectorXd::Zero(outputs.rows()), smallest_relative_noise * root_mean_squares(outputs), {}};
  for (Index i = 0; i < outputs.rows(); ++i) {
    const Channel& channel = analysis.record.channels[static_cast<std::size_t>(channels[i])];
    const double stated = stated_noise(experiment, channel);
    known.is_stated.push_back(stated > 0.0);
    if (compared.quiet_noise.size() > 0)
      known.configured[i] =
          std::max(compared.quiet_noise[i], smallest_relative_noise * largest_measured(outputs.row(i)));
    if (known.is_stated.back()) known.configured[i] = stated;
    if (compared.sensor_noise.size() > 0)
      known.least[i] = std::max(known.least[i], compared.sensor_noise[channels[i]]);
  }
  return known;
}

double stated_noise(const Experiment& experiment, const Channel& channel) {
  if (channel.noise > 0.0) return channel.noise;
  const auto given = experiment.noise.find(channel.quantity);
  return given != experiment.noise.end() ? given->second : 0.0;
}

VectorXd input_noise(const Experiment& experiment, const Record& record) {
  const std::vector<Index> inputs = input_channels(record);
  VectorXd noise(static_cast<Index>(inputs.size()));
  for (Index i = 0; i < noise.size(); ++i)
    noise[i] = stated_noise(experiment, record.channels[static_cast<std::size_t>(inputs[i])]);
  return noise;
}

VectorXd assumed_noise(const KnownNoise& known, const VectorXd& left) {
  return (known.configured.array() > 0.0).select(known.configured, left.cwiseMax(known.least));
}

VectorXd noise_of_bound(const ComparedRecord& compared, const KnownNoise& known, const VectorXd& left,
                        const VectorXd& assumed) {
  constexpr double surely = 3.0;  // standard deviations of a root mean square
  if (compared.sensor_noise.size() == 0) return assumed;
  const double scatter = 1.0 / std::sqrt(2.0 * static_cast<double>(compared.record.size()));
  return (left.array() > (1.0 + surely * scatter) * known.least.array()).select(left, known.least);
}

MatrixXd unit_noise(const MatrixXd& outputs) {
  return root_mean_squares(outputs).cwiseMax(1e-150).cwiseAbs2().asDiagonal();
}

namespace {

using Status = ComparedRun::Status;

// What the discretisation alone does to the mode that the record shows or, of a run that diverged, to any of
// the model's.
std::string cause_in_step(const ComparedRun& run, const std::optional<FoundMode>& shown,
                          const std::string& scheme, double interval) {
  if (is_nonlinear(*run.model) || !shown) return {};
  const Eigen::VectorXd frequencies = run.model->mode_frequencies / (2.0 * std::numbers::pi);
  const Eigen::Index modes = run.status == Status::diverged ? frequencies.size() : 1;
  for (Eigen::Index i = 0; i < modes; ++i) {
    FoundMode mode = *shown;
    if (i > 0 || frequencies[0] * interval > 0.5) mode.frequency_hz = frequencies[i];
    if (const std::string cause = step_too_long(scheme, mode, interval); !cause.empty()) return cause;
  }
  return {};
}

bool would_not_follow_held_forces(const RunContext& context, const JointModel& model) {
  const auto inputs = record_inputs(context.analysis.record);
  return inputs && inputs->path == InputPath::held && is_whole_mesh(model);
}

}  // namespace

ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings) {
  Passes passes(context, setting, started, settings);
  ComparedRun& run = passes.run();
  if (context.compared.has_open_clocks()) {
    passes.follow_common_clock();
    return std::move(run);
  }
  const auto refuse = [&](const std::string& reason) {
    run.status = Status::refused;
    run.reason = reason;
    return std::move(run);
  };
  if (would_not_follow_held_forces(context, started.model))
    return refuse(
        "the modes of a mesh far above the sampling rate do not follow forces that are held. Its "
        "accelerations come out wrong; expected input = \"band_limited\" or \"linear\", or a reduction");
  // `identify` answers; a comparison shows what each filter does.
  const bool answers = settings.keep == filters::Keep::all_estimates;
  try {
    passes.begin();
    bool whole = passes.filter();
    if (!whole && answers)
      if (const auto nearer = passes.start_by_output_error())
        return run_once(context, setting, *nearer, settings);
    if (!whole && answers) whole = passes.take_all_lines();
    if (whole && context.experiment.noise_method.name == "likelihood")
      whole = passes.filter_with_likeliest_noise();
    if (whole) passes.fit_inputs_noise();
    if (whole && answers) passes.mend_by_output_error();
    if (whole) passes.finish();
    if (started.by_output_error)
      run.remarks.emplace_back(
          "From the initial estimates the filter loses its way; it starts from those of all samples at once "
          "(output error).");
  } catch (const std::invalid_argument& error) {  // a scheme or a filter that such a model cannot have
    run.refused_at = settings.filter.place;
    return refuse(error.what());
  } catch (const std::runtime_error& error) {
    run.status = Status::diverged;
    run.reason = error.what();
  }
  if (run.run.failure) {
    run.status = Status::diverged;
    run.reason = failure_text(*run.run.failure);
  }
  if (run.status == Status::converged) passes.judge_motion();
  run.step_cause =
      cause_in_step(run, context.analysis.mode, settings.discretisation, context.analysis.record.interval());
  return std::move(run);
}

namespace {

// Each is so of one healthy record in a thousand.
bool are_white(const filters::InnovationConsistency& c) {
  return c.whiteness_p_value >= 1e-3;
}
bool are_steady(const filters::InnovationConsistency& c) {
  constexpr double surely = 1.4;  // the band of the worst of ten windows, 2.8 deviations, goes to 3.9
  return c.windows.maxCoeff() - 1.0 <= surely * (c.window_upper_95 - 1.0) &&
         1.0 - c.windows.minCoeff() <= surely * (1.0 - c.window_lower_95);
}

// @param misfit_percent of the record, motion that is left; 0: not said
std::string innovations_text(const filters::InnovationConsistency& c, double misfit_percent) {
  const bool white = are_white(c), steady = are_steady(c);
  if (white && steady) return {};
  const char* const what = white    ? "white, but their size changes along the record"
                           : steady ? "stationary, but not white"
                                    : "neither white nor stationary";
  const std::string motion = misfit_percent > 0.0 ? fmt::format("{:.2g} % of the record is", misfit_percent)
                                                  : std::string("the record holds");
  const std::string size = steady ? fmt::format("mean normalised square {:.3g}", c.mean_normalised_square)
                                  : fmt::format("normalised squares of {:.3g} to {:.3g} along the record",
                                                c.windows.minCoeff(), c.windows.maxCoeff());
  return fmt::format(
      "The innovations are {} (Ljung-Box p = {:.2g}, {}): {} motion that the model does not{}, and the "
      "intervals are a lower limit of the uncertainty{}.",
      what, c.whiteness_p_value, size, motion, misfit_percent > 0.0 ? " make" : "",
      misfit_percent > 0.0 ? ": a wrong mass, place or gain moves estimates by more" : "");
}

}  // namespace

bool leaves_noise(const ComparedRun& run) {
  constexpr double surely_coloured = 1e-3, alike = 3.0;  // of windows: storeys that yield have 10 and more
  if (!run.likeliest_input_noise || !run.diagnostics || !run.diagnostics->consistency) return false;
  const filters::InnovationConsistency& found = *run.diagnostics->consistency;
  // The filter holds an input's noise over an interval, the lines approximate the ends of the record.
  const double white = std::max(found.whiteness_p_value, run.likeliest_input_noise->whiteness_p);
  return white > surely_coloured && found.windows.maxCoeff() < alike * found.windows.minCoeff();
}

// Noise of the inputs moves the structure, too, and what it moves is left beside their own response. It is
// the noise that was stated as long as the innovations are no larger than that makes them.
bool is_noise_of_inputs(const ComparedRun& run) {
  constexpr double much = 1.25;  // mean normalised square; a sample's delay at 5 % of noise 1.7, a place 100
  return has_noise(run.settings.input_noise) && run.diagnostics && run.diagnostics->consistency &&
         run.diagnostics->consistency->mean_normalised_square < much;
}

namespace {

// A sensor a storey off leaves 40, a mass off by half 20, no defect 0.4.
constexpr double too_much_driven = 10.0, too_much_free = 50.0;  // %

}  // namespace

// What a model without joints, rocking and a yielding base explains of a real structure; its sections show
// how far that moves the estimates.
bool is_approximate(const ComparedRun& run) {
  constexpr double most_left = 0.3;
  return run.sections && run.sections->is_long() && run.sections->left_share < most_left &&
         run.misfit_percent > too_much_driven;
}

// A measured input leaves the model no freedom but its parameters: what the best of them leave is no decay
// that started otherwise. Nor is it where storeys follow laws, which no mode beside them can stand in for. A
// free decay may hold modes that the model lacks, but not for the greater part.
void judge_motion_left(const RunContext& context, ComparedRun& run) {
  const bool forced = context.analysis.forced();
  const double too_much = forced || has_storey_laws(*run.model) ? too_much_driven : too_much_free;
  if (!(run.misfit_percent > too_much) || is_noise_of_inputs(run)) return;
  if (is_approximate(run)) {
    run.status = ComparedRun::Status::approximate;
    run.reason = fmt::format("the model explains {:.0f} % of the motion; the rest is not noise",
                             100.0 * (1.0 - run.sections->left_share));
    run.object({"unexplained",
                fmt::format("The model explains {:.0f} % of the motion; the rest is not noise. Intervals "
                            "include the scatter over the record. A wrong mass, position or gain causes "
                            "such a residual as well, and shifts estimates further.",
                            100.0 * (1.0 - run.sections->left_share)),
                run.misfit_percent, too_much});
    return;
  }
  std::string reason =
      fmt::format("{}: the residual is {:.3g} % of it, and is no noise. {}",
                  forced ? "the measured input does not make the record's motion of this model"
                         : "no start of this model makes the record's motion",
                  run.misfit_percent,
                  run.step_cause.empty()
                      ? fmt::format("The record may hold modes that the model lacks. A sensor's place, a "
                                    "sign, a unit or a clock may be wrong. An input may be missing, a mass "
                                    "or the damping may not be as described, or the {} on a wrong answer",
                                    forced ? "filter has settled" : "search has ended")
                      : run.step_cause);
  if (reason.ends_with('.')) reason.pop_back();
  run.contradict(reason, {"unexplained", "CONTRADICTED: " + reason + ".", run.misfit_percent, too_much});
}

bool judge_faults(ComparedRun& run) {
  constexpr double mostly = 0.5, surely = 5.0;
  constexpr double least = 0.05;  // below it truncated modes and a coarse mesh look like a mass or a gain
  constexpr std::size_t most_named = 3;
  const auto share = [](const DescriptionFault& fault) {
    return fmt::format("{} ({:.0f} % of the residual, in squares)", fault.sentence, 100.0 * fault.explained);
  };
  const auto moved_by = [&](const DescriptionFault& fault) -> VectorXd {
    return fault.moved.cwiseQuotient(run.unknown_state.covariance.diagonal().cwiseSqrt());
  };
  std::string named;
  std::size_t count = 0;
  constexpr double nearly_as_much = 2.0;  // of what the best leaves
  bool moves = false, is_material = false;
  for (const DescriptionFault& fault : run.description.faults)
    if (fault.explained > mostly && count < most_named &&
        1.0 - fault.explained <= nearly_as_much * (1.0 - run.description.faults.front().explained)) {
      named += (count++ == 0 ? "" : "; or ") + share(fault);
      const Move move = farthest_move(run, moved_by(fault));
      moves = moves || std::isinf(fault.score) || move.deviations > quantile_95;
      is_material = is_material || std::isinf(fault.score) || move.is_material;
    }
  constexpr double slight = 3.0;  // % of the motion
  const auto mention = [&](const std::string& what, double statistic, double limit, bool all = false) {
    run.objections.emplace_back(
        "description",
        fmt::format("One thing described otherwise explains {}the residual: ", all ? "" : "a part of ") +
            what + ". Allowed for, it moves no estimate out of its interval.",
        statistic, limit);
  };
  if (count > 0 && (moves ? !is_material && has_small_residual(run) : run.misfit_percent < slight)) {
    if (moves) hold_moved(run, moved_by(run.description.faults.front()));
    mention(named, run.description.faults.front().explained, mostly, true);
    return true;
  }
  std::string held;
  double held_score = 0.0,
         statistic = run.description.faults.empty() ? 0.0 : run.description.faults.front().explained,
         limit = mostly;
  if (count == 0 && run.status == ComparedRun::Status::converged)
    for (const DescriptionFault& fault : run.description.faults) {
      const Move move = farthest_move(run, moved_by(fault));
      if (!(fault.score > surely) || !(move.deviations > quantile_95)) continue;
      if (!(fault.explained > least) || (!move.is_material && has_small_residual(run))) {
        hold_moved(run, moved_by(fault));
        if (held.empty()) held = share(fault), held_score = fault.score;
        continue;
      }
      named = fmt::format("{}; allowed for, it moves {} by {:.2g} of its standard deviations", share(fault),
                          run.parameters[move.unknown].estimate.name, move.deviations);
      statistic = fault.score, limit = surely;
      break;
    }
  constexpr double highly_significant = 10.0, good_part = 0.1;  // deviations; of the residual, in squares
  if (named.empty() && !held.empty()) {
    mention(held + ". Intervals are widened to hold the estimates with it", held_score, surely);
    return false;
  }
  if (named.empty()) {
    if (run.status == ComparedRun::Status::converged && !run.description.faults.empty())
      if (const DescriptionFault& best = run.description.faults.front();
          best.score > highly_significant && best.explained > good_part)
        mention(share(best), best.score, highly_significant);
    return false;
  }
  run.contradict(named,
                 {"description",
                  "CONTRADICTED: one thing described otherwise explains the record better: " + named +
                      ". What the model lacks can look the same: girders that bend, a base that rocks, "
                      "springs that are not linear, friction.",
                  statistic, limit});
  return true;
}

void judge_innovations(const RunContext& context, ComparedRun& run) {
  if (!run.diagnostics || !run.diagnostics->consistency) return;
  if (run.status == ComparedRun::Status::approximate) return;  // which says as much
  const double left = context.analysis.forced() ? run.misfit_percent : 0.0;
  const std::string text = innovations_text(*run.diagnostics->consistency, left);
  if (!text.empty())
    run.objections.emplace_back("innovations", text, run.diagnostics->consistency->whiteness_p_value, 1e-3);
}

}  // namespace beamid::experiments
