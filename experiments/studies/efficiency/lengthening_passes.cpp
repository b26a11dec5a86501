#include "experiments/studies/efficiency/lengthening_passes.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "filters/filter_run.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

void check_lengthening_passes(const LengtheningSettings& settings) {
  const auto require = [](bool good, const std::string& what) {
    if (!good) throw std::invalid_argument("lengthening passes: " + what);
  };
  require(settings.first_samples >= 1,
          "first_samples is " + std::to_string(settings.first_samples) + "; expected at least 1");
  require(settings.passes >= 1 && settings.last_passes >= 1,
          "passes are " + std::to_string(settings.passes) + " and " + std::to_string(settings.last_passes) +
              "; expected at least 1");
  require(settings.widening > 1.0,
          "widening is " + std::to_string(settings.widening) + "; expected a number above 1");
}

filters::Measurements first_samples(const filters::Measurements& record, Index samples) {
  filters::Measurements part = record;
  part.time = record.time.head(samples);
  part.outputs = record.outputs.leftCols(samples);
  if (record.inputs.size() > 0) part.inputs = record.inputs.leftCols(samples);
  if (record.output_deviations.size() > 0)
    part.output_deviations = record.output_deviations.leftCols(samples);
  return part;
}

// The motion as unknown as at first; the constants where the last pass left them.
filters::Gaussian next(const filters::Gaussian& initial, const filters::Gaussian& last,
                       const std::vector<Index>& constants, double widening) {
  filters::Gaussian start = initial;
  const Eigen::VectorXd first = initial.deviations(), told = last.deviations();
  for (const Index c : constants) {
    start.mean[c] = last.mean[c];
    const double share = std::min(1.0, widening * told[c] / first[c]);
    start.covariance.row(c) *= share;
    start.covariance.col(c) *= share;
  }
  return start;
}

}  // namespace

std::optional<filters::Gaussian> lengthening_passes(filters::Filter& filter, const filters::Gaussian& initial,
                                                    const filters::Measurements& record,
                                                    const std::vector<Index>& constants,
                                                    const LengtheningSettings& settings) {
  check_lengthening_passes(settings);
  filters::Gaussian start = initial;
  for (Index samples = std::min(settings.first_samples, record.size());;
       samples = std::min(2 * samples, record.size())) {
    const bool whole = samples == record.size();
    const filters::Measurements part = first_samples(record, samples);
    for (int pass = 1; pass <= (whole ? settings.last_passes : settings.passes); ++pass) {
      filters::FilterRun run = filters::run(filter, start, part);
      if (run.failure) return std::nullopt;
      start = next(initial, run.last, constants, settings.widening);
      if (whole && pass == settings.last_passes) return run.last;
    }
  }
}

}  // namespace beamid::experiments
