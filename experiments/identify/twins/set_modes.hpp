// What a set of parameters predicts where nothing was measured.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/update/modal_model.hpp"

namespace beamid::experiments {

/// Modes with their deflections at places where a sensor could sit.
struct SetModes {
  Eigen::VectorXd frequency_hz;           ///< (k)
  std::vector<std::string> places;        ///< "1.2 m", "ridge.x" (p), about ten of them, evenly spread
  std::vector<Eigen::Index> coordinates;  ///< of the system, deflections there (p)
  Eigen::MatrixXd shapes;                 ///< (p x k) [m]
};

/// @param model small; @param count of the lowest modes; fewer where there are fewer
SetModes set_modes(const ModalModel& model, const Eigen::VectorXd& values, std::size_t count);

/// The mass that moves when everything is displaced alike [kg].
double translated_mass(const ModalModel& model, const Eigen::VectorXd& values);

/// All frequencies [Hz] with a mass [kg] added to one coordinate.
Eigen::VectorXd frequencies_with_mass(const ModalModel& model, const Eigen::VectorXd& values,
                                      Eigen::Index coordinate, double mass);

}  // namespace beamid::experiments
