#include "experiments/identify/engine/true_value.hpp"

#include <cmath>
#include <numbers>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/models/storeys.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {
namespace {

using Eigen::VectorXd;
using Property = fem::BeamParameter::Quantity;

std::optional<double> property(const fem::Structure& structure, const Unknown& unknown, Property which) {
  try {
    return fem::value_of(structure, {which, unknown.region, unknown.name});
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::optional<double> rayleigh_coefficient(const fem::DampingLaw& law, bool of_mass) {
  try {
    const fem::ProportionalDamping found = fem::proportional_coefficients(law);
    return of_mass ? found.mass : found.stiffness;
  } catch (const std::invalid_argument&) {
    return {};
  }
}

}  // namespace

double true_mass(const Experiment& truth, const Record& record, const Choice& reduction,
                 const std::filesystem::path& folder) {
  Experiment alone = truth;
  alone.parameters.clear();
  const fem::StructuralSystem system = reduced(model_setting(alone, record, reduction, folder)).system;
  const double reading = system.size() == 1 ? system.outputs.coeff(0, 0) : 0.0;
  return reading != 0.0 ? system.mass.coeff(0, 0) / (reading * reading) : 0.0;
}

std::optional<double> true_value(const Experiment& truth, double mass, const Unknown& unknown) {
  if (const auto asked = beam_quantity(unknown.quantity)) return property(truth.structure, unknown, *asked);
  if (unknown.quantity == "mass_damping" || unknown.quantity == "stiffness_damping")
    return rayleigh_coefficient(truth.damping, unknown.quantity == "mass_damping");

  if (truth.structure.is_chain())
    if (const auto value =
            law_value(truth.structure.beam(), truth.storey_springs, unknown.quantity, unknown.region))
      return value;

  const int mode = unknown.mode.value_or(1);
  const fem::StructuralSystem system = fem::assemble(truth.structure, truth.elements);
  const fem::Modes modes = fem::modes(system, mode);
  if (unknown.quantity == "frequency") return modes.frequency_hz()[mode - 1];
  const bool hysteretic = std::holds_alternative<fem::StructuralDamping>(truth.damping);
  const double ratio =
      hysteretic ? std::nan("") : fem::damping_ratios(truth.damping, modes.angular_frequency)[mode - 1];
  if (unknown.quantity == "damping_ratio") return ratio;
  const auto oscillator = Oscillator::from_frequency(mass, modes.angular_frequency[0], ratio);
  if (unknown.quantity == "stiffness") return oscillator.stiffness;
  if (unknown.quantity == "damping") return oscillator.damping;
  if (unknown.quantity == "mass") return 1.0 / std::pow((system.outputs * modes.shape.col(0))[0], 2);
  return {};
}

}  // namespace beamid::experiments
