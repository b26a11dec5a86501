#include "experiments/studies/continuum/modal_summary.hpp"
#include "experiments/config/storey_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/config/read_beam.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/studies/continuum/mode_trust.hpp"
#include "fem/damping.hpp"
#include "fem/exact/exact_modes.hpp"
#include "fem/free_decay.hpp"
#include "fem/refinement.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
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
        "{} modes asked for; the {} has {} coordinates, and as many modes.{}", count,
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
