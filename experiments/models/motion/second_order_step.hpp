// One step of small linear motion with its exact tangent, at the cost of the motion alone.
#pragma once

#include <memory>
#include <string>

#include "experiments/models/motion/second_order_motion.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {

/// The schemes `exponential` and `pade`, the same numbers as theirs but for rounding; null for others.
///
/// Offsets are carried exactly, b+ = b + d dt. Coordinates that stay oscillators of their own take
/// `exponential` in closed form; otherwise the motion takes the Pade approximants of rational_step.hpp.
std::unique_ptr<filters::DiscreteModel> second_order_step(std::shared_ptr<const SecondOrderMotion> motion,
                                                          double dt, const std::string& scheme,
                                                          const filters::Noise& noise);

}  // namespace beamid::experiments
