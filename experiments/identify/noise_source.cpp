#include "experiments/identify/noise_source.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "experiments/identify/model_setting.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/onsets.hpp"
#include "filters/noise_estimation.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd noise_before_event(const Record& record) {
  const Record whole = analysable(record).record;
  constexpr Index fewest = 32;
  constexpr double normal_consistency = 1.4826;  // of the median absolute deviation
  Index quiet = whole.size();
  bool any = false;
  for (Index i = 0; i < whole.samples.rows(); ++i) {
    const Onsets onsets = find_onsets(whole.samples.row(i).transpose(), whole.interval());
    if (onsets.samples.empty()) continue;
    any = true;
    quiet = std::min(quiet, onsets.quiet);
  }
  if (!any || quiet < fewest)
    throw std::invalid_argument(
        "noise.method is before_event, but " +
        (any ? "only " + std::to_string(quiet) + " samples lie before the record's first event"
             : std::string("the record has no event that begins from rest")) +
        "; expected 32 at least. residual and likelihood need none");
  VectorXd noise(static_cast<Index>(output_channels(whole).size()));
  Index k = 0;
  for (const Index i : output_channels(whole)) {
    const VectorXd part = whole.samples.row(i).head(quiet).transpose();
    noise[k++] = normal_consistency * median((part.array() - median(part)).abs());
  }
  return noise;
}

LikeliestNoise likeliest_noise(const Experiment& experiment, const Record& record, const JointModel& model,
                               const IdentificationSettings& settings, const filters::Gaussian& last) {
  const std::vector<Index> channels = output_channels(record);
  std::map<Quantity, std::vector<Index>> groups;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Quantity quantity = record.channels[static_cast<std::size_t>(channels[i])].quantity;
    if (!experiment.noise.contains(quantity)) groups[quantity].push_back(static_cast<Index>(i));
  }
  if (groups.empty())
    throw std::invalid_argument("noise.method is likelihood, but [noise] states the noise of every channel");
  const Index states = settings.initial.mean.size();
  filters::NoiseSettings search;
  search.guess = {Eigen::MatrixXd::Zero(states, states), settings.output_noise};
  search.output_groups.clear();
  for (const auto& [quantity, members] : groups) search.output_groups.push_back(members);
  search.max_iterations = 50;
  const filters::NoiseEstimate estimate = filters::estimate_noise(
      [&](const filters::Noise& noise) {
        return filters::filter_registry().make(
            settings.filter, settings.filter_options,
            filters::discretise(model.motion, record.interval(), settings.discretisation, noise));
      },
      next_start(model, settings.initial, last), measurements(record), search);
  if (estimate.status == filters::NoiseStatus::failed)
    throw std::invalid_argument("noise.method is likelihood, but the search for it failed: " +
                                estimate.reason);
  LikeliestNoise found{estimate.noise.output.diagonal().cwiseSqrt(), {}};
  found.relative_deviation = VectorXd::Zero(found.deviation.size());
  Index group = 0;
  for (const auto& [quantity, members] : groups) {
    for (const Index i : members) found.relative_deviation[i] = estimate.relative_deviations[group];
    ++group;
  }
  return found;
}

}  // namespace beamid::experiments
