// The classical Runge-Kutta step of a chain with laws, in as many parts as its fastest mode asks for.
#pragma once

#include <memory>
#include <string>

#include "experiments/models/motion/storey_motion.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

/// The scheme `runge_kutta_4` in equal parts of the interval in which the fastest mode at the guess turns by
/// 0.15 rad at most, so that a part is 4e-6 of its frequency off: few samples per period of a high mode do
/// not blur it. The equations are evaluated once for all parts, tangents are those of the parts, exact, and
/// only what moves is moved. Null for other schemes.
std::unique_ptr<filters::DiscreteModel> storey_step(std::shared_ptr<const StoreyMotion> motion, double dt,
                                                    const std::string& scheme, const filters::Noise& noise);

}  // namespace beamid::experiments
