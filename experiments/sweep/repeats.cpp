#include "experiments/sweep/repeats.hpp"

#include <cmath>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/choice.hpp"
#include "fem/modes.hpp"
#include "filters/batch.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::optional<filters::Quantity> lane_quantity(Quantity quantity) {
  if (quantity == Quantity::displacement) return filters::Quantity::displacement;
  if (quantity == Quantity::velocity) return filters::Quantity::velocity;
  if (quantity == Quantity::acceleration) return filters::Quantity::acceleration;
  return {};
}

// Of the sensors, never less than what keeps P0 / R within the digits of a number.
VectorXd simulated_noise(const Record& clean, const VectorXd& sensor_noise) {
  const VectorXd size =
      (clean.samples.rowwise().squaredNorm() / static_cast<double>(clean.size())).cwiseSqrt();
  return sensor_noise.head(size.size()).cwiseMax(smallest_relative_noise * size);
}

VectorXd assumed_noise(const Experiment& experiment, const Record& clean, VectorXd noise) {
  for (Index i = 0; i < noise.size(); ++i)
    if (const auto given = experiment.noise.find(clean.channels[static_cast<std::size_t>(i)].quantity);
        given != experiment.noise.end())
      noise[i] = given->second;
  return noise;
}

void require_simple(const SweepSource& source, const Experiment& experiment, const Experiment& truth) {
  if (source.record)
    throw std::invalid_argument(fmt::format("identifying once takes records that are simulated; found '{}'",
                                            source.record->string()));
  if (experiment.model.name != "sdof" || experiment.reductions.size() != 1)
    throw std::invalid_argument(
        fmt::format("identifying once takes model sdof and one reduction; found model {} and {} reductions",
                    experiment.model.name, experiment.reductions.size()));
  if (!truth.acquisition.perfect())
    throw std::invalid_argument(
        "identifying once takes records of perfect instruments, to which noise is added; found an "
        "[acquisition] or sensors that change the readings. identify = \"compare\" takes them");
}

}  // namespace

// What the records of one case have in common that differ by their noise alone.

struct Repeats::Common {
  Experiment experiment;
  Record clean;  ///< without noise
  std::string reduction;
  std::vector<Observation> observations;
  JointModel model, true_model;         ///< of the beam assumed, and of the one simulated
  bool one_place = true;                ///< all channels read the same displacement
  Eigen::VectorXd sensor_noise, noise;  ///< put into the records, and assumed by the filter (p)
  std::vector<std::optional<double>> truth, bound;
  double frequency_hz = 0.0;  ///< of the beam simulated

  /// A record, and what is assumed before it, in the memory of an earlier one.
  void make_trial(std::uint64_t seed, filters::LaneTrial& made) const;
  ComparedRun judged(const filters::Gaussian& last) const;
  /// By one filter and one discretisation, a run for every record.
  std::vector<ComparedRun> identify(const Choice& filter, const std::string& scheme,
                                    const std::vector<filters::LaneTrial>& trials) const;

 private:
  std::optional<filters::OscillatorTrials> lanes(const Choice& filter, const std::string& scheme) const;
  ComparedRun alone(const Choice& filter, const std::string& scheme, const filters::LaneTrial& trial) const;
};

void Repeats::Common::make_trial(std::uint64_t seed, filters::LaneTrial& made) const {
  made.outputs = clean.samples;
  const Index samples = clean.size();
  for (Index i = 0; i < made.outputs.rows(); ++i)
    if (sensor_noise[i] > 0.0)
      made.outputs.row(i) +=
          sensor_noise[i] * filters::normal_noise(samples, seed, static_cast<std::uint64_t>(i)).transpose();
  const double duration = clean.interval() * static_cast<double>(samples);
  made.initial = initial_estimate(
      model, start_directions(model, observations, start_scale(model, observations, made.outputs, duration)));
}

ComparedRun Repeats::Common::judged(const filters::Gaussian& last) const {
  ComparedRun run;
  const std::vector<Estimate> found = estimates(model, last);
  for (std::size_t j = 0; j < found.size(); ++j) run.parameters.push_back({found[j], truth[j], bound[j]});
  run.reason = divergence(identification_at(model, last), frequency_hz);
  if (!run.reason.empty()) run.status = ComparedRun::Status::diverged;
  return run;
}

