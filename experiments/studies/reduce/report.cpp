#include "experiments/studies/reduce/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/description.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/file.hpp"
#include "experiments/results/vtk/vtu_file.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
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
        " Released from {:g} m at the {}, the static deflection projected on the modes of each model; seen "
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
  if (drawn) results.attachments.push_back(meshes(experiment, comparison));
  results.timing.emplace_back("mesh_decay", all.behaviour.decay_seconds);
  for (const ComparedReduction& one : all.reductions) {
    results.timing.emplace_back(key_of(one.label) + "_reduce", one.reduce_seconds);
    results.timing.emplace_back(key_of(one.label) + "_decay", one.behaviour.decay_seconds);
  }
  return results;
}

}  // namespace beamid::experiments
