#include "fem/beam.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

void require(bool valid, const char* name, double value, const char* expected) {
  if (valid && std::isfinite(value)) return;
  std::ostringstream message;
  message << name << " is " << value << "; expected " << expected;
  throw std::invalid_argument(message.str());
}

}  // namespace

void validate(const Beam& beam) {
  require(beam.length > 0.0, "length", beam.length, "a positive number of metres");
  require(beam.bending_stiffness > 0.0, "bending stiffness", beam.bending_stiffness,
          "a positive number of N m2");
  require(beam.mass_per_length > 0.0, "mass per length", beam.mass_per_length, "a positive number of kg/m");
  require(beam.tip_mass >= 0.0, "tip mass", beam.tip_mass, "zero or a positive number of kg");
  require(beam.tip_rotary_inertia >= 0.0, "tip rotary inertia", beam.tip_rotary_inertia,
          "zero or a positive number of kg m2");
}

}  // namespace beamid::fem
