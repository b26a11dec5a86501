#include "experiments/studies/continuum/frame_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/config/read_beam.hpp"
#include "experiments/results/mode_figure.hpp"
#include "experiments/results/vtk/mode_shapes.hpp"
#include "experiments/studies/continuum/mode_trust.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

VectorXd coarser_mesh_error(const FrameExperiment& experiment, const fem::Modes& fine) {
  const int half = experiment.elements_per_member / 2;
  if (half < 1) return VectorXd::Constant(fine.size(), std::nan(""));
  const auto coarse = fem::assemble(experiment.frame, half);
  const auto with_mass = std::min(fine.size(), coarse.size());
  constexpr double order = 2.0;  // of stretching, and of lumped mass
  return discretisation_error(fine, fem::modes(coarse, with_mass),
                              static_cast<double>(experiment.elements_per_member) / half, order);
}

Table mode_table(const FrameModes& found) {
  Table table{"modes", ""};
  table.column({"mode", "mode"})
      .column({"f [Hz]", "frequency_hz", "{:.9g}"})
      .column({"mesh error", "discretisation_error_estimate", "{:.0e}"})
      .column({"digits", "digits", "{:.0f}"})
      .column({"effect. mass x [kg]", "effective_mass_x_kg", "{:.4g}"})
      .column({"x [%]", "effective_mass_x_percent", "{:.2f}"})
      .column({"effect. mass y [kg]", "effective_mass_y_kg", "{:.4g}"})
      .column({"y [%]", "effective_mass_y_percent", "{:.2f}"});
  const VectorXd frequency = found.modes.frequency_hz();
  for (Index i = 0; i < found.modes.size(); ++i) {
    const bool rigid = i < found.modes.rigid;
    const double x = rounded(found.effective_mass_x[i], found.total_mass),
                 y = rounded(found.effective_mass_y[i], found.total_mass);
    table.row({fmt::format("{}{}", i + 1, rigid ? " rigid" : ""), frequency[i], found.discretisation_error[i],
               rigid ? std::nan("") : found.modes.digits(i), x, 100.0 * x / found.total_mass, y,
               100.0 * y / found.total_mass});
  }
  table.note = fmt::format(
      "mesh error: relative, estimated from half the elements assuming convergence with h^2; for modes of "
      "pure bending a fifth of it. digits: significant digits on which solver and Rayleigh quotient agree. "
      "effect. mass: participating when all supports and springs move along x or y, {:.1f} and {:.1f} % of "
      "{:.6g} kg in these modes.",
      100.0 * found.effective_mass_x.sum() / found.total_mass,
      100.0 * found.effective_mass_y.sum() / found.total_mass, found.total_mass);
  return table;
}

Json frame_modes_values(const FrameModes& found) {
  Json json{{"elements", found.system.mesh.elements.size()},
            {"degrees_of_freedom", found.system.size()},
            {"total_mass_kg", found.total_mass},
            {"modes", Json::array()}};
  const VectorXd frequency = found.modes.frequency_hz();
  for (Index i = 0; i < found.modes.size(); ++i) {
    const bool rigid = i < found.modes.rigid;
    json["modes"].push_back({{"frequency_hz", frequency[i]},
                             {"rayleigh_quotient_frequency_hz",
                              found.modes.rayleigh_angular_frequency[i] / (2.0 * std::numbers::pi)},
                             {"residual", found.modes.residual[i]},
                             {"digits", rigid ? Json(nullptr) : Json(found.modes.digits(i))},
                             {"rigid", rigid},
                             {"discretisation_error_estimate", number_or_null(found.discretisation_error[i])},
                             {"effective_mass_x_kg", found.effective_mass_x[i]},
                             {"effective_mass_y_kg", found.effective_mass_y[i]}});
  }
  return json;
}

/// What the pictures show; it outlives the report.
struct FrameDrawing {
  fem::StructuralSystem system;
  Eigen::MatrixXd shapes;
  VectorXd frequencies_hz;
};

// A picture of a million elements shows no more than one of two thousand, and takes a minute.
std::shared_ptr<const FrameDrawing> drawing(const FrameExperiment& experiment, const FrameModes& found) {
  const auto members = static_cast<int>(experiment.frame.members.size());
  const int drawn = std::max(1, most_drawn_elements / members);
  if (experiment.elements_per_member <= drawn)
    return std::make_shared<FrameDrawing>(
        FrameDrawing{found.system, found.modes.shape, found.modes.frequency_hz()});
  fem::StructuralSystem system = fem::assemble(experiment.frame, drawn);
  const Eigen::MatrixXd shapes = fem::modes(system, std::min(found.modes.size(), system.size())).shape;
  const VectorXd frequencies = found.modes.frequency_hz().head(shapes.cols());
  return std::make_shared<FrameDrawing>(FrameDrawing{std::move(system), shapes, frequencies});
}

}  // namespace

FrameModes frame_modes(const FrameExperiment& experiment, Index count, const Progress& progress) {
  const auto members = static_cast<double>(experiment.frame.members.size());
  require_mesh_memory(members * experiment.elements_per_member, static_cast<double>(count));
  FrameModes found;
  progress("assembling");
  found.system = fem::assemble(experiment.frame, experiment.elements_per_member);
  found.total_mass = total_mass(experiment.frame);
  progress("modes");
  found.modes = fem::modes(found.system, std::min(count, found.system.size()));
  const Eigen::MatrixXd base =
      found.modes.shape.transpose() * found.system.inputs.rightCols(2);  // accelerations along x and y
  found.effective_mass_x = base.col(0).cwiseAbs2();
  found.effective_mass_y = base.col(1).cwiseAbs2();
  progress("modes of half the elements");
  found.discretisation_error = coarser_mesh_error(experiment, found.modes);
  found.notes = doubts(found.modes);
  if (found.modes.rigid > 0)
    found.notes.push_back(fmt::format("{} rigid-body mode{}: the frame can move without strain.",
                                      found.modes.rigid, found.modes.rigid == 1 ? "" : "s"));
  return found;
}

Results report(const FrameExperiment& experiment, const FrameModes& found) {
  Results results;
  results.command = "frame";
  results.configuration = describe(experiment);
  results.configuration["modes"] = found.modes.size();
  results.values = frame_modes_values(found);
  results.heading(experiment.title.empty() ? "Natural frequencies" : experiment.title);
  results.paragraph(frame_text(experiment, found.system.size()));
  results.table(mode_table(found));
  std::vector<std::string> notes = found.notes;
  const std::shared_ptr<const FrameDrawing> drawn = drawing(experiment, found);
  if (drawn->system.size() != found.system.size())
    notes.push_back(
        fmt::format("Pictures show the same frame with {} elements.", drawn->system.mesh.elements.size()));
  add_notes(results, notes);
  results.figures.push_back(mode_figure(drawn->system, drawn->shapes, drawn->frequencies_hz));
  results.attachments.push_back(
      {mode_shape_files(drawn->shapes.cols()), [drawn](const std::filesystem::path& folder) {
         write_mode_shapes(folder, Picture(drawn->system), drawn->shapes, drawn->frequencies_hz);
       }});
  return results;
}

}  // namespace beamid::experiments
