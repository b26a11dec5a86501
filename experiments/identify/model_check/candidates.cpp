#include "experiments/identify/model_check/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
    if (support.position == 0) support.*held = compliance == 0;
  std::erase_if(beam.supports, [](const fem::Support& s) { return !s.deflection && !s.rotation; });
  for (fem::Spring& one : beam.springs)
    if (one.position == 0) one.*spring = 0;
  if (compliance > 0) {
    fem::Spring root{0};
    root.*spring = 1 / compliance;
    beam.springs.push_back(root);
  } else if (root_compliance(beam, held, spring) != 0) {
    fem::Support support{0, false, false};
    support.*held = true;
    beam.supports.push_back(support);
  }
  return beam;
}

Candidate at_root(const Beam& beam, const char* name, bool fem::Support::*held, double fem::Spring::*spring,
                  double plausible) {
  const bool turns = spring == &fem::Spring::rotational;
  const double now = root_compliance(beam, held, spring);
  Candidate c{name, turns ? "rad/(N m)" : "m/N", turns ? "N m/rad" : "N/m", plausible};
  c.lower = -now, c.upper = 100 * plausible;
  c.plausible_lower = -now, c.plausible_upper = plausible;
  c.changed = [=](const Beam& b, double x) {
    return x == 0 ? b : with_root(b, held, spring, std::max(0.0, root_compliance(b, held, spring) + x));
  };
  c.value = [=](const Beam& b, double x) { return 1 / (root_compliance(b, held, spring) + x); };
  return c;
}

bool free_tip(const Beam& beam) {
  return std::none_of(beam.supports.begin(), beam.supports.end(),
                      [&](const fem::Support& s) { return s.position == beam.length() && s.deflection; }) &&
         fem::natural_point(beam).position == beam.length();
}

std::vector<Candidate> of_one(const Beam& beam) {
  const double length = beam.length(), stiffness = bending_stiffness(beam), tip = beam.tip_mass();
  std::vector<Candidate> all;
  const auto add = [&](Candidate c, double possible_lower, double possible_upper, double plausible) {
    c.scale = plausible, c.lower = possible_lower, c.upper = possible_upper;
    c.plausible_lower = std::max(-plausible, possible_lower), c.plausible_upper = plausible;
    all.push_back(std::move(c));
    return &all.back();
  };
  Candidate* c = add({"bending_stiffness", "%", "N m2"}, -0.9, 9, 0.15);
  c->changed = [](const Beam& b, double x) {
    return fem::with_value(b, {fem::BeamParameter::Quantity::bending_stiffness, {}},
                           (1 + x) * bending_stiffness(b));
  };
  c->value = [](const Beam& b, double x) { return (1 + x) * bending_stiffness(b); };
  c = add({"beam_mass", "%", "kg"}, -0.9, 9, 0.05);
  c->changed = [](const Beam& b, double x) { return with_beam_mass(b, 1 + x); };
  c->value = [](const Beam& b, double x) { return (1 + x) * b.mass(); };
  c = add({"free_length", "m", "m"}, -0.5 * length, length, 0.05 * length);
  c->exchangeable = true;
  c->changed = with_length;
  c->value = [](const Beam& b, double x) { return b.length() + x; };
  constexpr auto own = [](const Beam& b) {  // a sensor beside it keeps its mass
    return fem::value_of(b, {fem::BeamParameter::Quantity::tip_mass, {}});
  };
  if (free_tip(beam)) {
    c = add({"tip_mass", "kg", "kg"}, -own(beam), 10 * (tip + beam.mass()),
            std::max(0.2 * tip, 0.05 * beam.mass()));
    c->exchangeable = true;
    c->changed = [own](const Beam& b, double x) {
      return x == 0 ? b
                    : fem::with_value(b, {fem::BeamParameter::Quantity::tip_mass, {}},
                                      std::max(0.0, own(b) + x));
    };
    c->value = [own](const Beam& b, double x) { return own(b) + x; };
  }
  if (free_tip(beam) && tip > 0) {
    c = add({"tip_rotary_inertia", "m2", "kg m2"}, -tip_inertia(beam) / tip, length * length,
            0.01 * length * length);
    c->changed = [](const Beam& b, double x) {
      return with_tip(
          b, [&](Body& body) { body.rotary_inertia = std::max(0.0, body.rotary_inertia + x * body.mass); });
    };
    c->value = [](const Beam& b, double x) { return tip_inertia(b) + x * b.tip_mass(); };
    c = add({"tip_offset", "m", "m"}, -0.3 * length, 0.5 * length, 0.05 * length);
    c->changed = [](const Beam& b, double x) {
      return with_tip(b, [&](Body& body) { body.eccentricity += x; });
    };
    c->value = [](const Beam& b, double x) {
      double moment = 0;
      for (const Body& body : b.bodies)
        if (body.position == b.length()) moment += body.mass * body.eccentricity;
      return moment / b.tip_mass() + x;
    };
  }
  if (std::isfinite(root_compliance(beam, &fem::Support::rotation, &fem::Spring::rotational)))
    all.push_back(at_root(beam, "root_rotational_compliance", &fem::Support::rotation,
                          &fem::Spring::rotational, 0.1 * length / stiffness));
  if (std::isfinite(root_compliance(beam, &fem::Support::deflection, &fem::Spring::translational)))
    all.push_back(at_root(beam, "root_translational_compliance", &fem::Support::deflection,
                          &fem::Spring::translational, 0.02 * std::pow(length, 3) / (3 * stiffness)));
  return all;
}

}  // namespace

const std::vector<std::string>& candidate_names() {
  static const std::vector<std::string> names{"bending_stiffness",
                                              "beam_mass",
                                              "free_length",
                                              "tip_mass",
                                              "tip_rotary_inertia",
                                              "tip_offset",
                                              "root_rotational_compliance",
                                              "root_translational_compliance"};
  return names;
}

std::vector<Candidate> candidates_of(const std::vector<Beam>& beams) {
  if (beams.empty()) throw std::invalid_argument("no beam; expected one at least");
  std::vector<Candidate> shared = of_one(beams.front());
  for (std::size_t b = 1; b < beams.size(); ++b) {
    const std::vector<Candidate> others = of_one(beams[b]);
    std::erase_if(shared, [&](Candidate& mine) {
      for (const Candidate& other : others) {
        if (other.name != mine.name) continue;
        mine.scale = std::min(mine.scale, other.scale);
        mine.lower = std::max(mine.lower, other.lower), mine.upper = std::min(mine.upper, other.upper);
        mine.plausible_lower = std::max(mine.plausible_lower, other.plausible_lower);
        mine.plausible_upper = std::min(mine.plausible_upper, other.plausible_upper);
        return false;
      }
      return true;
    });
  }
  return shared;
}

}  // namespace beamid::experiments
