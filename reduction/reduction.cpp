#include "reduction/reduction.hpp"

namespace beamid::reduction {

ReductionRegistry& reduction_registry() {
  static ReductionRegistry registry("reduction");
  return registry;
}

ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction,
                    const Training& training) {
  return project(system, reduction.bases(system, training));
}

}  // namespace beamid::reduction
