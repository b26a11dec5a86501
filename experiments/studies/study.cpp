#include "experiments/studies/study.hpp"

namespace beamid::experiments {

StudyRegistry& study_registry() {
  static StudyRegistry registry("study");
  return registry;
}

}  // namespace beamid::experiments
