#include <stdexcept>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/models/motion/beam_equations.hpp"

namespace beamid::experiments {
namespace {

/// Every storey or factor by itself, or the bending stiffness.
std::vector<ParameterChoice> natural_choices(const Experiment& experiment) {
  std::vector<ParameterChoice> choices;
  if (!experiment.structure.is_beam()) {
    for (const std::string& name : fem::factor_names(experiment.structure))
      choices.push_back({"factor", name});
    if (choices.empty())
      throw std::invalid_argument(std::string("the ") + experiment.structure.kind() +
                                  " has no parameter that may be unknown; expected groups of members, or "
                                  "parameters of matrices");
    return choices;
  }
  if (!experiment.structure.is_chain()) return {{"bending_stiffness"}};
  const fem::Beam& chain = experiment.structure.beam();
  double height = 0.0;
  for (const auto& storey : chain.segments) {
    ParameterChoice choice{"storey_stiffness"};
    choice.region = {height, std::min(height + storey.length, chain.length())};
    height += storey.length;
    choices.push_back(choice);
  }
  return choices;
}

bool moves_frequencies(const std::string& quantity) {
  return beam_quantity(quantity) && quantity != "storey_damping";
}

bool is_damping(const std::string& quantity) {
  return quantity == "storey_damping" || quantity == "damping_ratio" || quantity == "mass_damping" ||
         quantity == "stiffness_damping";
}

}  // namespace

AskedParameters asked_parameters(const Experiment& experiment) {
  AskedParameters asked;
  std::vector<ParameterChoice> choices;
  for (const ParameterChoice& choice : experiment.parameters) {
    if (moves_frequencies(choice.quantity)) {
      choices.push_back(choice);
      continue;
    }
    if (!is_damping(choice.quantity))
      refuse(choice, "the structure has no " + choice.quantity +
                         " that modes would depend on; expected a stiffness, a mass or axial_load");
    asked.left_out.push_back(choice.name.empty() ? choice.quantity : choice.name);
  }
  if (choices.empty()) choices = natural_choices(experiment);
  asked.unknowns = unknowns_of(choices, beam_defaults(experiment.structure, choices));
  for (const ParameterChoice& choice : choices) {
    asked.parameters.push_back({*beam_quantity(choice.quantity), choice.region, choice.name});
    asked.has_prior.push_back(choice.deviation || choice.relative_deviation);
  }
  return asked;
}

}  // namespace beamid::experiments
