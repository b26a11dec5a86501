#include "experiments/studies/continuum/modal_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "fem/assembly.hpp"
#include "fem/exact/exact_modes.hpp"
#include "fem/free_decay.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

VectorXd discretisation_error(const fem::Modes& modes, const fem::Modes& halved, const fem::Modes& quartered,
                              double order) {
  constexpr double slowest = 0.75;
  VectorXd error = VectorXd::Constant(modes.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = modes.rigid; i < modes.size(); ++i) {
    const double first = modes.angular_frequency[i] / halved.angular_frequency[i] - 1.0,
                 second = halved.angular_frequency[i] / quartered.angular_frequency[i] - 1.0;
    const double left = first == 0.0 ? 0.0 : std::abs(second / first);
    error[i] = std::max(std::abs(first) / (1.0 - std::clamp(left, std::pow(0.5, order), slowest)),
                        std::abs(first + second));
  }
  return error;
}

VectorXd discretisation_error(const fem::Modes& fine, const fem::Modes& coarse, double ratio, double order) {
  VectorXd error = VectorXd::Constant(fine.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = fine.rigid; i < std::min(fine.size(), coarse.size()); ++i)
    error[i] = std::abs(coarse.angular_frequency[i] / fine.angular_frequency[i] - 1.0) /
               (std::pow(ratio, order) - 1.0);
  return error;
}

std::vector<std::string> accuracy_notes(const fem::Modes& modes) {
  constexpr double enough_digits = 8.0, enough_agreement = 1e-6;
  std::vector<std::string> notes;
  for (Index i = modes.rigid; i < modes.size(); ++i) {
    if (const double digits = modes.digits(i); digits < enough_digits)
      notes.push_back(fmt::format(
          "Mode {}: the frequency of the solver and the Rayleigh quotient of its shape, {:.12g} and {:.12g} "
          "Hz, agree to {:.0f} digits only; trust no more of them.",
          i + 1, modes.frequency_hz()[i], modes.rayleigh_angular_frequency[i] / (2.0 * std::numbers::pi),
          std::floor(digits)));
    if (modes.residual[i] > enough_agreement)
      notes.push_back(
          fmt::format("Mode {}: a residual of {:.1e}; its shape is not accurate.", i + 1, modes.residual[i]));
  }
  return notes;
}

double rounded(double value, double scale) {
  return std::abs(value) < 1e-12 * scale ? 0.0 : value;
}

namespace {

constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();

VectorXd unknowns(Index count) {
  return VectorXd::Constant(count, unknown_value);
}

// From meshes with every element cut in two and in four. What is too large for that is told from half the
// elements, where that is half in every piece: its elements are so short that their order is the known one.
VectorXd mesh_error(const Experiment& experiment, const ModalSummary& summary) {
  constexpr int most_refined = 20000;
  const Index count = summary.modes.size();
  if (!experiment.structure.is_beam()) return unknowns(count);
  const fem::Beam& beam = experiment.structure.beam();
  const double order = beam.mass_model == fem::MassModel::lumped ? 2.0 : 4.0;
  const auto finer = [&](int parts) {
    return fem::modes(fem::assemble_refined(beam, experiment.elements, parts, {summary.observed}), count);
  };
  if (summary.elements <= most_refined) return discretisation_error(summary.modes, finer(2), finer(4), order);
  const auto coarse = fem::assemble(beam, experiment.elements / 2, {summary.observed});
  const auto elements = static_cast<Index>(coarse.mesh.elements.size());
  if (2 * elements != summary.elements) return unknowns(count);
  return discretisation_error(summary.modes, fem::modes(coarse, std::min(count, coarse.size())), 2.0, order);
}

void compare_with_exact(const fem::Beam& beam, ModalSummary& summary) {
  constexpr Index most_places = 2000;  // tell a shape as well as a million
  const VectorXd nodes = summary.system.mesh.positions();
  const Index step = std::max<Index>(1, nodes.size() / most_places),
              places = (nodes.size() + step - 1) / step;
  const auto thinned = [&](const VectorXd& all) { return VectorXd(all(Eigen::seqN(0, places, step))); };
  const auto exact = fem::exact_modes(beam, summary.modes.size(), thinned(nodes));
  if (!exact) return;
  for (Index i = 0; i < summary.modes.size(); ++i) {
    summary.exact_frequency_hz[i] = exact->angular_frequency[i] / (2.0 * std::numbers::pi);
    if (i < summary.modes.rigid) continue;  // any combination of rigid motions is as good as another
    const VectorXd found = thinned(fem::nodal_deflection(summary.system, summary.modes.shape.col(i)));
    const VectorXd known = exact->deflection.col(i);
    summary.mac[i] = std::pow(found.dot(known), 2) / (found.squaredNorm() * known.squaredNorm());
  }
}

void release_shape(ModalSummary& summary) {
  if (summary.modes.rigid > 0) return;  // a force has no static shape
  const fem::StiffnessSolver solver(summary.system.stiffness);
  const VectorXd deflected = solver.solve(VectorXd(summary.system.inputs.col(0)));
  const double there = (summary.system.outputs * deflected)(0);
  summary.static_stiffness = 1.0 / there;
  summary.release_amplitude = fem::modal_amplitudes(summary.system, summary.modes, deflected / there);
}

void add_accuracy_notes(ModalSummary& summary) {
  for (std::string& sentence : accuracy_notes(summary.modes)) summary.notes.push_back(std::move(sentence));
  if (summary.modes.rigid > 0)
    summary.notes.push_back(fmt::format(
        "{} rigid-body mode{}: the beam can move without strain, and has no static shape to be released "
        "from.",
        summary.modes.rigid, summary.modes.rigid == 1 ? "" : "s"));
}

}  // namespace

