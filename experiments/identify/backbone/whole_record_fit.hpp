// Force laws fitted to all samples of a decay at once, and compared.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/backbone/record_fit.hpp"

namespace beamid::experiments {

struct RecordFits {
  int decimation = 1;
  double noise = 0;             ///< one for all likelihoods
  std::vector<RecordFit> fits;  ///< each model's best number of terms
  int best = -1;                ///< of fits: least BIC of those converged
  int law = -1;                 ///< of fits: least BIC of those with a spline and linear; -1: none
  /// Mean over the windows of the variance that `law` leaves over that which the window's own damped sine
  /// leaves, both behind the windows' low-pass: about one, or less, where it describes the record.
  double lack = 0;

  const RecordFit* find(const std::string& name) const;  ///< nullptr unless it converged
};

/// What the fit begins with.
struct RecordFitStart {
  ForceLaw elastic, masing;
  double mass = 1;
};

/// The decay, low-passed to `samples_per_period` of its fastest window where it has four times as many,
/// moved in 48 steps per period and more (Runge-Kutta), by output-error maximum likelihood
/// (filters::estimate_batch) without a prior:
///
///     ln L = -M/2 ln(2 pi s^2) - sum (y - h)^2 / (2 s^2),   BIC = k ln M - 2 ln L [schwarz1978]
///
/// with one s, what the best of them leaves, as many B-splines as make BIC least.
RecordFits fit_whole_record(const Record& record, const AmplitudeWindows& windows,
                            const RecordFitStart& start, double samples_per_period);

}  // namespace beamid::experiments
