#include "experiments/identify/engine/identified_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/models/storeys.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

using Eigen::Index;

std::optional<filters::Diagnostics> diagnostics_of(const filters::FilterRun& run,
                                                   const filters::Gaussian& initial,
                                                   const std::vector<Index>& unknowns) {
  constexpr Index fewest = 100;
  const Index reached = run.failure ? run.failure->step : run.normalised_squares.size();
  if (reached < fewest) return std::nullopt;
  return filters::diagnose(run, initial, unknowns);
}

std::string failure_sentences(const std::vector<filters::Failure>& events) {
  constexpr std::size_t listed = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(listed, events.size()); ++i) {
    std::string event = failure_text(events[i]);
    event.front() = 'S';
    text += (i ? " " : "") + event + ".";
  }
  if (events.size() > listed) text += fmt::format(" And {} more events.", events.size() - listed);
  return text;
}

std::string failures_paragraph(const std::vector<filters::Failure>& events) {
  if (events.empty()) return {};
  std::size_t samples = 1;  // events of one sample stand together
  for (std::size_t i = 1; i < events.size(); ++i) samples += events[i].step != events[i - 1].step ? 1 : 0;
  return fmt::format("The filter failed at {} sample{}. --on-failure selects the response. {}", samples,
                     samples == 1 ? "" : "s", failure_sentences(events));
}

std::vector<Parameter> parameters(const RecordIdentification& found) {
  return parameters(found, found.identification);
}

Eigen::Matrix4d covariance_of_parameters(const RecordIdentification& found) {
  const Identification& i = found.identification;
  const double stiffness = i.found.stiffness, mass = i.found.mass;
  Eigen::Matrix<double, 4, 2> slopes;  // of f = sqrt(K/M) / 2 pi, C / (2 sqrt(K M)), K and C
  slopes << 0.5 * i.found.frequency_hz() / stiffness, 0.0,  //
      -0.5 * i.found.damping_ratio() / stiffness, 0.5 / std::sqrt(stiffness * mass), 1, 0, 0, 1;
  const double of_frequency = found.frequency_factor(), of_damping = found.damping_factor();
  slopes = Eigen::Vector4d(of_frequency, of_damping, of_frequency, of_damping).asDiagonal() * slopes;
  return slopes * i.run.last.marginal(2, 2) * slopes.transpose();
}

std::vector<Parameter> parameters(const RecordIdentification& found, const Identification& i) {
  const Oscillator modal = Oscillator::from_frequency(
      i.found.mass, 2.0 * std::numbers::pi * found.modal.frequency_hz, found.modal.damping_ratio);
  const double absent = found.modal_failure.empty() ? 0.0 : std::nan("");
  const double of_frequency = found.frequency_factor(), of_damping = found.damping_factor();
  return {{"frequency [Hz]", "frequency_hz", 1.0, i.found.frequency_hz(),
           of_frequency * i.frequency_deviation_hz, absent + found.modal.frequency_hz},
          {"damping ratio [%]", "damping_ratio", 100.0, i.found.damping_ratio(),
           of_damping * i.damping_ratio_deviation, absent + found.modal.damping_ratio},
          {"stiffness K [N/m]", "stiffness_n_per_m", 1.0, i.found.stiffness,
           of_frequency * i.stiffness_deviation, absent + modal.stiffness},
          {"damping C [N s/m]", "damping_n_s_per_m", 1.0, i.found.damping, of_damping * i.damping_deviation,
           absent + modal.damping}};
}

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