VectorXd ModalSummary::exact_error() const {
  VectorXd error = unknowns(modes.size());
  for (Index i = modes.rigid; i < modes.size(); ++i)
    error[i] = frequency_hz()[i] / exact_frequency_hz[i] - 1.0;
  return error;
}

ModalSummary summarise_modes(const Experiment& experiment, Index count, const Progress& progress) {
  require_mesh_memory(experiment.elements, static_cast<double>(count));
  ModalSummary summary;
  summary.observed = fem::natural_point(experiment.structure);
  if (const std::string note = small_motion_note(experiment); !note.empty()) summary.notes.push_back(note);
  progress("assembling");
  summary.system = fem::assemble(experiment.structure, experiment.elements, {summary.observed});
  summary.elements = static_cast<Index>(summary.system.mesh.elements.size());
  summary.degrees_of_freedom = summary.system.size();
  summary.total_mass = total_mass(experiment.structure);
  if (count > summary.system.size())
    summary.notes.push_back(fmt::format(
        "{} modes requested; the {} has {} coordinates, and as many modes.{}", count,
        experiment.structure.matrices()
            ? "system"
            : fmt::format("mesh of {} element{}", summary.elements, summary.elements == 1 ? "" : "s"),
        summary.system.size(),
        !experiment.structure.is_beam() || experiment.structure.is_chain() ? ""
                                                                           : " More elements have more."));
  count = std::min(count, summary.system.size());
  progress("modes");
  summary.modes = fem::modes(summary.system, count);
  for (VectorXd* values : {&summary.exact_frequency_hz, &summary.mac, &summary.release_amplitude})
    *values = unknowns(count);
  const VectorXd base = summary.system.inputs.col(summary.system.inputs.cols() - 1);
  summary.effective_mass = (summary.modes.shape.transpose() * base).cwiseAbs2();
  summary.damping_ratio = fem::damping_ratios(experiment.damping, summary.modes.angular_frequency);
  release_shape(summary);
  progress("exact modes");
  if (experiment.structure.is_beam()) compare_with_exact(experiment.structure.beam(), summary);
  if (summary.system.damping.nonZeros() > 0 && summary.modes.rigid == 0) {
    progress("complex modes");
    summary.complex = fem::complex_modes(summary.system, count);
  } else if (summary.system.damping.nonZeros() > 0) {
    summary.notes.emplace_back(
        "What dashpots do to the modes is not worked out for a structure that can move without strain.");
  }
  if (experiment.elements > most_drawn_elements) {  // a million elements take half a gigabyte
    summary.system = {};
    summary.modes.shape.resize(0, 0);
  }
  progress("modes of finer meshes");
  summary.discretisation_error = mesh_error(experiment, summary);
  add_accuracy_notes(summary);
  return summary;
}

}  // namespace beamid::experiments
