#include "experiments/identify/compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/config/channel_places.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/identify/compare/compared_run.hpp"
#include "experiments/identify/compare/started_model.hpp"
#include "experiments/identify/compare/true_value.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/recorded_frequency.hpp"
#include "experiments/models/finest_discretisation.hpp"
#include "experiments/models/motion/following_motion.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/text/choice_text.hpp"
#include "experiments/text/countdown.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "filters/filter.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// The mode of the record's first channel near the beam's first one, whatever model looks at it. Nothing where
// a measured force moves the beam: the record is then no decay of its modes.
std::optional<ModalEstimate> modal_analysis(const Record& record, double beam_hz) {
  if (!force_channels(record).empty()) return {};
  try {
    ModalAnalysisSettings settings;
    settings.expected_frequency_hz = shown_at(beam_hz, 1.0 / record.interval());
    return dominant_mode(record.samples.row(output_channels(record)[0]), record.interval(), settings);
  } catch (const std::invalid_argument&) {
    return {};
  } catch (const std::runtime_error&) {  // its least squares do not converge
    return {};
  }
}

void refuse_dead_channels(const Record& record) {
  for (const Index i : output_channels(record)) {
    const Channel& channel = record.channels[static_cast<std::size_t>(i)];
    const double first = record.samples(i, 0);
    if ((record.samples.row(i).array() == first).all())
      throw std::invalid_argument(
          fmt::format("channel '{}' is dead: it shows {:g} {} throughout; expected motion, or other channels "
                      "(--channel, record.channels)",
                      channel.name, first, si_unit(channel.quantity)));
  }
}

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

ComparedRun refused(const std::string& reason) {
  ComparedRun run;
  run.status = ComparedRun::Status::refused;
  run.reason = reason;
  return run;
}

}  // namespace

const char* to_string(ComparedRun::Status status) {
  switch (status) {
    case ComparedRun::Status::converged:
      return "converged";
    case ComparedRun::Status::diverged:
      return "diverged";
    case ComparedRun::Status::refused:
      return "refused";
  }
  return "";
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
  const SimulatedTest test = simulate(truth, folder, 0, progress);
  ComparedRecord compared;
  compared.name = "simulated";
  compared.record = test.record;
  compared.sensor_noise = VectorXd::Zero(static_cast<Index>(test.record.channels.size()));
  for (std::size_t i = 0; i < test.sensors.size(); ++i)
    compared.sensor_noise[static_cast<Index>(i)] = test.sensors[i].noise;
  compared.truth = truth;
  compared.notes = test.notes;
  return compared;
}

ComparedRecord measured_record(std::string name, const Record& record) {
  AnalysableRecord even = analysable(record);
  if (!even.remark.empty()) even.record.remarks.push_back(even.remark);
  ComparedRecord compared;
  compared.name = std::move(name);
  compared.record = std::move(even.record);
  compared.filled = std::move(even.filled);
  return compared;
}

Comparison compare(const Experiment& experiment, ComparedRecord record, const std::filesystem::path& folder,
                   const Progress& progress) {
  Comparison comparison{std::move(record), {}};
  comparison.compared.record = with_places(std::move(comparison.compared.record), experiment);
  const Record& samples = comparison.compared.record;
  if (output_channels(samples).empty())
    throw std::invalid_argument("the record holds forces only; expected at least one channel of motion");
  refuse_dead_channels(samples);
  RunContext context{experiment, comparison.compared, {}};
  const double beam_frequency =
      fem::modes(fem::assemble(experiment.beam, experiment.elements), 1).frequency_hz()[0];
  const double rate = 1.0 / samples.interval();
  comparison.modal = modal_analysis(samples, beam_frequency);
  if (const auto& modal = comparison.modal) {
    context.modal = FoundMode{};
    context.modal->frequency_hz = modal->frequency_hz;
    context.modal->damping_ratio = modal->damping_ratio;
  } else {
    const filters::Measurements measured = measurements(samples);
    const RecordedFrequency recorded =
        recorded_frequency(measured.outputs.row(0).transpose(), measured.inputs, samples.interval(),
                           shown_at(beam_frequency, rate));
    if (recorded.value_hz) {
      context.modal = FoundMode{};
      context.modal->frequency_hz = *recorded.value_hz;
    } else {
      comparison.compared.notes.push_back(
          "The record's own frequency could not be had without a model (" + recorded.failure +
          "): the beam's takes its place as a first estimate, and runs are not checked against it.");
    }
  }
  const bool aliased = 2.0 * beam_frequency > rate;
  if (aliased)
    comparison.warnings.push_back(fmt::format(
        "ALIASED: the beam's first mode, at {:.5g} Hz, lies above half the sampling rate, {:.5g} Hz. The "
        "record "
        "shows it at {:.5g} Hz, as it would show any mode at a multiple of {:.5g} Hz plus or minus that: "
        "which of them it is only the initial estimates say.",
        beam_frequency, 0.5 * rate, shown_at(beam_frequency, rate), rate));
  Countdown countdown(
      progress, experiment.reductions.size() * experiment.filters.size() * experiment.discretisations.size(),
      "runs");
  for (const Choice& reduction : experiment.reductions) {
    std::optional<ModelSetting> setting;
    std::optional<StartedModel> started;
    double mass = 0.0;
    std::string refusal;
    countdown.begin(to_text(reduction));
    try {
      setting = model_setting(experiment, samples, reduction, folder);
      started = started_model(experiment.model, *setting, measurements(samples),
                              context.modal && !aliased ? context.modal->frequency_hz : beam_frequency);
      if (const auto& truth = comparison.compared.truth; truth && started->model.equivalent_mass > 0.0)
        mass = true_mass(*truth, samples, reduction, folder);
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
    for (const Choice& filter : experiment.filters)
      for (const std::string& discretisation : experiment.discretisations) {
        const JointModel* model = started ? &started->model : nullptr;
        const bool mesh = model && is_whole_mesh(*model);
        const bool follows = model && dynamic_cast<const FollowingMotion*>(model->motion.get());
        const Choice used = mesh || follows ? by_factor(filter) : filter;
        const std::string scheme = mesh                            ? form_for_the_mesh(discretisation)
                                   : model && is_nonlinear(*model) ? form_for_nonlinear(discretisation)
                                                                   : discretisation;
        countdown.begin(fmt::format("{}, {}, {}", to_text(reduction), used.name, scheme));
        comparison.runs.push_back(
            started ? run_once(context, *setting, *started, {used, scheme, experiment.passes, mass})
                    : refused(refusal));
        countdown.count();
        ComparedRun& run = comparison.runs.back();
        run.reduction = to_text(reduction);
        run.filter = choice_text(used, filters::filter_registry().find(used.name).options);
        run.discretisation = scheme;
      }
  }
  const bool any = std::any_of(comparison.runs.begin(), comparison.runs.end(), [](const ComparedRun& run) {
    return run.status != ComparedRun::Status::refused;
  });
  if (!any) throw std::invalid_argument(comparison.runs.front().reason);
  return comparison;
}

}  // namespace beamid::experiments
