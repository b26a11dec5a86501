#include "experiments/models/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/models/estimates.hpp"
#include "experiments/text/memory_need.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::experiments {
namespace {

// Standard deviation of a . [K, C] for the covariance of K and C.
double deviation(const Eigen::Matrix2d& covariance, double by_stiffness, double by_damping) {
  const Eigen::Vector2d slope(by_stiffness, by_damping);
  return std::sqrt(slope.dot(covariance * slope));
}

// What the next pass takes over: constants of the record. A bias that drifts is not one.
std::vector<Eigen::Index> kept_places(const JointModel& model) {
  std::vector<Eigen::Index> places;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (!model.unknowns[j].nuisance) places.push_back(model.unknown_places[j]);
  for (const JointModel::Offset& offset : model.offsets) {
    const bool drifts = std::any_of(model.offsets.begin(), model.offsets.end(), [&](const auto& other) {
      return other.drift && other.channel == offset.channel;
    });
    if (!drifts) places.push_back(offset.place);
  }
  return places;
}

/// Of filters that draw samples of the state.
void require_sample_memory(const IdentificationSettings& settings, Eigen::Index states) {
  constexpr double copies = 4;
  for (const char* drawn : {"particles", "members"})
    if (settings.filter_options.values().contains(drawn))
      require_memory(settings.filter_options.number(drawn), fmt::format("{} of {} states", drawn, states),
                     copies * sizeof(double) * static_cast<double>(states));
}

/// Of the estimates before and after each sample, where they are kept.
void require_estimate_memory(const filters::Gaussian& initial, double samples, filters::Keep keep) {
  if (keep != filters::Keep::all_estimates) return;
  const auto states = static_cast<double>(initial.mean.size());
  const auto columns = static_cast<double>(std::max(initial.factor.cols(), initial.covariance.cols()) + 1);
  require_memory(2.0 * samples,
                 fmt::format("estimates of {} states, of which compare keeps the last,", states),
                 columns * states * sizeof(double));
}

filters::FilterRun filter_passes(filters::Filter& filter, const JointModel& model,
                                 const filters::Measurements& record, const IdentificationSettings& settings,
                                 filters::Keep keep, const filters::Trace& trace,
                                 const filters::NoisyInputs* noisy) {
  filters::Gaussian initial = settings.initial;
  filters::FilterRun run;
  for (int pass = 1; pass <= settings.passes; ++pass) {
    const bool last = pass == settings.passes;
    run = filters::run(filter, noisy ? noisy->with_errors(initial) : initial, record,
                       {last ? keep : filters::Keep::last_estimate, settings.start,
                        last ? trace : filters::Trace{}, settings.on_failure});
    if (noisy) {
      run.last = noisy->without_errors(run.last);
      for (auto* estimates : {&run.predicted, &run.filtered})
        for (filters::Gaussian& estimate : *estimates) estimate = noisy->without_errors(estimate);
    }
    if (run.failure) break;
    initial = next_start(model, initial, run.last);
  }
  return run;
}

}  // namespace

bool has_noise(const Eigen::VectorXd& inputs) {
  return inputs.size() > 0 && inputs.maxCoeff() > 0.0;
}

filters::Gaussian next_start(const JointModel& model, const filters::Gaussian& initial,
                             const filters::Gaussian& last) {
  filters::Gaussian next = initial;
  for (const Eigen::Index place : kept_places(model)) next.mean[place] = last.mean[place];
  return next;
}

filters::FilterRun filter_record(const JointModel& model, const filters::Measurements& record,
                                 const IdentificationSettings& settings, filters::Keep keep,
                                 const filters::Trace& trace) {
  std::unique_ptr<filters::DiscreteModel> discrete =
      filters::discretise(model.motion, record.interval(), settings.discretisation,
                          {settings.process_noise, settings.output_noise});
  const filters::NoisyInputs* noisy = nullptr;
  if (has_noise(settings.input_noise)) {
    auto with_errors = std::make_unique<filters::NoisyInputs>(std::move(discrete), settings.input_noise);
    noisy = with_errors.get();
    discrete = std::move(with_errors);
  }
  const auto filter =
      filters::filter_registry().make(settings.filter, settings.filter_options, std::move(discrete));
  require_sample_memory(settings, settings.initial.mean.size());
  require_estimate_memory(settings.initial, static_cast<double>(record.outputs.cols()), keep);
  return filter_passes(*filter, model, record, settings, keep, trace, noisy);
}

bool is_oscillator(const JointModel& model) {
  const auto& unknowns = model.unknowns;
  return unknowns.size() == 2 && unknowns[0].quantity == "stiffness" && unknowns[1].quantity == "damping" &&
         model.equivalent_mass > 0.0 && model.unknown_places == std::vector<Eigen::Index>{2, 3} &&
         dynamic_cast<const filters::LinearMotion*>(model.motion.get());
}

Identification identification_at(const JointModel& model, const filters::Gaussian& estimate) {
  Identification result;
  const Eigen::VectorXd& mean = estimate.mean;
  const Eigen::Matrix2d covariance = estimate.marginal(2, 2);
  result.found = {model.equivalent_mass, mean[2], mean[3]};
  result.stiffness_deviation = deviation(covariance, 1.0, 0.0);
  result.damping_deviation = deviation(covariance, 0.0, 1.0);
  // f = sqrt(K/M) / 2 pi and xi = C / (2 sqrt(K M)), to first order in the errors of K and C
  const auto& [mass, stiffness, damping] = result.found;
  result.frequency_deviation_hz =
      deviation(covariance, 0.25 / (std::numbers::pi * std::sqrt(stiffness * mass)), 0.0);
  result.damping_ratio_deviation = deviation(covariance, -0.5 * result.found.damping_ratio() / stiffness,
                                             0.5 / std::sqrt(stiffness * mass));
  return result;
}

Identification identify(const JointModel& model, const filters::Measurements& record,
                        const IdentificationSettings& settings, filters::Keep keep) {
  filters::FilterRun run = filter_record(model, record, settings, keep);
  Identification result = identification_at(model, run.last);
  result.run = std::move(run);
  return result;
}

bool lost(const Identification& result, double modal_frequency_hz) {
  return !divergence(result, modal_frequency_hz).empty();
}

}  // namespace beamid::experiments
