#include "filters/filter_run.hpp"

#include <limits>
#include <stdexcept>

namespace beamid::filters {

FilterRun run(Filter& filter, const Gaussian& initial, const Measurements& measurements, Keep keep,
              Start start, const Trace& trace) {
  const Eigen::Index samples = measurements.time.size();
  const auto outputs = static_cast<Eigen::Index>(filter.model().output_labels().size());
  if (measurements.outputs.rows() != outputs || measurements.outputs.cols() != samples)
    throw std::invalid_argument("outputs are " + std::to_string(measurements.outputs.rows()) + " x " +
                                std::to_string(measurements.outputs.cols()) + "; expected " +
                                std::to_string(outputs) + " x " + std::to_string(samples));
  if (measurements.inputs.size() > 0 && measurements.inputs.cols() != samples)
    throw std::invalid_argument("inputs have " + std::to_string(measurements.inputs.cols()) +
                                " columns; expected " + std::to_string(samples));
  const Eigen::Index states = initial.mean.size();
  for (const Eigen::Index entry : trace.entries)
    if (entry < 0 || entry >= states)
      throw std::invalid_argument("traced entry is " + std::to_string(entry) + "; expected 0 to " +
                                  std::to_string(states - 1));

  FilterRun result;
  result.innovations.setZero(outputs, samples);
  result.whitened_innovations.setZero(outputs, samples);
  result.normalised_squares.setZero(samples);
  const auto traced = static_cast<Eigen::Index>(trace.entries.size());
  result.means.setZero(traced, samples);
  result.deviations.setZero(traced, samples);
  Eigen::VectorXd input, output(outputs);
  filter.reset(initial);
  Eigen::Index step = 0;
  try {
    for (; step < samples; ++step) {
      if (step > 0 || start == Start::one_interval_before) filter.predict(input);
      if (keep == Keep::all_beliefs) result.predicted.push_back(filter.belief());
      if (measurements.inputs.size() > 0) input = measurements.inputs.col(step);
      output = measurements.outputs.col(step);
      const Correction& correction = filter.correct(output, input);
      result.innovations.col(step) = correction.innovation;
      result.whitened_innovations.col(step) = correction.whitened;
      result.normalised_squares[step] = correction.normalised_square;
      result.log_likelihood += correction.log_likelihood;
      if (keep == Keep::all_beliefs) result.filtered.push_back(filter.belief());
      if (traced == 0) continue;
      const Gaussian belief = filter.marginal(trace.entries);
      result.means.col(step) = belief.mean;
      result.deviations.col(step) = belief.deviations();
    }
  } catch (const FilterFailure& trouble) {
    result.failure = Failure{step, measurements.time[step], trouble.what(), trouble.smallest_eigenvalue};
  } catch (const std::runtime_error& trouble) {  // a discretisation that cannot take the step
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    result.failure = Failure{step, measurements.time[step], trouble.what(), unknown};
  }
  result.last = filter.belief();
  result.remarks = filter.remarks();
  return result;
}

}  // namespace beamid::filters
