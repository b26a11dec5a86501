// The decisive experiment: one record at dt, 2 dt, 4 dt, ..., identified by filters of several
// discretisations.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/identification_request.hpp"
#include "experiments/studies/steps/scheme_at_step.hpp"

namespace beamid::experiments {

struct StepsSettings {
  std::vector<std::string> discretisations;  ///< beside the exact one
  std::optional<int> steps = {};             ///< how many; absent: as many as the record allows well
};

/// One discretisation at all steps, carried on to dt = 0 without its closed form.
struct Extrapolation {
  int order = 0;  ///< of the scheme, p
  int steps = 0;  ///< used
  double frequency_hz = 0.0, damping_ratio = 0.0;
  double uncertainty = 0.0;  ///< of the ratio: what the longest step changes
};

struct StepsStudy {
  std::string record;                                           ///< its name
  std::vector<std::string> discretisations;                     ///< the exact one first
  ComparedRun::Status status = ComparedRun::Status::converged;  ///< of the exact one at the record's own step
  std::vector<RecordAtStep> steps;                              ///< the record's own first
  std::vector<std::string> notes, warnings;                     ///< warnings: the worst first

  bool has_reference() const {
    return status == ComparedRun::Status::converged || status == ComparedRun::Status::approximate;
  }
  const FoundMode& reference() const { return *steps[0].found[0].found; }
  /// f0 + a dt^p + b dt^(p+1) + ... through the valid steps below 1 rad of the motion, the four finest;
  /// nothing of fewer than two, nor of a scheme without an error to be carried on.
  std::optional<Extrapolation> extrapolated(std::size_t discretisation) const;
};

/// p of e^z - g(z) = c z^(p+1) + ...; 0: of no finite order.
int order_of(const std::string& scheme);

/// Identifies K and C of a free decay (model sdof, whatever model the experiment has) from the record at each
/// step. Decimation is band-limited (signal/decimation.hpp), on a grid that holds the first sample of the
/// window, with samples from outside the window where the file has them.
///
/// Steps double as long as the record keeps 8 samples a period and 100 in all; where `settings` ask for more,
/// 10 / 3 a period, which is what decimation leaves untouched, and 50 in all.
/// @throws InputError, std::invalid_argument where a force was measured, no mode is found in the record, or
/// the beam's lies above half the sampling rate.
StepsStudy study_steps(const StepsSettings& settings, const IdentificationRequest& one,
                       const std::filesystem::path& folder, const Progress& progress);

/// The experiment with its model in the place of what it asks: K and C of one degree of freedom.
Experiment as_oscillator(Experiment experiment);

}  // namespace beamid::experiments
