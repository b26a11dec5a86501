// What a published damping ratio was, if a filter of that discretisation and step found it.
#pragma once

#include <optional>
#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/steps/steps.hpp"

namespace beamid::experiments {

struct PublishedDamping {
  double ratio = 0.0;
  double half_digit = 0.0;  ///< half a unit of its last digit as it was written
  std::string scheme;
  double interval = 0.0;      ///< [s]
  double frequency_hz = 0.0;  ///< found by the same filter, or the structure's own
  bool is_true_frequency = false;
  std::string source = {};                  ///< of the frequency and interval; empty: stated
  std::optional<FoundMode> of_record = {};  ///< what the exact discretisation finds in the record
};

/// What it looked at. Ratios may come out negative: then no damped motion gives the published one.
struct BehindPublished {
  PublishedDamping published;
  FoundMode truth;
  double lower = 0.0, upper = 0.0;           ///< of the ratio, for the published one's last digit
  double least = 0.0;                        ///< what such a filter finds of an undamped motion
  std::optional<double> with_process_noise;  ///< the ratio, of forward Euler on displacement and velocity

  bool is_possible() const { return truth.damping_ratio > 0.0; }
};

/// Half a unit of the last digit of a number as it is written: 0.0005 of "0.034", 0.05 of "1e-1".
double half_digit_of(const std::string& number);

/// @throws std::invalid_argument when the step is half a period or longer, or no ratio gives the published
/// one.
BehindPublished behind_published(const PublishedDamping& published);

Results report(const BehindPublished& found);

// What one record at several steps shows, for a person and for programs.

/// Its first lines say how wrong a filter of each discretisation is on this record. Tables `steps` and
/// `extrapolation`, figure `step_size`, results.json keys.
Results report(const Experiment& experiment, const StepsStudy& study);

/// First the damping ratios that each discretisation finds at the record's own step beside those of the exact
/// one. Tables `modes`, `parameters`.
Results report(const Experiment& experiment, const ModelSteps& study);

/// Damping ratio and frequency found, on the curves that the closed form predicts.
Figure steps_figure(const StepsStudy& study);

}  // namespace beamid::experiments
