#include "fem/section.hpp"

namespace beamid::fem {

bool Section::is_uniform() const {
  return bending_stiffness.is_constant() && mass_per_length.is_constant() && rotary_inertia.is_constant() &&
         (!shear_stiffness || shear_stiffness->is_constant()) &&
         (!axial_stiffness || axial_stiffness->is_constant());
}

}  // namespace beamid::fem
