#include "filters/filter_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "filters/stop_request.hpp"

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

void check_trace(const Trace& trace, Index states) {
  for (const Index entry : trace.entries)
    if (entry < 0 || entry >= states)
      throw std::invalid_argument("traced entry is " + std::to_string(entry) + "; expected 0 to " +
                                  std::to_string(states - 1));
}

void take_sample(const Measurements& measurements, Index step, Sample& sample) {
  sample.time = measurements.time[step];
  sample.output = measurements.outputs.col(step);
  if (measurements.inputs.size() > 0) sample.input = measurements.inputs.col(step);
  if (measurements.output_deviations.size() > 0) sample.deviations = measurements.output_deviations.col(step);
}

// What a correction told, at the places of the outputs that it took in.
void store(const Correction& correction, const std::vector<Index>& observed, Index step, FilterRun& result) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const Index told = correction.innovation.size();
  if (told < result.innovations.rows()) {
    result.innovations.col(step).setConstant(none);
    result.whitened_innovations.col(step).setConstant(none);
  }
  for (Index i = 0; i < told; ++i) {
    const Index place = observed[static_cast<std::size_t>(i)];
    result.innovations(place, step) = correction.innovation[i];
    result.whitened_innovations(place, step) = correction.whitened[i];
  }
  result.normalised_squares[step] = told > 0 ? correction.normalised_square : none;
  result.log_likelihood += correction.log_likelihood;
}

void trace(const Gaussian& estimate, const std::vector<Index>& entries, Index step, FilterRun& result) {
  const bool has_covariance = estimate.covariance.size() > 0;
  for (Index i = 0; i < result.means.rows(); ++i) {
    const Index entry = entries[static_cast<std::size_t>(i)];
    result.means(i, step) = estimate.mean[entry];
    result.deviations(i, step) = has_covariance ? std::sqrt(std::max(estimate.covariance(entry, entry), 0.0))
                                                : estimate.factor.row(entry).norm();
  }
}

}  // namespace

FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements,
              const RunSettings& settings) {
  const Index samples = measurements.size(), outputs = filter.model().all_outputs();
  check_measurements(measurements, outputs);
  check_trace(settings.trace, initial.mean.size());

  FilterRun result;
  result.innovations.setZero(outputs, samples);
  result.whitened_innovations.setZero(outputs, samples);
  result.normalised_squares.setZero(samples);
  const auto traced = static_cast<Index>(settings.trace.entries.size());
  result.means.setZero(traced, samples);
  result.deviations.setZero(traced, samples);
  RunningFilter running(filter, settings.on_failure, measurements.time_resolution);
  running.start(initial, settings.start);
  Sample sample;
  for (Index step = 0; step < samples; ++step) {
    constexpr Index between_looks = 64;
    if (step % between_looks == 0) heed_stop_request();
    take_sample(measurements, step, sample);
    if (!running.move_to(sample.time)) break;
    if (settings.keep == Keep::all_estimates) result.predicted.push_back(running.estimate());
    if (!running.correct(sample)) break;
    store(running.correction(), filter.model().observed(), step, result);
    if (settings.keep == Keep::all_estimates) result.filtered.push_back(running.estimate());
    if (traced > 0) trace(running.estimate(), settings.trace.entries, step, result);
  }
  result.failure = running.failure();
  result.events = running.events();
  result.last = running.estimate();
  result.remarks = filter.remarks();
  return result;
}

FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements, Keep keep,
              Start start, const Trace& trace) {
  return run(filter, initial, measurements, {keep, start, trace});
}

}  // namespace beamid::filters
