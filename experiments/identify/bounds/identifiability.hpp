// What a test can tell about a beam, before it is made.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/bounds/parameter_bounds.hpp"
#include "experiments/identify/record_inputs.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

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
