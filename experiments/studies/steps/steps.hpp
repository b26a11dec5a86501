// The decisive experiment: one record at dt, 2 dt, 4 dt, ..., identified by filters of several
// discretisations.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/identification_request.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/objection.hpp"

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
  std::vector<std::string> notes;
  std::vector<Objection> objections;  ///< the worst first

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

/// What the closed form of a scheme makes of one mode; absent where no motion of the scheme is like it.
std::optional<FoundMode> predicted_mode(const std::string& scheme, const FoundMode& exact, double interval);

/// Every `factor`-th sample of the record's window behind a low-pass. @param whole the record behind its
/// preparation, before its window
Record at_step(const IdentificationRequest& one, const Record& whole, int factor);

/// f0 of f0 + a dt^p + b dt^(p+1) + ... through all of them, entry by entry.
Eigen::VectorXd carried_to_zero(const std::vector<double>& intervals,
                                const std::vector<Eigen::VectorXd>& found, int order);

// The same of all unknowns of a model of many degrees of freedom.

/// What one filter makes of the model's unknowns and modes at one step.
struct ModelAtStep {
  std::string discretisation;
  int factor = 1;
  double interval = 0.0;  ///< [s]
  ComparedRun::Status status = ComparedRun::Status::diverged;
  std::string reason;                ///< of one without an estimate
  std::vector<Estimate> parameters;  ///< empty without an estimate
  std::vector<FoundMode> modes;      ///< ascending, undamped frequency
  std::vector<FoundMode> behind;     ///< the motion that the law finds behind them: log(g(lambda dt)) / dt
};

/// A step of every discretisation, the exact one first.
struct ModelSteps {
  std::string record;
  std::vector<std::string> discretisations;
  std::vector<std::vector<ModelAtStep>> steps;  ///< by factor, then discretisation
  std::vector<std::string> notes;

  /// The parameters of one discretisation at a step of zero, of the steps below 1 rad of its highest mode,
  /// four at most (q); absent of fewer than two, and of a scheme without an error.
  std::optional<Eigen::VectorXd> extrapolated(std::size_t discretisation) const;
  const ModelAtStep& reference() const { return steps.front().front(); }
};

/// Identifies the model of the experiment, under whatever was measured, at dt, 2 dt, ... as far as its
/// highest mode keeps 10 / 3 samples a period and the record 100; settings.steps at most.
/// @throws InputError, std::invalid_argument as compare()
ModelSteps study_model_steps(const StepsSettings& settings, const IdentificationRequest& one,
                             const std::filesystem::path& folder, const Progress& progress);

/// The experiment with its model in the place of what it asks: K and C of one degree of freedom.
Experiment as_oscillator(Experiment experiment);

// What a published damping ratio was, if a filter of that discretisation and step found it.

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
