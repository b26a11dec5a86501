// Studies: experiments that need no input, found by name like every other method.
#pragma once

#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// One study, ready to run with its options.
class Study {
 public:
  virtual ~Study() = default;
  virtual Results run(const Progress& progress) const = 0;
};

using StudyRegistry = filters::Registry<Study>;
inline StudyRegistry& study_registry() {
  static StudyRegistry registry("study");
  return registry;
}

}  // namespace beamid::experiments
