#include "experiments/studies/continuum/frame_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/config/read_beam.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/studies/continuum/mode_drawing.hpp"
#include "experiments/studies/continuum/mode_trust.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

// With accelerations of the base along all axes as its last inputs.
fem::StructuralSystem assemble_frame(const fem::Structure& structure, int elements_per_member) {
  if (const fem::Frame* const frame = structure.frame()) return fem::assemble(*frame, elements_per_member);
  return fem::assemble(*structure.space_frame(), elements_per_member);
}

std::size_t members_of(const fem::Structure& structure) {
  return structure.frame() ? structure.frame()->members.size() : structure.space_frame()->members.size();
}

fem::MassModel mass_model_of(const fem::Structure& structure) {
  return structure.frame() ? structure.frame()->mass_model : structure.space_frame()->mass_model;
}

// Halving elements divides the error by 16, with lumped mass by 4. Of a mode that has not come to that yet
// less is taken for granted: half an order where both meshes agree to a hundredth, two orders where they do
// not.
VectorXd coarser_mesh_error(const fem::Structure& frame, int elements_per_member, const fem::Modes& fine) {
  const int half = elements_per_member / 2;
  if (half < 1) return VectorXd::Constant(fine.size(), std::nan(""));
  const auto coarse = assemble_frame(frame, half);
  const auto with_mass = std::min(fine.size(), coarse.size());
  const fem::Modes coarse_modes = fem::modes(coarse, with_mass);
  const double ratio = static_cast<double>(elements_per_member) / half;
  const auto error = [&](double order) { return discretisation_error(fine, coarse_modes, ratio, order); };
  const VectorXd careful = error(2.0);
  if (mass_model_of(frame) == fem::MassModel::lumped) return careful;
  constexpr double resolved = 0.01;
  const double difference = ratio * ratio - 1.0;  // of both meshes, for a careful error of 1
  return (careful.array() * difference > resolved).select(careful, error(3.5));
}

Table mode_table(const FrameModes& found) {
  Table table{"modes", ""};
  table.column({"mode", "mode"})
      .column({"f [Hz]", "frequency_hz", "{:.9g}"})
      .column({"mesh error", "discretisation_error_estimate", "{:.0e}"})
      .column({"digits", "digits", "{:.0f}"});
  const bool spatial = found.axes.size() > 2;  // then percentages alone, or the page would be too narrow
  for (const char axis : found.axes) {
    if (!spatial)
      table.column(
          {fmt::format("effect. mass {} [kg]", axis), fmt::format("effective_mass_{}_kg", axis), "{:.4g}"});
    table.column({fmt::format("{} [%]", axis), fmt::format("effective_mass_{}_percent", axis), "{:.2f}"});
  }
  const VectorXd frequency = found.modes.frequency_hz();
  for (Index i = 0; i < found.modes.size(); ++i) {
    const bool rigid = i < found.modes.rigid;
    std::vector<Cell> cells{fmt::format("{}{}", i + 1, rigid ? " rigid" : ""), frequency[i],
                            found.discretisation_error[i], rigid ? std::nan("") : found.modes.digits(i)};
    for (Index axis = 0; axis < found.effective_mass.cols(); ++axis) {
      const double mass = rounded(found.effective_mass(i, axis), found.total_mass);
      if (!spatial) cells.emplace_back(mass);
      cells.emplace_back(100.0 * mass / found.total_mass);
    }
    table.row(std::move(cells));
  }
  std::string shares;
  for (Index axis = 0; axis < found.effective_mass.cols(); ++axis)
    shares += fmt::format("{}{:.1f}",
                          axis == 0                                 ? ""
                          : axis + 1 == found.effective_mass.cols() ? " and "
                                                                    : ", ",
                          100.0 * found.effective_mass.col(axis).sum() / found.total_mass);
  table.note = fmt::format(
      "mesh error: relative, estimated from half the elements; it falls with h^4, of lumped mass with h^2. "
      "digits: significant digits on which solver and Rayleigh quotient agree. "
      "effect. mass: participating when all supports and springs move along {}, {} % of "
      "{:.6g} kg in these modes.",
      spatial ? "x, y or z" : "x or y", shares, found.total_mass);
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
    Json mode{{"frequency_hz", frequency[i]},
              {"rayleigh_quotient_frequency_hz",
               found.modes.rayleigh_angular_frequency[i] / (2.0 * std::numbers::pi)},
              {"residual", found.modes.residual[i]},
              {"digits", rigid ? Json(nullptr) : Json(found.modes.digits(i))},
              {"rigid", rigid},
              {"discretisation_error_estimate", number_or_null(found.discretisation_error[i])}};
    for (std::size_t axis = 0; axis < found.axes.size(); ++axis)
      mode[fmt::format("effective_mass_{}_kg", found.axes[axis])] =
          found.effective_mass(i, static_cast<Index>(axis));
    json["modes"].push_back(std::move(mode));
  }
  return json;
}

