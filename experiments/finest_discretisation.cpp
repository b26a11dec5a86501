#include "experiments/finest_discretisation.hpp"

namespace beamid::experiments {

bool is_whole_mesh(const JointModel& model) {
  return dynamic_cast<const filters::LinearMotion*>(model.motion.get()) == nullptr;
}

std::string finest_discretisation(const JointModel& model) {
  return is_whole_mesh(model) ? "pade" : "exponential";
}

}  // namespace beamid::experiments