std::optional<filters::OscillatorTrials> Repeats::Common::lanes(const Choice& filter,
                                                                const std::string& scheme) const {
  const auto& specs = filters::filter_registry().find(filter.name).options;
  if (choice_text(filter, specs) != "ekf" || (scheme != "exponential" && scheme != "forward_euler") ||
      !model.offsets.empty() || observations.size() > 3 || !one_place ||
      experiment.on_failure != filters::OnFailure::stop)
    return {};
  filters::OscillatorTrials kind{model.equivalent_mass,    clean.interval(), {}, {}, {},
                                 scheme == "forward_euler"};
  for (const Observation& one : observations) {
    const auto quantity = lane_quantity(one.quantity);
    if (!quantity) return {};
    kind.observed.push_back(*quantity);
  }
  kind.output_noise = noise.cwiseAbs2().asDiagonal();
  return kind;
}

ComparedRun Repeats::Common::alone(const Choice& filter, const std::string& scheme,
                                   const filters::LaneTrial& trial) const {
  const IdentificationSettings settings{filter.name,
                                        filter.options,
                                        scheme,
                                        trial.initial,
                                        filters::Start::at_first_sample,
                                        noise.cwiseAbs2().asDiagonal(),
                                        1,
                                        experiment.on_failure};
  ComparedRun run;
  try {
    const filters::FilterRun found = filter_record(model, {clean.time, trial.outputs, {}}, settings);
    if (!found.failure) return judged(found.last);
    run.status = ComparedRun::Status::diverged;
    run.reason = failure_text(*found.failure);
  } catch (const std::invalid_argument& error) {
    run.status = ComparedRun::Status::refused;
    run.reason = error.what();
  } catch (const std::runtime_error& error) {
    run.status = ComparedRun::Status::diverged;
    run.reason = error.what();
  }
  return run;
}

std::vector<ComparedRun> Repeats::Common::identify(const Choice& filter, const std::string& scheme,
                                                   const std::vector<filters::LaneTrial>& trials) const {
  std::vector<ComparedRun> runs;
  if (const auto kind = lanes(filter, scheme)) {
    for (const filters::TrialResult& found : filters::run_batch(*kind, trials)) {
      runs.emplace_back();
      if (!found.failed) {
        runs.back() = judged(found.last);
        continue;
      }
      runs.back().status = ComparedRun::Status::diverged;
      runs.back().reason = fmt::format("sample {}, {:.4f} s: the filter lost its positive covariances",
                                       *found.failed, clean.time[*found.failed]);
    }
  } else {
    for (const filters::LaneTrial& trial : trials) runs.push_back(alone(filter, scheme, trial));
  }
  for (ComparedRun& run : runs) {
    run.reduction = reduction;
    run.filter = choice_text(filter, filters::filter_registry().find(filter.name).options);
    run.discretisation = scheme;
  }
  return runs;
}

struct Repeats::Entry {
  std::once_flag once;
  std::shared_ptr<const Common> common;
  std::string trouble;  ///< where there is none
};

void require_once(const SweepSource& source, const SweepPlan& plan) {
  Experiment first, truth;
  try {
    first = experiment_of(source, plan, 0);
    truth = experiment_of(source, plan, 0, true);
  } catch (const InputError&) {  // the row of that case says so
    return;
  }
  require_simple(source, first, truth);
}

std::shared_ptr<const Repeats::Common> Repeats::common_of(std::size_t number) const {
  auto common = std::make_shared<Common>();
  const Experiment& experiment = common->experiment = experiment_of(source_, plan_, number);
  Experiment truth = experiment_of(source_, plan_, number, true);
  require_simple(source_, experiment, truth);
  common->sensor_noise = VectorXd::Zero(static_cast<Index>(std::max<std::size_t>(2, truth.sensors.size())));
  for (std::size_t i = 0; i < truth.sensors.size(); ++i)
    common->sensor_noise[static_cast<Index>(i)] = std::exchange(truth.sensors[i].noise, 0.0);
  const auto silent = [](const std::string&) {};
  const auto& folder_of_truth = (source_.truth ? *source_.truth : source_.config).file;
  common->clean = simulated_record(truth, folder_of_truth.parent_path(), silent).record;
  const std::filesystem::path folder = source_.config.file.parent_path();
  const Choice& reduction = experiment.reductions[0];
  const ModelSetting setting = model_setting(experiment, common->clean, reduction, folder);
  if (!setting.forces.empty())
    throw std::invalid_argument("identifying once takes free motion; found a measured force");
  common->observations = setting.observations;
  common->reduction = to_text(reduction);
  const auto made = [&](const ModelSetting& of) {
    return std::move(*model_registry().make(experiment.model.name, experiment.model.options, of));
  };
  common->model = made(setting);
  truth.parameters.clear();
  common->true_model = made(model_setting(truth, common->clean, reduction, folder));
  const MatrixXd rows = setting.system.outputs;
  common->one_place = (rows.rowwise() - rows.row(0)).isZero(0.0);
  common->noise =
      assumed_noise(experiment, common->clean, simulated_noise(common->clean, common->sensor_noise));
  common->frequency_hz = fem::lowest_frequency_hz(fem::assemble(truth.structure, truth.elements));
  for (const Unknown& unknown : common->model.unknowns)
    common->truth.push_back(true_value(truth, common->true_model.equivalent_mass, unknown));
  common->bound = bounds(*common);
  return common;
}

