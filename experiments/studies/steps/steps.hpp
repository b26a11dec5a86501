// The decisive experiment: one record at dt, 2 dt, 4 dt, ..., identified by filters of several
// discretisations.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/identification_request.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {

// What filters of several discretisations make of a record at one step.

/// The discretisation that all others are compared with.
inline constexpr const char* exact_discretisation = "exponential";

/// What one filter makes of the record at one step.
struct SchemeAtStep {
  enum class Verdict {
    exact,        ///< the reference
    harmless,     ///< within the interval of the exact discretisation
    biased,       ///< beyond it, as the closed form says
    unexplained,  ///< not what the closed form says
    invalid       ///< no estimate, or no motion of the scheme is the record's
  };
  std::string discretisation;
  Verdict verdict = Verdict::invalid;
  std::string reason;                  ///< of an invalid one
  std::optional<FoundMode> found;      ///< absent where the filter failed
  std::optional<FoundMode> predicted;  ///< by the closed form, from what the exact one finds at this step
  std::optional<double> mean_nis;      ///< mean normalised square of the innovations

  bool is_valid() const { return verdict != Verdict::invalid && found.has_value(); }
};

const char* to_string(SchemeAtStep::Verdict verdict);

/// The record, every `factor`-th sample behind a low-pass.
struct RecordAtStep {
  int factor = 1;
  double interval = 0.0;  ///< [s]
  Eigen::Index samples = 0;
  double from = 0.0, to = 0.0;      ///< [s]
  std::vector<SchemeAtStep> found;  ///< the exact one first
};

/// Every run of a comparison, the exact discretisation's first, as one step. A damping ratio that the modal
/// analysis contradicts is what is looked for; of the exact one it is invalid.
RecordAtStep record_at_step(const Comparison& comparison, int factor);

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
