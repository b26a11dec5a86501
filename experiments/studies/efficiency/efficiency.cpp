#include "experiments/studies/efficiency/efficiency.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/studies/efficiency/lengthening_passes.hpp"
#include "experiments/text/countdown.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

const std::vector<Index> constants{2, 3};  // K and C in [x, v, K, C]

bool has(const Choice& filter, const char* contract) {
  return filters::filter_registry().find(filter.name).contracts.contains(contract);
}

int runs_with(const EfficiencySettings& settings, const Choice& filter) {
  return has(filter, filters::contract::sampled_on_linear_gaussian) ? settings.sampled_runs : settings.runs;
}

std::size_t all_runs(const EfficiencySettings& settings) {
  std::size_t runs = 0;
  for (const Choice& filter : settings.filters) runs += static_cast<std::size_t>(runs_with(settings, filter));
  return runs * settings.damping_ratios.size() * settings.passes.size();
}

std::optional<filters::Gaussian> estimate(const Choice& choice, Passes passes, const FreeDecays& decays,
                                          std::uint64_t seed) {
  const filters::Trial trial = decays.trial(seed);
  const auto filter = filters::filter_registry().make(choice.name, choice.options, decays.model());
  std::optional<filters::Gaussian> last;
  if (passes == Passes::lengthening) {
    LengtheningSettings settings;
    settings.first_samples = static_cast<Index>(std::lround(decays.settings().samples_per_cycle));
    last = lengthening_passes(*filter, trial.initial, trial.record, constants, settings);
  } else if (filters::FilterRun run = filters::run(*filter, trial.initial, trial.record); !run.failure) {
    last = run.last;
  }
  if (!last) return std::nullopt;
  return filters::Gaussian{last->mean.segment<2>(2), last->marginal(2, 2)};
}

EfficiencyCase measure(const EfficiencySettings& settings, const Choice& filter, Passes passes,
                       const FreeDecays& decays, Countdown& countdown) {
  const Oscillator& truth = decays.truth();
  const Eigen::Vector2d constant(truth.stiffness, truth.damping);
  EfficiencyCase one{filter, passes, decays.settings().damping_ratio, truth, decays.bound(), {}, {}};
  one.largest = (10.0 * decays.bound()).cwiseMax(Eigen::Vector2d(0.05, 0.5).cwiseProduct(constant));
  const int runs = runs_with(settings, filter);
  std::vector<std::optional<filters::Gaussian>> found(static_cast<std::size_t>(runs));
  tbb::parallel_for(0, runs, [&](int run) {
    found[static_cast<std::size_t>(run)] =
        estimate(filter, passes, decays, settings.seed + static_cast<std::uint64_t>(run));
    countdown.count();
  });
  // what the runs found, told in their order
  std::size_t next = 0;
  one.result = filters::monte_carlo(
      [&](std::uint64_t) {
        return filters::Trial{{}, {}, constant};
      },
      [&](const filters::Trial&) { return found[next++]; }, {runs, settings.seed, one.bound, one.largest});
  return one;
}

void check_efficiency(const EfficiencySettings& settings) {
  if (settings.filters.empty() || settings.damping_ratios.empty() || settings.passes.empty())
    throw std::invalid_argument("efficiency: found no filter, no damping ratio or no way to pass");
  if (settings.runs < 2 || settings.sampled_runs < 2)
    throw std::invalid_argument(
        fmt::format("efficiency: {} and {} runs; expected at least 2", settings.runs, settings.sampled_runs));
  for (const Choice& filter : settings.filters)
    if (has(filter, filters::contract::linear_models_only))
      throw std::invalid_argument(fmt::format(
          "filter '{}' takes linear models only; the oscillator with unknown K and C is none", filter.name));
}

}  // namespace

const char* to_string(Passes passes) {
  return passes == Passes::lengthening ? "lengthening" : "single";
}

std::vector<Choice> applicable_filters() {
  std::vector<Choice> choices;
  for (const auto& [name, entry] : filters::filter_registry().entries())
    if (!entry.contracts.contains(filters::contract::linear_models_only))
      choices.push_back({name, filters::filter_registry().completed(name, {}), {}});
  return choices;
}

Efficiency find_efficiency(const EfficiencySettings& settings, const Progress& progress) {
  check_efficiency(settings);
  Efficiency all{settings, {}};
  Countdown countdown(progress, all_runs(settings), "runs");
  for (const double damping_ratio : settings.damping_ratios) {
    DecaySettings decay = settings.decay;
    decay.damping_ratio = damping_ratio;
    const FreeDecays decays(decay);
    for (const Passes passes : settings.passes)
      for (const Choice& filter : settings.filters) {
        countdown.begin(fmt::format("{}, {} passes, damping ratio {:g} %", filter.name, to_string(passes),
                                    100.0 * damping_ratio));
        all.cases.push_back(measure(settings, filter, passes, decays, countdown));
      }
  }
  return all;
}

}  // namespace beamid::experiments