/// What the pictures show; it outlives the report.
// A picture of a million elements shows no more than one of two thousand, and takes a minute.
std::shared_ptr<const ModeDrawing> drawing(const fem::Structure& frame, int elements_per_member,
                                           const FrameModes& found) {
  const int drawn = std::max(1, most_drawn_elements / static_cast<int>(members_of(frame)));
  if (elements_per_member <= drawn)
    return std::make_shared<ModeDrawing>(
        ModeDrawing{frame, found.system, found.modes.shape, found.modes.frequency_hz()});
  fem::StructuralSystem system = assemble_frame(frame, drawn);
  const Eigen::MatrixXd shapes = fem::modes(system, std::min(found.modes.size(), system.size())).shape;
  const VectorXd frequencies = found.modes.frequency_hz().head(shapes.cols());
  return std::make_shared<ModeDrawing>(ModeDrawing{frame, std::move(system), shapes, frequencies});
}

}  // namespace

FrameModes frame_modes(const fem::Structure& frame, int elements_per_member, Index count,
                       const Progress& progress) {
  const bool spatial = frame.space_frame() != nullptr;
  const double times_as_large = spatial ? 2.0 : 1.0;  // as an element in the plane
  require_mesh_memory(times_as_large * static_cast<double>(members_of(frame)) * elements_per_member,
                      static_cast<double>(count));
  FrameModes found;
  progress("assembling");
  found.system = assemble_frame(frame, elements_per_member);
  found.total_mass = total_mass(frame);
  progress("modes");
  found.modes = fem::modes(found.system, std::min(count, found.system.size()));
  found.axes = spatial ? "xyz" : "xy";
  found.effective_mass =
      (found.modes.shape.transpose() * found.system.inputs.rightCols(static_cast<Index>(found.axes.size())))
          .cwiseAbs2();
  progress("modes of half the elements");
  found.discretisation_error = coarser_mesh_error(frame, elements_per_member, found.modes);
  found.notes = accuracy_notes(found.modes);
  if (found.modes.rigid > 0)
    found.notes.push_back(fmt::format("{} rigid-body mode{}: the frame can move without strain.",
                                      found.modes.rigid, found.modes.rigid == 1 ? "" : "s"));
  return found;
}

Results report(const Experiment& experiment, const FrameModes& found, bool surface) {
  Results results =
      begin_modes_report(experiment, found.modes.size(),
                         static_cast<Index>(found.system.mesh.elements.size()), found.system.size());
  results.values = frame_modes_values(found);
  results.table(mode_table(found));
  std::vector<std::string> notes = found.notes;
  const std::shared_ptr<const ModeDrawing> drawn = drawing(experiment.structure, experiment.elements, found);
  if (drawn->system.size() != found.system.size())
    notes.push_back(
        fmt::format("Pictures show the same frame with {} elements.", drawn->system.mesh.elements.size()));
  results.notes(notes);
  draw_modes(drawn, surface, results);
  return results;
}

}  // namespace beamid::experiments
