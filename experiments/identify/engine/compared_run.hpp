// One way to identify a record, from the model to its score.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/noise_in_estimates.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// Sensitivities at all samples that are held together: more are gone through sample by sample.
constexpr Eigen::Index most_sensitivities = 20'000'000;

// The noise that a run of the engine assumes, and the one that its bound is worked out with.

struct ComparedRecord;

/// What is certain of the noise of the outputs.
struct KnownNoise {
  Eigen::VectorXd configured;   ///< 0: not configured (p)
  Eigen::VectorXd least;        ///< the sensors' own, or what double precision asks for (p)
  std::vector<bool> is_stated;  ///< in the experiment file, rather than taken from the record (p)
};
KnownNoise known_noise(const Experiment& experiment, const RecordAnalysis& analysis,
                       const ComparedRecord& compared);

/// Of a channel, as stated of it or in [noise] of its quantity; 0: not stated.
double stated_noise(const Experiment& experiment, const Channel& channel);

/// Standard deviations of the inputs, as stated of their channels or in [noise]; 0: exact (m).
Eigen::VectorXd input_noise(const Experiment& experiment, const Record& record);

/// What is configured, else what a motion leaves of the record (p).
Eigen::VectorXd assumed_noise(const KnownNoise& known, const Eigen::VectorXd& left);

/// Of a simulated record its sensors' own, or what the best motion leaves where that is more than chance; of
/// another record what the filter assumes (p).
Eigen::VectorXd noise_of_bound(const ComparedRecord& compared, const KnownNoise& known,
                               const Eigen::VectorXd& left, const Eigen::VectorXd& assumed);

/// R that weighs channels by their size, before anything is known of their noise (p x p).
Eigen::MatrixXd unit_noise(const Eigen::MatrixXd& outputs);

/// How: a filter and a discretisation, and how often the record is filtered.
struct RunSettings {
  Choice filter;
  std::string discretisation;
  int passes = 3;
  double true_mass = 0.0;  ///< of one degree of freedom of the beam simulated, by true_mass() [kg]
  filters::Keep keep = filters::Keep::last_estimate;
  std::optional<LikeliestInputNoise> input_noise = {};  ///< by the record; absent: as stated
};

/// What every run of a comparison shares.
struct RunContext {
  const Experiment& experiment;
  const ComparedRecord& compared;
  const RecordAnalysis& analysis;
  Progress progress = unwatched;
};

/// Filters the record as often as the settings say, then reproduces it and works out the Cramer-Rao bound.
///
/// Each pass is linearised about what the one before found, on a basis of the beam there, with the noise that
/// this motion left, or, of one coordinate, the mode of the modal analysis, which knows no discretisation;
/// what is known beforehand counts once, as the initial estimate has it, however many passes. The bound is
/// that with the noise in the record: of a simulated one, what the best motion leaves, at least the sensors'
/// own; of a measured one, what the filter assumes. Numerical trouble is the run's status.
ComparedRun run_once(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
                     const RunSettings& settings);

// Motion of a record that a model leaves, and what a filter's innovations show of it.

/// Contradicted where the best of all starts and parameters leaves more than 10 % of a record driven by a
/// measured input, or of storeys that follow laws, and more than 50 % of a free decay; approximate where
/// is_approximate().
void judge_motion_left(const RunContext& context, ComparedRun& run);

// Modes without a model beside those of a model (verdict/free_modes.cpp).

/// Of a free decay: fits the modes that the model has in it with poles and shapes of their own, and fills in
/// `free_modes` and `clock_scatter` of the run; neither where the decay is not that of the model's modes.
/// @param outputs of the model's motion nearest to the record (p x N) @param start its state at zero
void look_at_free_modes(const RunContext& context, const Eigen::MatrixXd& outputs,
                        const Eigen::VectorXd& start, ComparedRun& run);

/// Widens the intervals by chi where the model's modes are not those of the record; contradicted
/// where the difference is more than a hundredth of it.
void judge_free_modes(ComparedRun& run);

/// Whether the model explains at least 70 % of a driven record that sections were made of, and more than 10 %
/// of it is left and no noise.
bool is_approximate(const ComparedRun& run);

/// Contradicted where one described quantity, changed alone, explains half of what is left or more, or where
/// one surely differs, by five of its deviations, and moves an unknown by more than the interval reported.
/// @returns whether a cause was named
bool judge_faults(ComparedRun& run);

/// Whether noise of the inputs, and white noise of the outputs beside it, is all that is left: innovations or
/// lines whitened by it are white, but for a probability of one in a thousand, and innovations of one size
/// within a factor of three.
bool leaves_noise(const ComparedRun& run);

/// A warning where the innovations are not those of a consistent filter: not white, or of changing size, with
/// a probability below one in a thousand.
void judge_innovations(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
