// What may be wrong in the description of a chain of storeys, and of a system of matrices.
#include <fmt/format.h>

#include <cmath>

#include "experiments/identify/model_check/candidates.hpp"
#include "fem/shear_building.hpp"

namespace beamid::experiments {
namespace {

using fem::Beam, fem::MatrixSystem, fem::Structure;

constexpr std::size_t most_single_floors = 20;

/// A relative change of what `f(chain, factor)` changes.
template <class Function>
Candidate chain_cause(const std::string& name, double plausible, const Function& f) {
  return relative_candidate(name, plausible, [f](const Structure& structure, double factor) {
    Beam chain = structure.beam();
    f(chain, factor);
    return Structure(std::move(chain));
  });
}

template <class Function>
Candidate system_cause(const std::string& name, double plausible, const Function& f) {
  return relative_candidate(name, plausible, [f](const Structure& structure, double factor) {
    MatrixSystem system = *structure.matrices();
    f(system, factor);
    return Structure(std::move(system));
  });
}

}  // namespace

std::vector<Candidate> chain_candidates(const Beam& chain) {
  std::vector<Candidate> all;
  const auto stiffen = [](fem::Segment& storey, double factor) {
    storey.section.bending_stiffness = fem::Variation(factor) * storey.section.bending_stiffness;
  };
  const bool single = chain.segments.size() == 1, many = chain.segments.size() > most_single_floors;
  all.push_back(chain_cause("storey_stiffness", 0.15, [stiffen](Beam& changed, double factor) {
    for (fem::Segment& storey : changed.segments) stiffen(storey, factor);
  }));
  for (std::size_t i = 0; !single && !many && i < chain.segments.size(); ++i) {
    all.push_back(
        chain_cause(fmt::format("storey_stiffness_{}", i + 1), 0.3,
                    [stiffen, i](Beam& changed, double factor) { stiffen(changed.segments[i], factor); }));
    all.back().value_unit = "N/m";
    all.back().value = [i](const Structure& s, double x) {
      return (1 + x) * fem::storey_stiffness(s.beam().segments[i]);
    };
  }
  all.push_back(chain_cause("floor_mass", 0.05, [](Beam& changed, double factor) {
    for (fem::Body& floor : changed.bodies) floor.mass *= factor;
  }));
  all.back().weighs_all = true;
  for (std::size_t i = 0; !single && !many && i < chain.bodies.size(); ++i) {
    all.push_back(chain_cause(fmt::format("floor_mass_{}", i + 1), 0.2,
                              [i](Beam& changed, double factor) { changed.bodies[i].mass *= factor; }));
    all.back().exchangeable = true;
    all.back().value_unit = "kg";
    all.back().value = [i](const Structure& s, double x) { return (1 + x) * s.beam().bodies[i].mass; };
  }
  return all;
}

std::vector<Candidate> system_candidates(const MatrixSystem& system) {
  std::vector<Candidate> all;
  all.push_back(system_cause("stiffness", 0.15, [](MatrixSystem& changed, double factor) {
    changed.stiffness *= factor;
    for (MatrixSystem::Parameter& one : changed.parameters) one.stiffness *= factor;
  }));
  all.push_back(system_cause("mass", 0.05, [](MatrixSystem& changed, double factor) {
    changed.mass *= factor;
    for (MatrixSystem::Parameter& one : changed.parameters) one.mass *= factor;
  }));
  all.back().weighs_all = true;
  for (std::size_t j = 0; j < system.parameters.size(); ++j) {
    if (system.parameters[j].value == 0.0) continue;  // it has no relative change
    all.push_back(system_cause(system.parameters[j].name, 0.3, [j](MatrixSystem& changed, double factor) {
      changed.parameters[j].value *= factor;
    }));
    all.back().label = "parameter " + system.parameters[j].name;
    all.back().value_unit = "";
    all.back().value = [j](const Structure& s, double x) {
      return (1 + x) * s.matrices()->parameters[j].value;
    };
  }
  return all;
}

}  // namespace beamid::experiments
