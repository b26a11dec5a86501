#include "experiments/identify/compare/widened_interval.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/compare/run_mode.hpp"
#include "experiments/identify/noise_near_mode.hpp"

namespace beamid::experiments {
namespace {

// What counts for frequency and damping is the density of the noise at the mode, whatever R says of all of
// it.
std::vector<double> by_mode(const RunContext& context, ComparedRun& run) {
  const NoiseNearMode& near = *context.analysis.near_mode;
  const double density = near.deviation / run.noise[0], factor = near.student() * density;
  run.near_mode = near;
  if (factor > 1.0) {
    run.noise_ratio = density;
    run.noise_freedom = near.freedom;
    run.interval_factor = factor;
    run.remarks.push_back(fmt::format(
        "Near the mode the noise density, from {} spectral lines, is {:.3g} times that of white noise of the "
        "deviation assumed: intervals are widened by {:.3g}.",
        near.lines, density, factor));
  }
  std::vector<double> factors(run.parameters.size(), run.interval_factor);
  return factors;
}

std::vector<double> by_influence(ComparedRun& run) {
  std::vector<double> factors(run.parameters.size(), 1.0);
  std::string widened;
  for (std::size_t j = 0; j < factors.size() && j < run.noise_in.size(); ++j) {
    const NoiseInEstimate& noise = run.noise_in[j];
    factors[j] = std::max(1.0, student_factor(noise.freedom) * noise.ratio);
    if (factors[j] > run.interval_factor) {
      run.interval_factor = factors[j];
      run.noise_ratio = std::max(noise.ratio, 1.0);
      run.noise_freedom = noise.freedom;
    }
    constexpr double worth_saying = 1.1;
    if (factors[j] > worth_saying)
      widened += fmt::format("{}{} by {:.3g}", widened.empty() ? "" : ", ", run.parameters[j].estimate.name,
                             factors[j]);
  }
  if (!widened.empty())
    run.remarks.push_back(
        "The record's noise is denser where these are determined than white noise of the deviation assumed: "
        "intervals are widened, " +
        widened + ".");
  return factors;
}

// The scatter of a driven record's sections, where it is larger: what the model lacks, counted.
void by_sections(ComparedRun& run, std::vector<double>& factors) {
  constexpr double worth_saying = 1.5;
  std::string widened;
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const ComparedParameter& p = run.parameters[j];
    const double formal = std::sqrt(run.unknown_state.covariance(place, place)),
                 factor = section_factor(*run.sections, place, formal);
    if (!(factor > factors[j]) || p.estimate.value == 0.0) continue;
    if (factor > worth_saying * factors[j])
      widened += fmt::format("{}{} by {:.2g} % ({:.2g} times)", widened.empty() ? "" : ", ", p.estimate.name,
                             100.0 * factor * p.estimate.deviation / std::abs(p.estimate.value), factor);
    factors[j] = factor;
  }
  if (widened.empty()) return;
  run.remarks.push_back(
      fmt::format("Over {} sections of {:.3g} periods the estimates vary by more than noise makes them: {}. "
                  "Intervals are "
                  "widened to hold this; in brackets, over the formal deviation.",
                  run.sections->sections, run.sections->periods, widened));
}

// A filter more certain than record and prior allow has been linearised elsewhere, or has lost its spread:
// its deviation becomes the least there is.
double to_bound(ComparedParameter& p, double factor) {
  if (!p.bound) return factor;
  const double part = overconfidence(factor * p.estimate.deviation, *p.bound, p.estimate.prior_deviation);
  if (!(part > 0.0)) return factor;
  if (part < 1.0) p.overconfidence = part;
  return factor / part;
}

}  // namespace

void set_interval(ComparedRun& run, std::size_t j, double spread) {
  const Unknown& unknown = run.unknowns[j];
  const auto place = static_cast<Eigen::Index>(j);
  const double mean = run.unknown_state.mean[place];
  const double half = quantile_95 * spread * std::sqrt(run.unknown_state.covariance(place, place));
  run.parameters[j].estimate.lower_95 = unknown.to_physical(mean - half);
  run.parameters[j].estimate.upper_95 = unknown.to_physical(mean + half);
}

double overconfidence(double deviation, double bound, double prior_deviation) {
  constexpr double clearly = 0.8;
  const double least = 1.0 / std::hypot(1.0 / bound, 1.0 / prior_deviation), part = deviation / least;
  return part < clearly ? part : 1.0;
}

void widen(ComparedRun& run, std::size_t j, double factor) {
  factor = to_bound(run.parameters[j], factor);
  run.parameters[j].estimate.deviation *= factor;
  set_interval(run, j, factor);
}

void widen_intervals(const RunContext& context, ComparedRun& run) {
  std::vector<double> factors =
      run.noise_in.empty() && context.analysis.modal ? by_mode(context, run) : by_influence(run);
  if (run.sections) by_sections(run, factors);
  for (std::size_t j = 0; j < factors.size(); ++j) widen(run, j, factors[j]);
  if (!run.mode) return;
  run.mode->damping_ratio_deviation *= run.interval_factor;
  run.mode->frequency_deviation_hz *= run.interval_factor;
  if (!run.sections) return;
  const filters::Gaussian scattered{run.unknown_state.mean, run.sections->covariance, {}};
  const auto modes = recorded_modes(*run.model, run.run.last.mean, scattered, run.mode->frequency_hz);
  if (!modes) return;
  const double student = student_factor(run.sections->freedom.minCoeff());
  run.mode->damping_ratio_deviation =
      std::max(run.mode->damping_ratio_deviation, student * modes->shown.damping_ratio_deviation);
  run.mode->frequency_deviation_hz =
      std::max(run.mode->frequency_deviation_hz, student * modes->shown.frequency_deviation_hz);
}

}  // namespace beamid::experiments
