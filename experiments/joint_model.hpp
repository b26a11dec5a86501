// The bridge between beams and filters: motion and unknown parameters in one state.
#pragma once

#include <memory>
#include <vector>

#include "experiments/record.hpp"
#include "fem/structural_system.hpp"
#include "filters/continuous_model.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// State [z, z', theta] of a reduced system with unknown parameters theta, of which K and C come first.
struct JointModel {
  std::shared_ptr<const filters::LinearMotion> motion;
  double equivalent_mass = 0.0;  ///< at the output [kg]
};

/// Made from a (reduced) system and the quantities its record holds, in the record's order.
using ModelRegistry =
    filters::Registry<JointModel, const fem::StructuralSystem&, const std::vector<Quantity>&>;
ModelRegistry& model_registry();

}  // namespace beamid::experiments
