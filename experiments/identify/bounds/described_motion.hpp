// The test that an experiment describes, as a motion of its model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/bounds/channel_information.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

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
