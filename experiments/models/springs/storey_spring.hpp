// A storey of a chain whose spring follows a law, as an experiment describes it.
#pragma once

#include "experiments/text/choice.hpp"

namespace beamid::experiments {

/// A storey whose spring follows a law that is not linear.
struct StoreySpring {
  int storey = 1;  ///< from the lowest up
  Choice law;      ///< of spring_law_registry()
};

}  // namespace beamid::experiments
