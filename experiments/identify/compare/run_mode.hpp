// The modes of a record in a model at its estimate.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"

namespace beamid::experiments {

/// Of the oscillations of the equations of motion at a state that the measured inputs reach and the sensors
/// see: of a tower shaken along x not its mode along y.
struct RecordedModes {
  FoundMode lowest;
  /// The one that the record shows: among the lowest and those as strong in it, by reach and sight, as a
  /// tenth of the strongest, the nearest to the frequency found in the record. Deviations are known of this
  /// one.
  FoundMode shown;
};

/// Absent: nothing oscillates, or the motion is not linear.
/// @param unknowns their estimate and covariance as the state carries them (q): deviations to first order
/// @param record_hz of the mode found in the record [Hz]; absent: the lowest is shown
std::optional<RecordedModes> recorded_modes(const JointModel& model, const Eigen::VectorXd& state,
                                            const filters::Gaussian& unknowns,
                                            std::optional<double> record_hz);

/// Rates of the oscillations of a free motion from this state of which the sensors see a fiftieth of what
/// they see of the strongest, at least [rad/s]; none where the motion is not linear.
std::vector<std::complex<double>> seen_rates(const JointModel& model, const Eigen::VectorXd& state);

}  // namespace beamid::experiments
