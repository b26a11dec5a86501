// The virtual test rig: a beam, an excitation, sensors.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/rig/virtual_rig.hpp"
#include "experiments/text/progress.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {

/// A simulated test: the motion of the beam and the record of it.
struct SimulatedTest {
  fem::StructuralSystem system;
  fem::Response response;       ///< at every step; fields at the frames
  std::vector<Sensor> sensors;  ///< names and positions filled in
  Record record;                ///< what the sensors show, noise and defects included; behind them the force
  Acquisition acquisition;      ///< what was done to them
  std::vector<Excitation> excitations;  ///< positions filled in; the first one says how the motion starts
  fem::ResponseMethod method;           ///< its number of modes filled in
  double step = 0.0;                    ///< of the integration [s]
  double event = 0.0;                   ///< when the excitation begins, on the record's clock [s]
  std::vector<std::string> notes;       ///< what a reader should know, a sentence each
};

/// The motion of the whole structure at many samples: what a page plays.
struct WholeMotion {
  Eigen::VectorXd time;          ///< (samples) [s], on the record's clock
  Eigen::MatrixXd displacement;  ///< q (n x samples), relative to the base where that moves
};

/// @param folder in which the excitation's file is looked for.
/// @param frames pictures of the whole beam to keep.
/// @param acquisition what sensors and logger do to the readings; nothing unless given. Between the steps of
/// the integration readings run along a cubic spline: with a jitter it takes at least eight steps per sample.
/// @param motion receives the whole motion from the beginning on: every sample, or every second, ... eighth,
/// at most 4000 of them and 4 000 000 numbers; of a structure without a mesh none.
/// @throws InputError as excite(); std::invalid_argument when the method cannot treat the beam or its
/// damping.
SimulatedTest simulate(const Experiment& experiment, const std::filesystem::path& folder, int frames,
                       const Progress& progress, const Acquisition& acquisition = {},
                       WholeMotion* motion = nullptr);

}  // namespace beamid::experiments
