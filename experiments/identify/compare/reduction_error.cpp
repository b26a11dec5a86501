#include "experiments/identify/compare/reduction_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/models/motion/beam_equations.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

// The structure with what the run found of it; absent where it found nothing of it, or what cannot be.
std::optional<fem::Structure> found_structure(const Experiment& experiment, const ComparedRun& run) {
  fem::Structure structure = experiment.structure;
  bool any = false;
  try {
    for (std::size_t j = 0; j < run.unknowns.size() && j < run.parameters.size(); ++j)
      if (const auto quantity = beam_quantity(run.unknowns[j].quantity)) {
        structure = fem::with_value(structure, {*quantity, run.unknowns[j].region, run.unknowns[j].name},
                                    run.parameters[j].estimate.value);
        any = true;
      }
  } catch (const std::invalid_argument&) {
    return {};
  }
  return any ? std::optional(structure) : std::nullopt;
}

// Of its lowest modes, the frequency that is nearest [Hz].
double nearest_frequency(const fem::Structure& structure, int elements, double hz) {
  constexpr Index enough = 8;
  const fem::StructuralSystem system = fem::assemble(structure, elements);
  const Eigen::VectorXd all = fem::modes(system, std::min(enough, system.size())).frequency_hz();
  return *std::min_element(all.begin(), all.end(),
                           [&](double a, double b) { return std::abs(a - hz) < std::abs(b - hz); });
}

}  // namespace

std::string reduction_error(const RunContext& context, const ComparedRun& run) {
  constexpr double surely = 3.0, rounding = 1e-6;
  if (run.reduction == "none" || !run.mode) return {};
  const Experiment& experiment = context.experiment;
  const auto structure = found_structure(experiment, run);
  if (!structure) return {};
  double whole = 0.0;
  try {
    whole = nearest_frequency(*structure, experiment.elements, run.mode->frequency_hz);
  } catch (const std::exception&) {  // a structure without such modes has no such error
    return {};
  }
  const double error = run.mode->frequency_hz / whole - 1.0,
               deviation = run.mode->frequency_deviation_hz / run.mode->frequency_hz;
  if (!(std::abs(error) > std::max(surely * deviation, rounding))) return {};
  return fmt::format(
      "WRONG BY THE REDUCTION: with these parameters the structure has a mode at {:.5g} Hz, and the model "
      "that {} makes of it {:.5g} Hz, {:+.2g} %, {:.2g} standard deviations. Stiffness comes out wrong by "
      "about {:+.2g} %, which no interval here holds. Expected a reduction that keeps the mode, such as "
      "modal_truncation.",
      whole, run.reduction, run.mode->frequency_hz, 100.0 * error, std::abs(error) / deviation,
      100.0 * (1.0 / std::pow(1.0 + error, 2) - 1.0));
}

}  // namespace beamid::experiments