/// Cramer-Rao of the beam simulated: at its K and C and the motion nearest to the record's with them, its
/// start unknown, with the noise that its sensors have. None where they have none.
std::vector<std::optional<double>> Repeats::bounds(const Common& common) {
  const JointModel& model = common.true_model;
  std::vector<std::optional<double>> found(common.truth.size());
  if (common.sensor_noise.isZero(0.0)) return found;
  const VectorXd noise = simulated_noise(common.clean, common.sensor_noise);
  const filters::Measurements clean = measurements(common.clean);
  const StartDirections directions =
      start_directions(model, common.observations,
                       start_scale(model, common.observations, clean.outputs, clean.time[clean.size() - 1]));
  VectorXd state = initial_estimate(model, directions).mean;
  for (std::size_t j = 0; j < found.size(); ++j) {
    if (!common.truth[j] || !std::isfinite(*common.truth[j])) return found;
    state[model.unknown_places[j]] = model.unknowns[j].to_state(*common.truth[j]);
  }
  const auto discrete = finest(model, clean.interval(), noise.cwiseAbs2().asDiagonal());
  const VectorXd start = reproduce(*discrete, state, directions, clean).initial_state;
  const filters::InformationFactor information =
      filters::information_factor(*discrete, start, clean.size(), directions.all());
  const Index first = directions.motion.cols(), all = information.unknowns();
  const VectorXd least = filters::determined_combinations(information, VectorXd::Ones(all)).bounds;
  for (std::size_t j = 0; j < found.size(); ++j) {
    const Index place = model.unknown_places[j], column = static_cast<Index>(j);
    const double bound = least[first + column] * directions.unknowns(place, column);
    if (std::isfinite(bound)) found[j] = bound;  // K and C have the linear form
  }
  return found;
}

std::shared_ptr<Repeats::Entry> Repeats::entry_of(std::size_t sample) {
  constexpr std::size_t most =
      16;  // more than threads work on at a time; a record of 25,000 samples has 400 kB
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Entry>& entry = kept_[sample];
  if (!entry) entry = std::make_shared<Entry>();
  std::shared_ptr<Entry> found = entry;
  while (kept_.size() > most)
    kept_.erase(kept_.begin()->first == sample ? std::prev(kept_.end()) : kept_.begin());
  return found;
}

std::vector<SweepRow> Repeats::run(const CaseBlock& block) {
  const std::shared_ptr<Entry> entry = entry_of(plan_.sample_of(block.at(0)));
  std::call_once(entry->once, [&] {
    try {
      entry->common = common_of(block[0]);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      entry->trouble = error.what();
    }
  });
  std::vector<std::vector<ComparedRun>> runs(block.size());
  if (const std::shared_ptr<const Common>& common = entry->common) {
    thread_local std::vector<filters::LaneTrial> trials;  // megabytes, not to be asked for again and again
    trials.resize(block.size());
    for (std::size_t i = 0; i < block.size(); ++i) common->make_trial(plan_.seed_of(block[i]), trials[i]);
    for (const Choice& filter : common->experiment.filters)
      for (const std::string& scheme : common->experiment.discretisations) {
        std::vector<ComparedRun> found = common->identify(filter, scheme, trials);
        for (std::size_t i = 0; i < block.size(); ++i) runs[i].push_back(std::move(found[i]));
      }
  }
  std::vector<SweepRow> rows;
  for (std::size_t i = 0; i < block.size(); ++i)
    for (SweepRow& row : rows_of(plan_, block[i], runs[i], entry->trouble)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace beamid::experiments
