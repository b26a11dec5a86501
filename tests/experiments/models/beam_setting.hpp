// A steel cantilever of the paper as an identification setting: sensors, forces, parameters.
#pragma once

#include "experiments/models/joint_model.hpp"
#include "experiments/models/structure_points.hpp"
#include "fem/parametric_system.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::test {

using experiments::Quantity;

/// What a sensor measures and where [m].
struct SensorAt {
  Quantity quantity = Quantity::acceleration;
  double position = 1.10;
};

inline constexpr double surface = 0.003;  // half the height of the section [m]

/// @param forces where they act [m]
experiments::ModelSetting beam_setting(const fem::Beam& beam, int elements,
                                       const std::vector<SensorAt>& sensors,
                                       const std::vector<double>& forces = {});

experiments::ParameterChoice parameter(const std::string& quantity);

experiments::ParameterChoice in_region(double from, double to);

experiments::ParameterChoice of_mode(const std::string& quantity, int mode);

void reduce_by(experiments::ModelSetting& setting, const std::string& name,
               const filters::Options& options = {});

}  // namespace beamid::test
