#include "fem/beam.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace beamid::fem {
namespace {

/// A phrase of a message in two parts, put together only where there is one: beams are checked at every set
/// of parameters that a search tries.
struct Phrase {
  std::string_view first, second;
  Phrase(const char* words) : first(words) {}
  Phrase(std::string_view one, std::string_view other) : first(one), second(other) {}
};

void require(bool valid, const Phrase& name, double value, const Phrase& expected) {
  if (valid && std::isfinite(value)) return;
  std::ostringstream message;
  message << name.first << name.second << " is " << value << "; expected " << expected.first
          << expected.second;
  throw std::invalid_argument(message.str());
}

// A section's end may vanish (a sharp tip), to rounding, and nothing may be negative in between.
void validate(const Section& section, const std::string& where) {
  const auto positive = [&](const Variation& quantity, const char* name, const char* unit) {
    const double rounding = 1e-12 * std::abs(quantity(0.5));
    if (quantity.is_constant())
      return require(quantity(0.5) > 0.0, {where, name}, quantity(0.5), {"a positive number of ", unit});
    for (const double s : {0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0})
      require(s == 0.0 || s == 1.0 ? quantity(s) >= -rounding : quantity(s) > 0.0, {where, name}, quantity(s),
              {"a positive number of ", unit});
  };
  positive(section.bending_stiffness, "bending stiffness", "N m2");
  positive(section.mass_per_length, "mass per length", "kg/m");
  if (section.shear_stiffness) positive(*section.shear_stiffness, "shear stiffness", "N");
  if (section.axial_stiffness) positive(*section.axial_stiffness, "axial stiffness", "N");
  for (const double s : {0.0, 0.5, 1.0})
    require(section.rotary_inertia(s) >= -1e-12 * std::abs(section.rotary_inertia(0.5)),
            {where, "rotary inertia"}, section.rotary_inertia(s), "zero or a positive number of kg m");
}

}  // namespace

double Beam::length() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length;
  return sum;
}

double Beam::mass() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length * segment.section.mass_per_length.mean();
  for (const AddedMass& added : added_masses) sum += (added.to - added.from) * added.mass_per_length;
  return sum;
}

double Beam::tip_mass() const {
  double sum = 0.0;
  for (const Body& body : bodies)
    if (body.position == length()) sum += body.mass;
  return sum;
}

void validate(const Beam& beam) {
  if (beam.segments.empty()) throw std::invalid_argument("the beam has no segment; expected at least one");
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const std::string where = beam.segments.size() == 1 ? "" : "segment " + std::to_string(i + 1) + ": ";
    require(beam.segments[i].length > 0.0, {where, "length"}, beam.segments[i].length,
            "a positive number of metres");
    validate(beam.segments[i].section, where);
  }
  const double length = beam.length();
  const auto on_beam = [&](double x, const char* what) {
    if (x >= 0.0 && x <= length) return;
    std::ostringstream span;
    span << "between 0 and the beam's length, " << length << " m";
    require(false, what, x, span.str().c_str());
  };
  // The deflection there under a force, the integral of x^2 / EI, has no bound.
  const bool sharp_root = beam.segments.front().section.bending_stiffness(0.0) <= 0.0,
             sharp_tip = beam.segments.back().section.bending_stiffness(1.0) <= 0.0;
  const auto carried = [&](double x, const char* what) {
    on_beam(x, what);
    require(!(sharp_root && x == 0.0) && !(sharp_tip && x == length), what, x,
            "a place off the sharp end, which can carry nothing");
  };
  const auto stretch = [&](double from, double to, const char* what) {
    on_beam(from, what), on_beam(to, what);
    require(from < to, what, from, "a begin before its end");
  };
  for (const Body& body : beam.bodies) {
    const char* const name = body.position == length ? "tip" : "body";
    carried(body.position, "position of a body");
    require(body.mass >= 0.0, {name, " mass"}, body.mass, "zero or a positive number of kg");
    require(body.rotary_inertia >= 0.0, {name, " rotary inertia"}, body.rotary_inertia,
            "zero or a positive number of kg m2");
    require(true, {name, " eccentricity"}, body.eccentricity, "a finite number of metres");
  }
  for (const AddedMass& added : beam.added_masses) {
    stretch(added.from, added.to, "added mass");
    require(added.mass_per_length >= 0.0, "added mass per length", added.mass_per_length,
            "zero or a positive number of kg/m");
  }
  for (const Damage& damage : beam.damages) {
    stretch(damage.from, damage.to, "damage");
    require(damage.loss >= 0.0 && damage.loss < 1.0, "loss of stiffness", damage.loss,
            "a number from 0 to below 1");
  }
  for (const Support& support : beam.supports) on_beam(support.position, "position of a support");
  for (const Spring& spring : beam.springs) {
    carried(spring.position, "position of a spring");
    require(spring.translational >= 0.0, "spring stiffness", spring.translational,
            "zero or a positive number of N/m");
    require(spring.rotational >= 0.0, "rotational spring stiffness", spring.rotational,
            "zero or a positive number of N m/rad");
    require(true, "cubic spring stiffness", spring.cubic, "a finite number of N/m3");
  }
  for (const Dashpot& dashpot : beam.dashpots) {
    carried(dashpot.position, "position of a dashpot");
    require(dashpot.translational >= 0.0, "dashpot", dashpot.translational,
            "zero or a positive number of N s/m");
    require(dashpot.rotational >= 0.0, "rotational dashpot", dashpot.rotational,
            "zero or a positive number of N m s/rad");
    require(dashpot.quadratic >= 0.0, "quadratic dashpot", dashpot.quadratic,
            "zero or a positive number of N s2/m2");
  }
  for (const Absorber& absorber : beam.absorbers) {
    carried(absorber.position, "position of an absorber");
    require(absorber.mass > 0.0, "absorber mass", absorber.mass, "a positive number of kg");
    require(absorber.stiffness > 0.0, "absorber stiffness", absorber.stiffness, "a positive number of N/m");
    require(absorber.damping >= 0.0, "absorber damping", absorber.damping,
            "zero or a positive number of N s/m");
  }
  require(true, "axial load", beam.axial_load, "a finite number of N");
}

}  // namespace beamid::fem
