// The continuum in steps of the scheme `pade`, as filters take it.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "experiments/models/banded/continuum_motion.hpp"
#include "experiments/models/banded/continuum_sensors.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

struct ContinuumMotion::Parts {
  fem::ParametricSystem system;
  MotionDescription description;
  std::string name;
  StateLayout layout;
  banded::BandedEquations equations;
  banded::ContinuumSensors sensors;

  Parts(fem::ParametricSystem given, MotionDescription meant, std::string called)
      : system(std::move(given)),
        description(std::move(meant)),
        name(std::move(called)),
        layout(experiments::layout(description, system.system.size())),
        equations(system, description),
        sensors(system, description, layout) {}
};

std::unique_ptr<filters::DiscreteModel> continuum_step(std::shared_ptr<const ContinuumMotion::Parts> parts,
                                                       double dt, const filters::Noise& noise);

}  // namespace beamid::experiments
