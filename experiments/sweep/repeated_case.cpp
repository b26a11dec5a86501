#include "experiments/sweep/repeated_case.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/models/divergence.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/text/choice_text.hpp"
#include "filters/normal_noise.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

std::optional<filters::Quantity> lane_quantity(Quantity quantity) {
  if (quantity == Quantity::displacement) return filters::Quantity::displacement;
  if (quantity == Quantity::velocity) return filters::Quantity::velocity;
  if (quantity == Quantity::acceleration) return filters::Quantity::acceleration;
  return {};
}

}  // namespace

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

}  // namespace beamid::experiments
