// What may be wrong in the description of a beam.
#include <algorithm>
#include <cmath>

#include "experiments/identify/model_check/candidates.hpp"
#include "fem/assembly.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments {
namespace {

using fem::Beam, fem::Body;

double bending_stiffness(const Beam& beam) {
  return fem::value_of(beam, {fem::BeamParameter::Quantity::bending_stiffness, {}});
}

Beam with_beam_mass(Beam beam, double factor) {
  for (fem::Segment& segment : beam.segments) {
    segment.section.mass_per_length = fem::Variation(factor) * segment.section.mass_per_length;
    segment.section.rotary_inertia = fem::Variation(factor) * segment.section.rotary_inertia;
  }
  for (fem::AddedMass& added : beam.added_masses) added.mass_per_length *= factor;
  return beam;
}

/// What is at the tip stays there to the last bit.
Beam with_length(Beam beam, double change) {
  const double before = beam.length(), factor = 1 + change / before;
  for (fem::Segment& segment : beam.segments) segment.length *= factor;
  const double after = beam.length();
  const auto move = [&](double& place) { place = place == before ? after : place * factor; };
  const auto move_all = [&](auto& things) {
    for (auto& thing : things) move(thing.position);
  };
  move_all(beam.bodies), move_all(beam.supports), move_all(beam.springs), move_all(beam.dashpots);
  move_all(beam.absorbers);
  for (auto& added : beam.added_masses) move(added.from), move(added.to);
  for (auto& damage : beam.damages) move(damage.from), move(damage.to);
  return beam;
}

/// f(body) for all bodies at the tip.
template <class Function>
Beam with_tip(Beam beam, const Function& f) {
  const double length = beam.length();
  for (Body& body : beam.bodies)
    if (body.position == length) f(body);
  return beam;
}

double tip_inertia(const Beam& beam) {
  return fem::value_of(beam, {fem::BeamParameter::Quantity::tip_rotary_inertia, {}});
}

/// Compliance of the root: 0 where a support holds it, infinite where nothing does.
double root_compliance(const Beam& beam, bool fem::Support::*held, double fem::Spring::*spring) {
  for (const fem::Support& support : beam.supports)
    if (support.position == 0 && support.*held) return 0;
  double stiffness = 0;
  for (const fem::Spring& one : beam.springs)
    if (one.position == 0) stiffness += one.*spring;
  return 1 / stiffness;
}

Beam with_root(Beam beam, bool fem::Support::*held, double fem::Spring::*spring, double compliance) {
  for (fem::Support& support : beam.supports)
    if (support.position == 0) support.*held = false;
  std::erase_if(beam.supports, [](const fem::Support& s) { return !s.deflection && !s.rotation; });
  for (fem::Spring& one : beam.springs)
    if (one.position == 0) one.*spring = 0;
  fem::Spring root{0};
  root.*spring = 1 / compliance;
  beam.springs.push_back(root);
  return beam;
}

// An ideal clamp gives so little, of what is plausible: it has the coordinates of one that is not ideal.
constexpr double ideal = 1e-6;

std::function<fem::Structure(const fem::Structure&, double)> change_of_beam(
    std::function<Beam(const Beam&, double)> changed) {
  return [=](const fem::Structure& s, double x) { return fem::Structure(changed(s.beam(), x)); };
}

std::function<double(const fem::Structure&, double)> value_on_beam(
    std::function<double(const Beam&, double)> value) {
  return [=](const fem::Structure& s, double x) { return value(s.beam(), x); };
}

/// Possible from, to; plausible either way as far as it is possible.
Candidate beam_cause(const char* name, const char* unit, const char* value_unit, double lower, double upper,
                     double plausible) {
  Candidate c{name, name, unit, value_unit, lower, upper, std::max(-plausible, lower), plausible};
  std::replace(c.label.begin(), c.label.end(), '_', ' ');
  return c;
}

Candidate at_root(const Beam& beam, const char* name, bool fem::Support::*held, double fem::Spring::*spring,
                  double plausible) {
  const bool turns = spring == &fem::Spring::rotational;
  const double now = root_compliance(beam, held, spring);
  Candidate c = beam_cause(name, turns ? "rad/(N m)" : "m/N", turns ? "N m/rad" : "N/m", -now,
                           100 * plausible, plausible);
  c.plausible_lower = -now;
  c.changed = change_of_beam([=](const Beam& b, double x) {
    return with_root(b, held, spring,
                     std::max(0.0, root_compliance(b, held, spring) + x) + ideal * plausible);
  });
  c.value =
      value_on_beam([=](const Beam& b, double x) { return 1 / (root_compliance(b, held, spring) + x); });
  return c;
}

bool free_tip(const Beam& beam) {
  return std::none_of(beam.supports.begin(), beam.supports.end(),
                      [&](const fem::Support& s) { return s.position == beam.length() && s.deflection; }) &&
         fem::natural_point(beam).position == beam.length();
}

}  // namespace

