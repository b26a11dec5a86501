// What to measure next so that one set of parameters is left.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/updating.hpp"

namespace beamid::experiments {

/// One further measurement, and how far apart the sets' predictions of it are.
struct DecidingMeasurement {
  enum class Kind {
    shape_ratio,  ///< motion at one place over that at another, in one mode: a second sensor
    frequency,    ///< of a mode that was not measured
    added_mass,   ///< the frequencies measured again with a known mass at a place
    parameter     ///< the quantity itself: a floor weighed
  };
  Kind kind = Kind::shape_ratio;
  int mode = 0;                            ///< from 1; added_mass: that which moves most apart
  std::string place = {}, reference = {};  ///< shape_ratio: of the second sensor and of the first
  double mass = 0;                         ///< added_mass [kg]
  std::string parameter = {};
  std::vector<double> predicted = {};  ///< by each set: ratio, [Hz], [Hz], [SI]
  /// Of any two sets the smallest distance of their predictions, in standard deviations.
  double separation = 0;
};
const char* to_string(DecidingMeasurement::Kind kind);

/// The best of each kind, largest separation first; none where there are fewer than two sets.
/// @param sets values (q) of those to be told apart
/// @param trust what a frequency and a component of a shape are measured and predicted to
std::vector<DecidingMeasurement> deciding_measurements(const ModalModel& model, const ModalData& data,
                                                       const std::vector<Eigen::VectorXd>& sets,
                                                       const ModelTrust& trust);

}  // namespace beamid::experiments
