#include "experiments/studies/reduce/reduction_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "experiments/config/read_reduction.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/studies/reduce/chosen_reductions.hpp"
#include "experiments/studies/reduce/mode_agreement.hpp"
#include "experiments/studies/reduce/response_comparison.hpp"
#include "experiments/text/method_choice.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double unknown_error = std::numeric_limits<double>::quiet_NaN();

fem::DampingLaw damping_in_force(const Experiment& experiment, ReductionComparison& all) {
  constexpr double assumed = 0.005;
  if (!std::holds_alternative<fem::Undamped>(experiment.damping) || all.system.damping.nonZeros() > 0)
    return experiment.damping;
  all.damping_assumed = true;
  all.notes.push_back(
      fmt::format("No damping is described: {:g} % in every mode is assumed.", 100.0 * assumed));
  return fem::ModalDamping{{assumed}};
}

reduction::Training training_of(const Choice& choice, double length, const std::filesystem::path& folder) {
  if (!choice.shape_file.empty()) return read_shape(folder / choice.shape_file, length);
  if (takes_shape(choice))
    throw InputError(choice.place, fmt::format("reduction '{}' is to take a given shape, and none is given; "
                                               "expected shape_file, or --shape-file FILE",
                                               choice.name));
  return {};
}

struct Reduced {
  reduction::Bases bases;
  reduction::ReducedModel model;
};

Reduced reduced_candidate(const Choice& choice, const fem::StructuralSystem& system,
                          const reduction::Training& training) {
  return at_place(choice.place, [&] {
    const auto method = reduction::reduction_registry().make(choice.name, choice.options);
    Reduced found{method->bases(system, training), {}};
    found.model = project(system, found.bases);
    return found;
  });
}

MatrixXd deflections(const fem::StructuralSystem& system, const MatrixXd& shapes) {
  MatrixXd found(system.nodes(), shapes.cols());
  for (Index i = 0; i < shapes.cols(); ++i) found.col(i) = fem::nodal_deflection(system, shapes.col(i));
  return found;
}

// Modes of the mesh against those of the reduced model, rigid ones aside.
void compare_modes(const ReductionComparison& all, const ModelModes& modes, ComparedReduction& one) {
  const Index count = all.compared();
  const MatrixXd full = all.modes.shapes.middleCols(all.modes.modes.rigid, count);
  const MatrixXd reduced_candidate = modes.shapes.rightCols(modes.elastic());
  const MatrixXd agreement = mac(full, reduced_candidate, all.system.mass);
  const MatrixXd full_deflection = deflections(all.system, full),
                 reduced_deflection = deflections(all.system, reduced_candidate);
  const MatrixXd plain = mac(full_deflection, reduced_deflection);
  one.partner = partners(agreement);
  one.frequency_hz = one.frequency_error = one.mac = one.deflection_mac =
      VectorXd::Constant(count, unknown_error);
  std::vector<Index> mine, theirs;
  for (Index i = 0; i < count; ++i) {
    if (reduced_candidate.cols() > 0) one.mac[i] = agreement.row(i).maxCoeff();
    const Index j = one.partner[i];
    if (j < 0) continue;
    one.frequency_hz[i] = modes.modes.frequency_hz()[modes.modes.rigid + j];
    one.frequency_error[i] = one.frequency_hz[i] / all.mode_hz(i) - 1.0;
    one.deflection_mac[i] = plain(i, j);
    mine.push_back(i);
    theirs.push_back(j);
  }
  one.comac = comac(full_deflection(Eigen::all, mine), reduced_deflection(Eigen::all, theirs));
  const Index kept = std::min(modes.modes.size(), count + modes.modes.rigid);
  one.modes.modes.rigid = modes.modes.rigid;
  one.modes.modes.angular_frequency = modes.modes.angular_frequency.head(kept);
  one.modes.shapes = modes.shapes.leftCols(kept);
}

double relative_error(const VectorXd& found, const VectorXd& known) {
  return known.size() > 0 ? (found - known).norm() / known.norm() : unknown_error;
}

// Without any damping resonances are infinite, and so is every difference about them.
bool is_undamped(const ReductionComparison& all) {
  const VectorXd elastic = all.modes.modes.angular_frequency.tail(all.modes.elastic());
  return all.system.damping.nonZeros() == 0 && fem::damping_ratios(all.damping, elastic).maxCoeff() == 0.0;
}

void compare_behaviour(const ReductionComparison& all, ComparedReduction& one) {
  const ModelBehaviour &full = all.behaviour, &reduced_candidate = one.behaviour;
  one.static_stiffness_error = reduced_candidate.static_stiffness / full.static_stiffness - 1.0;
  one.modal_mass_error = reduced_candidate.modal_mass / full.modal_mass - 1.0;
  const ResponseDifference difference =
      is_undamped(all) ? ResponseDifference{unknown_error, unknown_error, unknown_error}
                       : compare_magnitudes(all.frequency_hz, full.receptance, reduced_candidate.receptance);
  one.response_error = difference.relative;
  one.worst_response = difference.worst_db;
  one.worst_response_hz = difference.worst_hz;
  one.displacement_error = relative_error(reduced_candidate.decay.displacement, full.decay.displacement);
  one.acceleration_error = relative_error(reduced_candidate.decay.acceleration, full.decay.acceleration);
}

