#include "experiments/identify/backbone/record_fit.hpp"

namespace beamid::experiments {

RecordFit record_fit(const std::string& name, const filters::BatchEstimate& found,
                     const DecaySamples& samples, int steps) {
  RecordFit fit;
  fit.name = name;
  fit.reason = found.reason;
  fit.converged = found.status == filters::BatchStatus::converged;
  if (found.status == filters::BatchStatus::failed) return fit;
  fit.residuals.resize(samples.size());
  for (Eigen::Index k = 0; k < samples.size(); ++k) fit.residuals[k] = found.residuals(0, k * steps);
  fit.left = fit.residuals.norm() / samples.plain.outputs.norm();
  return fit;
}

}  // namespace beamid::experiments
