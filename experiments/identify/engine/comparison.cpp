#include "experiments/identify/engine/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/config/readers.hpp"
#include "experiments/identify/clocks/aligned_clocks.hpp"
#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/following_motion.hpp"
#include "experiments/rig/logged_test.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/progress.hpp"
#include "filters/filter.hpp"

namespace beamid::experiments {

BatchIdentification identify_batch(const JointModel& model, const IdentificationSettings& settings,
                                   const Eigen::VectorXd& start, const Eigen::MatrixXd& directions,
                                   const filters::Measurements& measured) {
  const auto discrete = filters::discretise(model.motion, measured.interval(), settings.discretisation,
                                            {{}, settings.output_noise});
  BatchIdentification result;
  result.estimate = filters::estimate_batch(*discrete, start, directions, measured);
  const filters::BatchEstimate& estimate = result.estimate;
  if (estimate.covariance.size() == 0) return result;
  const filters::Gaussian found{estimate.state, directions * estimate.covariance * directions.transpose()};
  result.parameters = estimates(model, found);
  if (is_oscillator(model)) result.identification = identification_at(model, found);
  return result;
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The same filter with its covariance as a factor: a mesh has too many coordinates for another form, its
// modes are of sizes too different.
Choice by_factor(Choice filter) {
  if (filter.name != "ekf" && filter.name != "ukf") return filter;
  filter.name = "low_rank_" + filter.name;
  filter.options = filters::filter_registry().completed(filter.name, filter.options);
  return filter;
}

// The exact motion's nearest of the banded schemes.
std::string form_for_the_mesh(const std::string& discretisation) {
  return discretisation == "exponential" ? "pade" : discretisation;
}

// Schemes of linear motion alone give way to a fourth-order one.
std::string form_for_nonlinear(const std::string& discretisation) {
  return discretisation == "exponential" ? "runge_kutta_4" : discretisation;
}

ComparedRun refused(const std::string& reason, const Place& place) {
  ComparedRun run;
  run.refused_at = place;
  run.status = ComparedRun::Status::refused;
  run.reason = reason;
  return run;
}

/// One reduction, its model made once for all filters.
struct ReducedBeam {
  const Choice& reduction;
  const std::filesystem::path& folder;  ///< of the experiment's files
  std::optional<ModelSetting> setting = {};
  std::optional<JointModel> model = {};
  std::optional<StartedModel> started = {};  ///< once a filter begins without the modal analysis
  double mass = 0.0;                         ///< of one degree of freedom of the beam simulated [kg]
  std::string refusal = {};                  ///< why there is none
};

ReducedBeam reduced_beam(const RunContext& context, const Choice& reduction,
                         const std::filesystem::path& folder) {
  ReducedBeam made{reduction, folder};
  try {
    made.setting = model_setting(context.experiment, context.analysis.record, reduction, folder);
    const Choice& model = context.experiment.model;
    made.model = std::move(*model_registry().make(model.name, model.options, *made.setting));
    if (const auto& truth = context.compared.truth; truth && made.model->equivalent_mass > 0.0)
      made.mass = true_mass(*truth, context.analysis.record, reduction, folder);
  } catch (const std::invalid_argument& error) {
    made.refusal = error.what();
  }
  return made;
}

// The filter and the scheme that such a model can have.
void fit_to_model(const JointModel& model, RunSettings& settings) {
  const bool mesh = is_whole_mesh(model);
  if (mesh || dynamic_cast<const FollowingMotion*>(model.motion.get()))
    settings.filter = by_factor(settings.filter);
  if (mesh)
    settings.discretisation = form_for_the_mesh(settings.discretisation);
  else if (is_nonlinear(model))
    settings.discretisation = form_for_nonlinear(settings.discretisation);
}

// Noise stated so far below the record's would make of any start a certainty.
bool noise_is_stated_well(const RunContext& context) {
  constexpr double absurd = 1e-3;
  const RecordAnalysis& analysis = context.analysis;
  const KnownNoise known = known_noise(context.experiment, analysis, context.compared);
  return assumed_noise(known, analysis.mode_noise)[0] > absurd * analysis.near_mode->deviation;
}

const StartedModel& start_from_record(const RunContext& context, ReducedBeam& made) {
  const RecordAnalysis& analysis = context.analysis;
  if (!made.started) {
    const double frequency_hz = !made.setting->supports.empty()
                                    ? made.model->mode_frequencies[0] / (2.0 * std::numbers::pi)
                                : analysis.mode && !analysis.aliased ? analysis.mode->frequency_hz
                                                                     : analysis.beam_frequency_hz;
    made.started = started_model(*made.model, context.experiment.model, *made.setting,
                                 measurements(analysis.even.record), frequency_hz);
  }
  return *made.started;
}

// A filter of one mode starts from the modal analysis, unless this has separated two: the filter would follow
// the beat, and starts there only where it is lost otherwise.
ComparedRun run_from_best_start(const RunContext& context, ReducedBeam& made, const RunSettings& settings) {
  const RecordAnalysis& analysis = context.analysis;
  if (context.compared.has_open_clocks()) {
    const filters::Measurements measured = measurements(analysis.record);
    return run_once(context, *made.setting,
                    {*made.model, own_guess(*made.model, made.setting->observations, measured.outputs)},
                    settings);
  }
  std::optional<StartedModel> from_mode;
  if (analysis.modal && !analysis.aliased && context.experiment.parameters.empty() &&
      noise_is_stated_well(context))
    from_mode = started_from_mode(*made.model, context.experiment.prior, *analysis.modal,
                                  settings.discretisation, analysis.record.interval());
  if (from_mode && analysis.modal->companions.empty())
    return run_once(context, *made.setting, *from_mode, settings);
  ComparedRun run = run_once(context, *made.setting, start_from_record(context, made), settings);
  if (from_mode && run.status == ComparedRun::Status::diverged)
    run = run_once(context, *made.setting, *from_mode, settings);
  return run;
}

/// A driven record that the first guess does not make, where a channel is read wrongly: an end before passes
/// that come to none.
std::optional<ComparedRun> read_wrongly(const RunContext& context, ReducedBeam& made) {
  if (!context.analysis.forced() || context.compared.has_open_clocks() || made.model->motion_size() < 2 ||
      start_from_record(context, made).guess.by_lines)
    return {};
  context.progress("what may be read wrongly");
  filters::Gaussian known =
      known_about_start(*made.started, *made.setting, measurements(context.analysis.record).outputs);
  for (std::size_t j = 0; j < made.started->model.unknowns.size(); ++j)
    known.mean[static_cast<Index>(j)] =
        made.started->model.unknowns[j].to_state(made.started->model.unknowns[j].guess);
  const std::string text = wrong_reading(made.started->model, context.analysis.record, known);
  if (text.empty()) return {};
  ComparedRun run;
  run.status = ComparedRun::Status::diverged;
  run.reason = text;
  run.object({"description", "CONTRADICTED: " + text + ". There is no estimate."});
  return run;
}

ComparedRun identified_or_refused(const RunContext& context, ReducedBeam& made, const RunSettings& settings) {
  const Place& place = context.experiment.model.place;
  if (!made.refusal.empty()) return refused(made.refusal, place);
  try {
    if (settings.keep == filters::Keep::all_estimates && !settings.input_noise)
      if (auto run = read_wrongly(context, made)) return *std::move(run);
    return run_from_best_start(context, made, settings);
  } catch (const std::invalid_argument& error) {  // no start can be had of the record
    return refused(error.what(), place);
  }
}

// What of the description would explain what a driven model leaves.
void look_for_faults(const RunContext& context, const ReducedBeam& made, ComparedRun& run) {
  if (!context.analysis.forced() || !run.answers() || !made.started || !run.model ||
      !context.compared.clocks.empty())
    return;
  context.progress("what may be described wrongly");
  const filters::Gaussian known =
      known_about_start(*made.started, *made.setting, measurements(context.analysis.record).outputs);
  run.description =
      description_tests(context.experiment, context.analysis.record, made.reduction, made.folder, *run.model,
                        known, run.unknown_state.mean, run.settings.input_noise);
}

// Under its names, tested for what may be described wrongly where `identify` asks, and judged.
ComparedRun judged_run(const RunContext& context, ReducedBeam& made, const RunSettings& settings) {
  ComparedRun run = identified_or_refused(context, made, settings);
  run.reduction = to_text(made.reduction);
  run.filter = choice_text(settings.filter, filters::filter_registry().find(settings.filter.name).options);
  run.discretisation = settings.discretisation;
  if (settings.keep == filters::Keep::all_estimates) look_for_faults(context, made, run);
  judge_run(context, run);
  return run;
}

// With noise of its inputs, where the record shows it better than anything that is described wrongly, and
// what is left with it is noise, or has a cause: storeys that yield make a residual that noise of the base
// cannot.
void take_input_noise(const RunContext& context, ReducedBeam& made, RunSettings settings, ComparedRun& run) {
  if (!shows_input_noise(context, run)) return;
  settings.input_noise = run.likeliest_input_noise;
  ComparedRun with = judged_run(context, made, settings);
  const bool is_explained =
      leaves_noise(with) ||
      (run.status == ComparedRun::Status::converged &&
       std::ranges::any_of(with.objections, [](const Objection& one) { return one.name == "description"; }));
  if (with.has_estimate() && is_explained) run = std::move(with);
}

}  // namespace

const char* to_string(ComparedRun::Status status) {
  switch (status) {
    case ComparedRun::Status::converged:
      return "converged";
    case ComparedRun::Status::approximate:
      return "approximate";
    case ComparedRun::Status::contradicted:
      return "contradicted";
    case ComparedRun::Status::not_unique:
      return "not_unique";
    case ComparedRun::Status::diverged:
      return "diverged";
    case ComparedRun::Status::refused:
      return "refused";
  }
  return "";
}

MatrixXd covariance_of_parameters(const ComparedRun& run) {
  const Index q = run.unknown_state.mean.size();
  if (q == 0 || run.unknown_state.covariance.size() == 0) return {};
  VectorXd own(q), stated(q);
  for (Index j = 0; j < q; ++j) {
    const double slope = run.unknowns[static_cast<std::size_t>(j)].slope(run.unknown_state.mean[j]);
    own[j] = std::copysign(std::sqrt(run.unknown_state.covariance(j, j)), slope);
    stated[j] = run.parameters[static_cast<std::size_t>(j)].estimate.deviation;
  }
  const VectorXd turned = stated.cwiseQuotient(own);
  return turned.asDiagonal() * run.unknown_state.covariance * turned.asDiagonal();
}

std::optional<double> ComparedParameter::error_percent() const {
  if (!truth || *truth == 0.0 || !std::isfinite(*truth)) return {};
  return 100.0 * (estimate.value / *truth - 1.0);
}

std::optional<double> ComparedParameter::bound_ratio() const {
  if (!bound || !(*bound > 0.0)) return {};
  return estimate.deviation / *bound;
}

ComparedRecord simulated_record(const Experiment& truth, const std::filesystem::path& folder,
                                const Progress& progress) {
  const SimulatedTest test = logged_test(truth, folder, "simulated", progress);
  ComparedRecord compared;
  compared.record = test.record;
  compared.name = "simulated";
  compared.sensor_noise = VectorXd::Zero(static_cast<Index>(test.record.channels.size()));
  for (std::size_t i = 0; i < test.sensors.size(); ++i)
    compared.sensor_noise[static_cast<Index>(i)] = test.sensors[i].noise;
  compared.truth = truth;
  compared.notes = test.notes;
  for (const std::string& remark : compared.record.remarks) compared.notes.push_back(remark);
  return compared;
}

ComparedRecord measured_record(std::string name, const Record& record) {
  ComparedRecord compared;
  compared.name = std::move(name);
  compared.record = record;
  return compared;
}

Comparison compare(const Experiment& experiment, ComparedRecord record, const std::filesystem::path& folder,
                   const Progress& progress, filters::Keep keep) {
  if (!experiment.unknown_forces.empty())
    throw std::invalid_argument(
        "[[unknown_forces]] are followed by beamid identify (of one RECORD), sense and posterior, which find "
        "the structure's parameters beside them; expected none where forces are measured or the motion is "
        "free");
  if (!record.record.own_clock.empty())
    record = aligned_clocks(experiment, std::move(record), folder, progress);
  Comparison comparison{std::move(record), {}, {}};
  comparison.analysis = analyse(experiment, comparison.compared.record);
  const RecordAnalysis& analysis = comparison.analysis;
  comparison.compared.record = analysis.record;
  comparison.compared.notes.insert(comparison.compared.notes.end(), analysis.notes.begin(),
                                   analysis.notes.end());
  if (comparison.compared.truth && !analysis.even.remark.empty())
    comparison.compared.notes.push_back("For the modal analysis and first estimates: " +
                                        analysis.even.remark);
  comparison.objections = analysis.objections;
  const std::size_t runs =
      experiment.reductions.size() * experiment.filters.size() * experiment.discretisations.size();
  const RunContext context{experiment, comparison.compared, analysis, runs == 1 ? progress : unwatched};
  Countdown countdown(progress, runs, "runs");
  for (const Choice& reduction : experiment.reductions) {
    countdown.begin(to_text(reduction));
    ReducedBeam made = reduced_beam(context, reduction, folder);
    for (const Choice& filter : experiment.filters)
      for (const std::string& discretisation : experiment.discretisations) {
        RunSettings settings{filter, discretisation, experiment.passes, made.mass, keep};
        if (made.refusal.empty()) fit_to_model(*made.model, settings);
        countdown.begin(
            fmt::format("{}, {}, {}", to_text(reduction), settings.filter.name, settings.discretisation));
        ComparedRun run = judged_run(context, made, settings);
        countdown.count();
        take_input_noise(context, made, settings, run);
        comparison.runs.push_back(std::move(run));
      }
  }
  const bool any = std::any_of(comparison.runs.begin(), comparison.runs.end(), [](const ComparedRun& run) {
    return run.status != ComparedRun::Status::refused;
  });
  if (any) return comparison;
  if (comparison.runs.empty())
    throw std::invalid_argument("no run to compare; expected a reduction, a filter and a discretisation");
  const ComparedRun& first = comparison.runs.front();
  if (first.refused_at.file.empty()) throw std::invalid_argument(first.reason);
  throw InputError(first.refused_at, first.reason);
}

Comparison identify_with_model(Experiment experiment, ComparedRecord record,
                               const std::filesystem::path& folder, const Progress& progress) {
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {experiment.discretisation};
  return compare(experiment, std::move(record), folder, progress, filters::Keep::all_estimates);
}

ComparedRecord chosen_channels(ComparedRecord compared, const std::vector<std::string>& names) {
  const Record& all = compared.record;
  std::vector<std::string> known;
  for (const Channel& channel : all.channels)
    if (!is_input(channel.quantity)) known.push_back(channel.name);
  for (const std::string& name : names)
    if (const auto found = std::count(known.begin(), known.end(), name); found != 1)
      throw std::invalid_argument(fmt::format("{} channel of motion named '{}'; the record has {}",
                                              found == 0 ? "no" : "more than one", name,
                                              fmt::join(known, ", ")));
  std::vector<bool> kept;
  for (const Channel& channel : all.channels)
    kept.push_back(is_input(channel.quantity) ||
                   std::find(names.begin(), names.end(), channel.name) != names.end());
  return with_channels(std::move(compared), kept);
}

ComparedRecord with_channels(ComparedRecord compared, const std::vector<bool>& kept) {
  const std::vector<Channel> all = std::exchange(compared.record.channels, {});
  std::vector<Eigen::Index> rows, outputs;  // among channels, and among those of motion
  Eigen::Index output = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool measured = !is_input(all[i].quantity);
    if (kept[i]) {
      rows.push_back(static_cast<Eigen::Index>(i));
      compared.record.channels.push_back(all[i]);
      if (measured) outputs.push_back(output);
    }
    output += measured;
  }
  std::erase_if(compared.record.own_clock, [&](const std::string& name) {
    return std::ranges::find(compared.record.channels, name, &Channel::name) ==
           compared.record.channels.end();
  });
  compared.record.samples = compared.record.samples(rows, Eigen::all).eval();
  if (compared.sensor_noise.size() > 0) compared.sensor_noise = compared.sensor_noise(rows).eval();
  if (compared.quiet_noise.size() > 0) compared.quiet_noise = compared.quiet_noise(outputs).eval();
  return compared;
}

}  // namespace beamid::experiments
