#include "experiments/models/finest_discretisation.hpp"

#include "experiments/models/banded/continuum_motion.hpp"
#include "experiments/models/motion/storey_motion.hpp"

namespace beamid::experiments {

bool is_whole_mesh(const JointModel& model) {
  return dynamic_cast<const ContinuumMotion*>(model.motion.get()) != nullptr;
}

bool is_nonlinear(const JointModel& model) {
  return !is_whole_mesh(model) && dynamic_cast<const filters::LinearMotion*>(model.motion.get()) == nullptr;
}

bool has_storey_laws(const JointModel& model) {
  return dynamic_cast<const StoreyMotion*>(model.motion.get()) != nullptr;
}

std::string finest_discretisation(const JointModel& model, double interval) {
  // The classical Runge-Kutta step is (omega dt)^4 / 120 of the frequency off: 1.3e-5 there.
  constexpr double largest_step = 0.2;  // [rad]
  if (has_storey_laws(model)) return "runge_kutta_4";
  if (is_nonlinear(model))
    return model.mode_frequencies[0] * interval < largest_step ? "runge_kutta_4" : "cvode";
  return is_whole_mesh(model) ? "pade" : "exponential";
}

}  // namespace beamid::experiments
