// Structures whose whole mesh moves as bands or sparse and, as the oracle, as dense matrices.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/motion/parametric_motion.hpp"
#include "fem/beam.hpp"
#include "fem/parametric_system.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

inline constexpr double banded_interval = 1e-3;

fem::Beam banded_beam();

struct BandedCase {
  std::string name;
  fem::ParametricSystem equations;
  MotionDescription description;
};

/// Beams that reach every branch: tip body, springs, dashpots, axial load, absorber, shear, regions.
std::vector<BandedCase> banded_cases();
/// Structures that are no bands: a plane frame, a space frame, matrices whose masses, stiffness and damping
/// are unknown, of few coordinates and of many.
std::vector<BandedCase> sparse_cases();
std::vector<BandedCase> all_cases();  ///< both

/// A state with nothing zero, unknowns near their guess.
Eigen::VectorXd banded_state(const BandedCase& given, unsigned seed);

/// Sensors of 0.1 mm, 10 mm/s, 0.5 m/s2.
filters::Noise quiet_sensors(const BandedCase& given);

std::pair<std::unique_ptr<filters::DiscreteModel>, std::unique_ptr<filters::DiscreteModel>> banded_and_dense(
    const BandedCase& given);

}  // namespace beamid::experiments
