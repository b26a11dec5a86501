#include "experiments/identify/compare/compared_run.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "experiments/identify/compare/passes.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/models/finest_discretisation.hpp"

namespace beamid::experiments {
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
        "the modes of a mesh far above the sampling rate do not follow forces that are held, and its "
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

}  // namespace beamid::experiments