struct ReductionCandidate {
  ComparedReduction one;
  fem::StructuralSystem system;
  ModelModes modes;
};

std::vector<ReductionCandidate> reduce_all(const Experiment& experiment, const std::vector<Choice>& choices,
                                           const std::filesystem::path& folder, double below_hz,
                                           const Progress& progress, ReductionComparison& all) {
  std::vector<ReductionCandidate> candidates;
  const std::vector<std::string> names = labels(choices);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Choice& choice = choices[i];
    progress(names[i]);
    const reduction::Training training = training_of(choice, experiment.structure.extent(), folder);
    ReductionCandidate candidate;
    try {
      const auto begin = std::chrono::steady_clock::now();
      Reduced found = reduced_candidate(choice, all.system, training);
      candidate.one.reduce_seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      candidate.one.size = found.model.system.size();
      candidate.one.identity = found.model.identity;
      candidate.one.significance = std::move(found.bases.significance);
      candidate.one.significance_name = std::move(found.bases.significance_name);
      candidate.modes = lowest_modes(found.model, all.compared(), below_hz);
      candidate.system = std::move(found.model.system);
    } catch (const std::runtime_error& error) {
      if (!choice.place.file.empty()) throw;
      const std::string what = error.what();
      all.notes.push_back(names[i] + " is left out" + (what.starts_with(": ") ? what : ": " + what));
      continue;
    }
    candidate.one.choice = choice;
    candidate.one.label = names[i];
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

}  // namespace

Index ReductionComparison::compared() const {
  return std::min<Index>(settings.modes, modes.elastic());
}

ReductionComparison compare_reductions(const Experiment& experiment, const std::vector<Choice>& choices,
                                       const ReductionComparisonSettings& settings,
                                       const std::filesystem::path& folder, const Progress& progress) {
  ReductionComparison all;
  all.settings = settings;
  StructurePoints points(experiment.structure);
  all.observed = points[points.add({})];
  const Index pulled = experiment.excitation.kind == Excitation::Kind::release
                           ? points.add(experiment.excitation.position, experiment.excitation.at)
                           : points.add({});
  progress("assembling");
  all.system = fem::assemble(experiment.structure, experiment.elements, points.all());
  if (!all.system.nonlinear_forces.empty()) {
    all.system.nonlinear_forces.clear();
    all.notes.emplace_back(
        "Cubic springs and quadratic dashpots are left out: modes are those of small motions.");
  }
  all.damping = damping_in_force(experiment, all);
  progress("modes of the mesh");
  all.modes.modes = lowest_modes(all.system, 5, 0.0);
  if (all.modes.elastic() < 1)
    throw std::invalid_argument("the mesh has no mode with strain; expected more elements");
  const double first_hz = all.mode_hz(0);
  all.release =
      plan_release(experiment, all.damping, all.system, pulled, points[pulled], first_hz, all.notes);
  // Modes three times beyond the band leave their static share alone to be added.
  const double below_hz = std::max(3.0 * settings.band * first_hz, all.release.limit_hz());
  all.modes.modes = lowest_modes(all.system, all.modes.modes.rigid + settings.modes, below_hz);
  all.modes.shapes = all.modes.modes.shape;

  if (is_undamped(all))
    all.notes.emplace_back(
        "Without damping resonances are infinite: frequency responses are drawn and not compared.");

  std::vector<ReductionCandidate> candidates =
      reduce_all(experiment, choices, folder, below_hz, progress, all);
  if (candidates.empty()) throw std::invalid_argument("no reduction is left to be compared");
  std::vector<VectorXd> resonances{all.modes.modes.angular_frequency};
  for (const ReductionCandidate& candidate : candidates)
    resonances.push_back(candidate.modes.modes.angular_frequency);
  all.frequency_hz = response_grid(first_hz / 5.0, settings.band * first_hz, resonances, all.damping);

  progress("responses of the mesh");
  all.behaviour =
      behaviour_of(all.system, all.modes, all.system.mass, all.damping, all.frequency_hz, all.release);
  for (ReductionCandidate& candidate : candidates) {
    ComparedReduction& one = candidate.one;
    progress("responses of " + one.label);
    one.behaviour = behaviour_of(candidate.system, candidate.modes, all.system.mass, all.damping,
                                 all.frequency_hz, all.release);
    compare_modes(all, candidate.modes, one);
    compare_behaviour(all, one);
    all.reductions.push_back(std::move(one));
  }
  return all;
}

}  // namespace beamid::experiments
