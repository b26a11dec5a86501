
#include "experiments/studies/reduce/report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/vtk/vtu_file.hpp"
#include "experiments/text/choice.hpp"
#include "fem/response/frequency_response.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd response_grid(double from, double to, const std::vector<VectorXd>& angular_frequency,
                       const fem::DampingLaw& damping) {
  constexpr int even = 2000, beside = 120;  // points; beside: on each side of a resonance
  constexpr double turn = 2.0 * std::numbers::pi, farthest = 50.0, finest = 0.025;  // half-power half widths
  std::vector<double> grid;
  for (int i = 0; i <= even; ++i) grid.push_back(from * std::pow(to / from, static_cast<double>(i) / even));
  grid.back() = to;
  for (const VectorXd& omega : angular_frequency) {
    const VectorXd ratio = fem::damping_ratios(damping, omega);
    for (Index i = 0; i < omega.size(); ++i) {
      const double peak = omega[i] / turn;
      if (!(ratio[i] > 0.0) || peak < from || peak > to) continue;
      for (int k = -beside; k <= beside; ++k) {
        const double away = std::abs(static_cast<double>(k)) / beside;
        const double widths = finest * std::expm1(away * std::log(farthest / finest));
        const double at = peak * (1.0 + std::copysign(ratio[i] * widths, k));
        if (at > from && at < to) grid.push_back(at);
      }
    }
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return Eigen::Map<const VectorXd>(grid.data(), static_cast<Index>(grid.size()));
}

ResponseDifference compare_magnitudes(const VectorXd& frequency_hz, const VectorXd& full,
                                      const VectorXd& reduced) {
  const Index last = frequency_hz.size() - 1;
  const auto integral = [&](const VectorXd& values) {  // trapezoids
    const VectorXd steps = frequency_hz.tail(last) - frequency_hz.head(last);
    return 0.5 * steps.dot(values.head(last) + values.tail(last));
  };
  ResponseDifference found;
  found.relative = std::sqrt(integral((reduced - full).cwiseAbs2()) / integral(full.cwiseAbs2()));
  found.worst_hz = std::numeric_limits<double>::quiet_NaN();
  for (Index i = 0; i <= last; ++i) {
    const double decibels = 20.0 * std::log10(reduced[i] / full[i]);
    if (!(std::abs(decibels) > std::abs(found.worst_db)) || !std::isfinite(decibels)) continue;
    found.worst_db = decibels;
    found.worst_hz = frequency_hz[i];
  }
  return found;
}

namespace {

constexpr Index most_compared_modes = 200;

double stiffness_at_the_point(const fem::StructuralSystem& system, Index rigid) {
  return rigid > 0 ? std::numeric_limits<double>::quiet_NaN() : fem::static_stiffness(system);
}

// M of M x'' + K x = f for the mode alone, x being the deflection of the point: 1 / (H phi)^2.
double mass_at_the_point(const fem::StructuralSystem& system, const fem::Modes& modes) {
  const Index first = modes.rigid;
  if (first >= modes.size()) return std::numeric_limits<double>::quiet_NaN();
  const VectorXd seen = system.outputs * modes.shape.col(first);
  const double there = seen[0];
  if (std::abs(there) <= 1e-9 * seen.cwiseAbs().maxCoeff()) return std::numeric_limits<double>::quiet_NaN();
  return 1.0 / (there * there);
}

}  // namespace

fem::Modes lowest_modes(const fem::StructuralSystem& system, Index at_least, double below_hz) {
  const Eigen::ArrayXd diagonal = VectorXd(system.mass.diagonal()).array();
  const Index all = (diagonal > 0.0).count();  // a lumped mesh has rotations without inertia
  const Index most = std::min(all, std::max(most_compared_modes, at_least));
  for (Index count = std::min(most, std::max<Index>(at_least, 25));; count = std::min(2 * count, most)) {
    fem::Modes found = fem::modes(system, count);
    if (count == most || found.frequency_hz()[count - 1] >= below_hz) return found;
  }
}

ModelModes lowest_modes(const reduction::ReducedModel& model, Index at_least, double below_hz) {
  ModelModes found{lowest_modes(model.system, at_least, below_hz), {}};
  found.shapes = model.lift(found.modes.shape);
  return found;
}

ModelBehaviour behaviour_of(const fem::StructuralSystem& system, const ModelModes& modes,
                            const fem::SparseMatrix& mass, const fem::DampingLaw& damping,
                            const VectorXd& frequency_hz, const ReleaseTest& test) {
  ModelBehaviour found;
  found.static_stiffness = stiffness_at_the_point(system, modes.modes.rigid);
  found.modal_mass = mass_at_the_point(system, modes.modes);
  const fem::FrequencyResponseMethod method{"modal", modes.modes.size(), true};
  found.receptance = fem::receptance(system, damping, frequency_hz, 0, 0, method).cwiseAbs();
  const auto begin = std::chrono::steady_clock::now();
  found.decay = decay(test, system, modes.modes, modes.shapes, mass);
  found.decay_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

namespace {

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
      all.notes.push_back(names[i] + " is excluded" + (what.starts_with(": ") ? what : ": " + what));
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
        "Cubic springs and quadratic dashpots are omitted: modes are those of small motions.");
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
  if (candidates.empty()) throw std::invalid_argument("no reduction remains to be compared");
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

namespace {

namespace fs = std::filesystem;

// Every mode of a model on one grid, scaled to a largest translation of 1.
void write_modes(const fs::path& file, const Picture& picture, const BeamGrid& grid,
                 const ModelModes& modes) {
  const VectorXd frequency = modes.modes.frequency_hz();
  std::vector<PointArray> arrays;
  for (Index i = 0; i < modes.shapes.cols(); ++i) {
    const NodalMotion motion = scaled_mode(picture.system, modes.shapes.col(i));
    const std::string name = fmt::format("Mode {} ({:.4f} Hz)", i + 1, frequency[i]);
    arrays.push_back({name, translation_of_points(grid, motion)});
    arrays.push_back({name + " rotation", rotation_of_points(grid, motion)});
  }
  write_vtu(file, grid, arrays);
}

Attachment meshes(const Experiment& experiment, const std::shared_ptr<const ReductionComparison>& all) {
  Attachment attachment{{"modes_mesh.vtu"}, {}};
  for (const ComparedReduction& one : all->reductions)
    attachment.files.push_back("modes_" + key_of(one.label) + ".vtu");
  attachment.write = [all, structure = experiment.structure,
                      files = attachment.files](const fs::path& folder) {
    const Picture picture(structure, all->system);
    const BeamGrid grid = beam_grid(picture);
    ModelModes mesh;
    const Index shown = all->modes.modes.rigid + all->compared();
    mesh.modes.angular_frequency = all->modes.modes.angular_frequency.head(shown);
    mesh.shapes = all->modes.shapes.leftCols(shown);
    write_modes(folder / files[0], picture, grid, mesh);
    for (std::size_t i = 0; i < all->reductions.size(); ++i)
      write_modes(folder / files[i + 1], picture, grid, all->reductions[i].modes);
  };
  return attachment;
}

std::string text_of(const ReductionComparison& all) {
  std::string text = fmt::format("Damping: {}{}. Compared at the {}.", fem::name(all.damping),
                                 all.damping_assumed ? ", assumed" : "", all.observed.name);
  if (all.release.samples > 0)
    text += fmt::format(
        " Released from {:g} m at the {}, the static deflection projected on the modes of each model. Seen "
        "for ten periods of mode 1 at {:g} Hz, with the modes below {:g} Hz that such a record can hold.",
        all.release.deflection, all.release.point.name, all.release.sampling_rate_hz, all.release.limit_hz());
  return text;
}

nlohmann::ordered_json reduction_configuration(const Experiment& experiment, const ReductionComparison& all) {
  nlohmann::ordered_json json = describe(experiment);
  json["modes"] = all.settings.modes;
  json["band"] = all.settings.band;
  json["reductions"] = nlohmann::ordered_json::array();
  for (const ComparedReduction& one : all.reductions) json["reductions"].push_back(to_text(one.choice));
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const std::shared_ptr<const ReductionComparison>& comparison) {
  const ReductionComparison& all = *comparison;
  Results results;
  results.command = "reduce";
  results.configuration = reduction_configuration(experiment, all);
  results.values = values(all);
  results.heading(experiment.title.empty() ? "Reductions" : experiment.title);
  results.paragraph(structure_text(experiment, static_cast<Eigen::Index>(all.system.mesh.elements.size()),
                                   all.system.size()));
  results.paragraph(text_of(all));
  results.table(reduction_table(all));
  results.table(equivalent_table(all));
  results.table(frequency_table(all));
  results.table(mac_table(all));
  if (auto table = significance_table(all)) results.table(std::move(*table));
  std::vector<std::string> notes = all.notes;
  const bool has_mesh = !all.system.mesh.nodes.empty();
  const bool drawn = has_mesh && experiment.elements <= most_drawn_elements;
  if (has_mesh && !drawn)
    notes.push_back(fmt::format("Meshes for ParaView are written up to {} elements.", most_drawn_elements));
  results.notes(notes);
  results.figures = figures(all);
  results.attachments.push_back({{"comac.csv"}, [csv = to_csv(comac_table(all))](const fs::path& folder) {
                                   write_file(folder / "comac.csv", csv);
                                 }});
  if (has_mesh)
    results.attachments.push_back(
        {{"modes.glb"}, [comparison, structure = experiment.structure](const fs::path& folder) {
           write_file(folder / "modes.glb", binary_gltf(paired_modes(structure, *comparison)));
         }});
  if (drawn) results.attachments.push_back(meshes(experiment, comparison));
  results.timing.emplace_back("mesh_decay", all.behaviour.decay_seconds);
  for (const ComparedReduction& one : all.reductions) {
    results.timing.emplace_back(key_of(one.label) + "_reduce", one.reduce_seconds);
    results.timing.emplace_back(key_of(one.label) + "_decay", one.behaviour.decay_seconds);
  }
  return results;
}

}  // namespace beamid::experiments
