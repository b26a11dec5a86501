// The test that an experiment describes, as a motion of its model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/bounds/identifiability.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

// Tests like the one described, but for one quantity.

/// The longest record looked at, times the one described.
inline constexpr Eigen::Index longest_record = 4;

/// Fills in lengths and rates, and from the record described the parameters and the report.
void sweep_in_time(const ObservedMotion& motion, const std::vector<NoisyChannel>& channels,
                   Identifiability& result);

/// Fills in places and numbers.
/// @param described the channels of the sensors described; the first is moved, and added again.
void sweep_in_place(const Experiment& experiment, const std::filesystem::path& folder,
                    const std::vector<NoisyChannel>& described, Identifiability& result,
                    const Progress& progress);

/// Lengths of record, in samples, evenly spread on a logarithmic scale from a few periods of the slowest mode
/// to `most`, the described one among them.
std::vector<Eigen::Index> record_lengths(double samples_per_period, Eigen::Index described,
                                         Eigen::Index most);

/// Every how many samples may be left: 1, 2, 5, 10, ... as long as mode 1 stays below half the sampling rate.
std::vector<Eigen::Index> strides(double samples_per_period, Eigen::Index samples);

/// Bounds over sizes of one set of channels, from several records (k x q).
Eigen::MatrixXd bounds_percent(const ObservedMotion& motion, const std::vector<ChannelInformation>& records,
                               const std::vector<NoisyChannel>& channels);

/// Bounds of one channel after another, alone (k x q).
Eigen::MatrixXd bounds_percent_alone(const ObservedMotion& motion, const ChannelInformation& record,
                                     const std::vector<NoisyChannel>& channels);

/// A further sensor, chosen from candidates.
struct AddedChannel {
  std::size_t candidate = 0;
  Eigen::VectorXd percent;  ///< bounds with it (q)
};

/// Adds channels one by one, each time the one that leaves the least uncertainty: more combinations
/// determined, then the larger determinant of the information (D-optimal [kay1993]).
std::vector<AddedChannel> add_best(const ObservedMotion& motion, const ChannelInformation& record,
                                   std::vector<NoisyChannel> channels,
                                   const std::vector<NoisyChannel>& candidates, int count);

/// How a test is looked at.
struct TestView {
  std::vector<Sensor> sensors;  ///< one channel each
  Eigen::Index samples = 0;     ///< that the inputs have to reach
  double simulated = 0.0;       ///< duration for which the continuum is simulated, at least [s]
  bool force_measured = true;   ///< all of them; else the record begins when the last has ended
};

struct DescribedMotion {
  ObservedMotion motion;
  std::vector<Sensor> sensors;              ///< names and positions filled in
  Eigen::VectorXd root_mean_squares;        ///< of what the sensors of the continuum show (p) [their units]
  std::optional<RecordInputs> inputs = {};  ///< of measured forces, between their samples
  double begin = 0.0;                       ///< of the record, after the excitation's start [s]
};

/// The unknowns are what the beam described has of them, or their guesses where it has no such thing. The
/// motion starts at rest under measured forces; where the first excitation says how it starts, or nothing is
/// measured, it is the one of the model nearest to that of the continuum over a few periods of its first
/// mode, under the forces that are measured.
/// @throws InputError, std::invalid_argument as model_setting(), simulate(), excite() and the models.
DescribedMotion described_motion(const Experiment& experiment, const std::filesystem::path& folder,
                                 const TestView& view, const Progress& progress);

}  // namespace beamid::experiments
