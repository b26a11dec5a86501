#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {

SpringVector spring_parameters(const SpringLaw& law, double stiffness) {
  const std::vector<SpringParameter> others = law.parameters();
  SpringVector values(static_cast<Eigen::Index>(others.size()) + 1);
  values[0] = stiffness;
  for (std::size_t i = 0; i < others.size(); ++i) values[static_cast<Eigen::Index>(i) + 1] = others[i].value;
  return values;
}

SpringLawRegistry& spring_law_registry() {
  static SpringLawRegistry registry("spring law");
  return registry;
}

}  // namespace beamid::experiments
