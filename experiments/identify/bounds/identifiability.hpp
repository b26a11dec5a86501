// What a test can tell about a beam, before it is made.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/text/progress.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {

// What each sensor tells by itself, over one pass through a model's motion.

/// A motion of a model, about which sensors are asked.
struct ObservedMotion {
  JointModel model;
  Eigen::VectorXd initial_state;  ///< (n), the unknowns in their places
  StartDirections directions;
  Eigen::MatrixXd inputs =
      {};                 ///< u_k in its columns, as a discrete model takes them (m (d + 1) x N); empty: none
  double interval = 0.0;  ///< between samples [s]
  std::string discretisation = "exponential";
};

/// A record: the first `samples` of the motion, every `stride`-th of them read.
struct Reading {
  Eigen::Index samples = 0;
  Eigen::Index stride = 1;
};

/// Fisher information of every channel about [start (2k), unknowns (q)], in units of the directions, were its
/// noise 1 [unit of the channel] per sample. What a channel's own bias and drift may imitate is taken off.
///
/// White noises that do not depend on each other: the information of some channels together is the sum of
/// theirs, each divided by its variance.
struct ChannelInformation {
  Eigen::Index start = 0;                            ///< 2k
  std::vector<filters::InformationFactor> channels;  ///< p
};

/// One for each reading, from a single pass over the longest of them.
/// @throws std::invalid_argument when a reading has no sample or no stride, or the inputs end too early;
/// std::runtime_error when the motion or its sensitivities do not remain finite.
std::vector<ChannelInformation> channel_information(const ObservedMotion& motion,
                                                    const std::vector<Reading>& readings);

// How well the unknowns of a model can be known at best.

/// A channel that is read, and its white noise.
struct NoisyChannel {
  Eigen::Index channel = 0;
  double deviation = 0.0;  ///< per sample [unit of the channel]
};

/// What an unknown is, and the size [its unit] in which it is reckoned: the size of its value, or its
/// deviation where the value is zero.
struct UnknownSize {
  double value = 0.0;
  double size = 0.0;
  bool of_value = true;        ///< false: the size is the deviation
  double per_direction = 0.0;  ///< change of the unknown per unit of its direction, over the size
};
std::vector<UnknownSize> unknown_sizes(const ObservedMotion& motion);

/// Information of some channels about the q unknowns, each in units of its size, the start unknown. What is
/// known beforehand of nuisance parameters counts, what is guessed of the others does not.
/// @throws std::invalid_argument when a deviation is not positive.
filters::InformationFactor information_about_unknowns(const ObservedMotion& motion,
                                                      const ChannelInformation& information,
                                                      const std::vector<NoisyChannel>& channels);

/// Cramer-Rao bound on each unknown over its size, infinity where it is not determined (q).
Eigen::VectorXd relative_bounds(const filters::InformationFactor& information);

/// What the record says about one unknown.
struct ParameterBound {
  enum class Verdict {
    determined,   ///< bound below its size
    poor,         ///< bound above its size: not in practice
    combination,  ///< only together with others
    nothing       ///< no sensor shows anything of it
  };
  std::string name, unit;
  double value = 0.0;                     ///< at which the bounds hold [unit]
  double size = 0.0;                      ///< what relative numbers are relative to [unit]
  bool of_value = true;                   ///< the size is that of the value; false: its deviation beforehand
  double bound = 0.0;                     ///< on the standard deviation [unit]; infinity: not determined
  double conditional_bound = 0.0;         ///< the same were all others known [unit]
  double lower_95 = 0.0, upper_95 = 0.0;  ///< [unit]
  bool nuisance = false;
  double prior_deviation = 0.0;  ///< [unit]
  Verdict verdict = Verdict::determined;

  double bound_percent() const { return 100.0 * bound / size; }
  double conditional_percent() const { return 100.0 * conditional_bound / size; }
};
const char* to_string(ParameterBound::Verdict verdict);

/// One for each unknown. The intervals are those of the filter's state, carried through the unknown's form.
std::vector<ParameterBound> parameter_bounds(const ObservedMotion& motion,
                                             const filters::InformationReport& report);

/// Bounds along one quantity of the test that is varied, all else as described.
struct BoundSweep {
  Eigen::VectorXd at;       ///< (k): duration [s], sampling rate [Hz], place [m], number of sensors
  Eigen::MatrixXd percent;  ///< bounds over sizes, infinity where undetermined (k x q)
  /// Beside a rate: modes below half of it; beside a number: where the last one sits [m], NaN where it was
  /// described (k, or none).
  Eigen::VectorXd beside = {};

  bool empty() const { return at.size() == 0; }
};

struct Identifiability {
  /// An instrument as it was reckoned with.
  struct UsedSensor {
    Sensor sensor;         ///< name and position filled in
    bool assumed = false;  ///< its noise was not described
  };
  std::string model, reduction;
  Eigen::Index coordinates = 0;        ///< r, of the model
  std::vector<double> frequencies_hz;  ///< of the model's modes
  std::vector<UsedSensor> sensors;
  bool force_measured = false;
  std::optional<RecordInputs> inputs = {};     ///< how a measured force was taken to run
  double begin = 0.0;                          ///< of the record, after the excitation's start [s]
  double duration = 0.0, sampling_rate = 0.0;  ///< [s], [Hz]
  double slowest_decay = 0.0;                  ///< 1 / (xi omega) of mode 1 [s]; 0: it does not decay

  std::vector<ParameterBound> parameters;  ///< q
  filters::InformationReport report;       ///< of the unknowns over their sizes
  BoundSweep lengths, rates, places, numbers;
  Eigen::Index described_length = 0;  ///< entry of `lengths` that is the record described
  std::vector<std::string> notes;     ///< what a reader should know, a sentence each
};

/// Combinations of the unknowns that leave the record as it is: in each column relative changes, the largest
/// 1, with as many zeros as can be (q x (q - rank)).
Eigen::MatrixXd silent_combinations(const filters::InformationReport& report);

/// The model of the experiment moves as described, from all excitations described, and is read by the sensors
/// described.
/// @param folder in which the excitation's file is looked for.
/// @throws InputError, std::invalid_argument as model_setting(), simulate() and the models.
Identifiability find_identifiability(const Experiment& experiment, const std::filesystem::path& folder,
                                     const Progress& progress);

}  // namespace beamid::experiments