std::vector<Candidate> beam_candidates(const Beam& beam) {
  const double length = beam.length(), stiffness = bending_stiffness(beam), tip = beam.tip_mass();
  std::vector<Candidate> all;
  const auto add = [&](Candidate c, const std::function<Beam(const Beam&, double)>& changed,
                       const std::function<double(const Beam&, double)>& value) {
    c.changed = change_of_beam(changed), c.value = value_on_beam(value);
    all.push_back(std::move(c));
  };
  add(
      beam_cause("bending_stiffness", "%", "N m2", -0.9, 9, 0.15),
      [](const Beam& b, double x) {
        return fem::with_value(b, {fem::BeamParameter::Quantity::bending_stiffness, {}},
                               (1 + x) * bending_stiffness(b));
      },
      [](const Beam& b, double x) { return (1 + x) * bending_stiffness(b); });
  add(
      beam_cause("beam_mass", "%", "kg", -0.9, 9, 0.05),
      [](const Beam& b, double x) { return with_beam_mass(b, 1 + x); },
      [](const Beam& b, double x) { return (1 + x) * b.mass(); });
  all.back().weighs_all = true;
  add(beam_cause("free_length", "m", "m", -0.5 * length, length, 0.05 * length), with_length,
      [](const Beam& b, double x) { return b.length() + x; });
  all.back().exchangeable = true;
  constexpr auto own = [](const Beam& b) {  // a sensor beside it keeps its mass
    return fem::value_of(b, {fem::BeamParameter::Quantity::tip_mass, {}});
  };
  if (free_tip(beam)) {
    add(
        beam_cause("tip_mass", "kg", "kg", -own(beam), 10 * (tip + beam.mass()),
                   std::max(0.2 * tip, 0.05 * beam.mass())),
        [own](const Beam& b, double x) {
          return x == 0 ? b
                        : fem::with_value(b, {fem::BeamParameter::Quantity::tip_mass, {}},
                                          std::max(0.0, own(b) + x));
        },
        [own](const Beam& b, double x) { return own(b) + x; });
    all.back().exchangeable = true;
  }
  if (free_tip(beam) && tip > 0) {
    add(
        beam_cause("tip_rotary_inertia", "m2", "kg m2", -tip_inertia(beam) / tip, length * length,
                   0.01 * length * length),
        [](const Beam& b, double x) {
          return with_tip(b, [&](Body& body) {
            body.rotary_inertia = std::max(0.0, body.rotary_inertia + x * body.mass);
          });
        },
        [](const Beam& b, double x) { return tip_inertia(b) + x * b.tip_mass(); });
    add(
        beam_cause("tip_offset", "m", "m", -0.3 * length, 0.5 * length, 0.05 * length),
        [](const Beam& b, double x) { return with_tip(b, [&](Body& body) { body.eccentricity += x; }); },
        [](const Beam& b, double x) {
          double moment = 0;
          for (const Body& body : b.bodies)
            if (body.position == b.length()) moment += body.mass * body.eccentricity;
          return moment / b.tip_mass() + x;
        });
  }
  if (std::isfinite(root_compliance(beam, &fem::Support::rotation, &fem::Spring::rotational)))
    all.push_back(at_root(beam, "root_rotational_compliance", &fem::Support::rotation,
                          &fem::Spring::rotational, 0.1 * length / stiffness));
  if (std::isfinite(root_compliance(beam, &fem::Support::deflection, &fem::Spring::translational)))
    all.push_back(at_root(beam, "root_translational_compliance", &fem::Support::deflection,
                          &fem::Spring::translational, 0.02 * std::pow(length, 3) / (3 * stiffness)));
  return all;
}

}  // namespace beamid::experiments
