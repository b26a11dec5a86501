#include "experiments/joint_model.hpp"

namespace beamid::experiments {

ModelRegistry& model_registry() {
  static ModelRegistry registry("model");
  return registry;
}

}  // namespace beamid::experiments
