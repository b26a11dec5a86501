// Models fitted to one record, ranked by one noise level.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/backbone/record_fit.hpp"

namespace beamid::experiments {

/// The fits of all models and numbers of terms, BIC = k ln M + sum (y - h)^2 / s^2 [schwarz1978] but for a
/// constant.
class ModelRanking {
 public:
  explicit ModelRanking(const DecaySamples& samples)
      : count_(static_cast<double>(samples.size())), peak_(samples.peak()) {}

  std::vector<RecordFit> fits;

  /// s: the least that a fit leaves, no less than 1e-7 of the largest sample; infinite without a fit.
  double noise() const;
  double bic(const RecordFit& fit, double noise) const;
  /// Of a model's fits that of least BIC, of those converged if there are any; nullptr without one.
  const RecordFit* best_of(const std::string& name, double noise) const;
  /// The better of the elastic spring and Masing's loop; nullptr where neither converged.
  const RecordFit* best_spring() const;
  /// Each model's best fit with likelihood and BIC.
  /// @param scale s^2 over the variance that the fits' covariances assumed
  std::vector<RecordFit> best_of_each(double noise, double scale) const;

 private:
  double count_, peak_;
};

}  // namespace beamid::experiments
