// `identify` on clean free decays of all lengths and dampings: whether it ends where it should, each time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// Every range is drawn from evenly in the logarithm.
struct SeededDecays {
  int runs = 2000;
  std::uint64_t seed = 1;
  std::pair<double, double> periods{5, 500};
  std::pair<double, double> damping_ratio{0.001, 0.05};
  std::pair<double, double> noise{0.0005, 0.05};  ///< deviation, of the amplitude
  std::pair<double, double> samples_per_period{8, 24};
  std::pair<double, double> beam_error{0.9, 1.1};  ///< frequency of the beam as described over the record's
};

/// One of them.
struct SeededDecay {
  double periods = 0, damping_ratio = 0, noise = 0, samples_per_period = 0;
  double frequency_hz = 0;     ///< of the record
  Experiment experiment = {};  ///< the beam as described
  Record record = {};
};

/// Acceleration at the tip of a steel cantilever in its first mode, with white noise.
SeededDecay seeded_decay(const SeededDecays& settings, int run);

/// What became of it.
struct DecayOutcome {
  std::string failure;  ///< what was thrown, or why the result is no good; empty: it converged
  double frequency_error = 0, damping_error = 0;  ///< over the deviations reported
};
DecayOutcome identify_decay(const SeededDecay& decay);

struct DecayOutcomes {
  SeededDecays settings;
  std::vector<DecayOutcome> runs;

  int failed() const;
  int frequency_inside() const;  ///< of the 95 % intervals
  int damping_inside() const;
};

/// The numbers do not depend on the number of processors. @throws std::invalid_argument when runs < 1.
DecayOutcomes seeded_decays(const SeededDecays& settings, const Progress& progress);

Results report(const DecayOutcomes& outcomes);

}  // namespace beamid::experiments
