
#include "experiments/studies/continuum/report.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include "experiments/config/description.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/modal/universal_modes.hpp"
#include "experiments/results/mode_figure.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/results.hpp"
#include "experiments/results/vtk/mode_shapes.hpp"
#include "experiments/results/vtk/nodal_motion.hpp"
#include "experiments/studies/continuum/modal_summary.hpp"
#include "experiments/text/progress.hpp"
#include "fem/modes.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments {
namespace {

// How a report of modes begins, and the pictures it ends with, whatever the structure.

/// What the pictures show; it outlives what was found.
struct ModeDrawing {
  fem::Structure structure;
  fem::StructuralSystem system;
  Eigen::MatrixXd shapes;          ///< (n x k)
  Eigen::VectorXd frequencies_hz;  ///< (k)
};

/// The same for other programs: nodes of the mesh and their translations, largest 1, with the modal mass in
/// that scale.
/// @param damping gives the modes' ratios, dashpots aside; none where the law has fewer than there are modes
NodalModes nodal_modes(const ModeDrawing& drawn, const fem::DampingLaw& damping, const std::string& title) {
  NodalModes modes{title, nodal_places(drawn.system), {}, {}};
  Eigen::VectorXd ratios;
  try {
    ratios = fem::damping_ratios(damping, 2.0 * std::numbers::pi * drawn.frequencies_hz);
  } catch (const std::invalid_argument&) {
    ratios.setConstant(drawn.shapes.cols(), std::nan(""));
  }
  for (const fem::Mesh::Element& element : drawn.system.mesh.elements)
    modes.lines.emplace_back(element.first, element.second);
  for (Eigen::Index m = 0; m < drawn.shapes.cols(); ++m) {
    const Eigen::VectorXd shape = drawn.shapes.col(m);  // phi^T M phi = 1
    const Eigen::Matrix3Xd moved = nodal_motion(drawn.system, shape).translation;
    const double largest = moved.colwise().norm().maxCoeff();
    if (!(largest > 0.0) || !(drawn.frequencies_hz[m] > 0.0)) continue;  // programs want a frequency
    NodalModes::Mode mode{drawn.frequencies_hz[m], {}, {}, 1.0 / (largest * largest), {}};
    if (std::isfinite(ratios[m])) mode.damping_ratio = ratios[m];
    mode.shape = scaled_mode(drawn.system, shape).translation.cast<std::complex<double>>();
    modes.modes.push_back(std::move(mode));
  }
  return modes;
}

/// Configuration, heading and the structure in a sentence. @param modes how many were found
Results begin_modes_report(const Experiment& experiment, Eigen::Index modes, Eigen::Index elements,
                           Eigen::Index coordinates) {
  Results results;
  results.command = "modes";
  results.configuration = describe(experiment);
  results.configuration["modes"] = modes;
  results.heading(experiment.title.empty() ? "Natural frequencies" : experiment.title);
  results.paragraph(structure_text(experiment, elements, coordinates));
  return results;
}

/// The figure mode_shapes, models for viewers and programs of modal analysis, and meshes for ParaView.
/// @param surface draw the real sections instead of lines
void draw_modes(const Experiment& experiment, const std::shared_ptr<const ModeDrawing>& drawn, bool surface,
                Results& results) {
  results.figures.push_back(mode_figure(drawn->system, drawn->shapes, drawn->frequencies_hz));
  results.attachments.push_back({{"modes.glb"}, [drawn](const std::filesystem::path& folder) {
                                   write_file(folder / "modes.glb",
                                              binary_gltf(mode_model(Picture(drawn->structure, drawn->system),
                                                                     drawn->shapes, drawn->frequencies_hz)));
                                 }});
  results.attachments.push_back(
      {{"modes.uff"},
       [drawn, damping = experiment.damping, title = experiment.title](const std::filesystem::path& folder) {
         write_file(folder / "modes.uff", universal_file(nodal_modes(*drawn, damping, title)));
       }});
  results.attachments.push_back(
      {mode_shape_files(drawn->shapes.cols()), [drawn, surface](const std::filesystem::path& folder) {
         write_mode_shapes(folder, Picture(drawn->structure, drawn->system, surface), drawn->shapes,
                           drawn->frequencies_hz);
       }});
}

// What `beamid modes` prints and writes.

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

// Acceleration at the observed point just after the release, per displacement there before it [1/s2].
VectorXd release_acceleration(const ModalSummary& s) {
  return s.release_amplitude.cwiseProduct(s.modes.angular_frequency.cwiseAbs2());
}

// A value as it reads among others.
double rounded_among(double value, const VectorXd& among) {
  return rounded(value, among.cwiseAbs().maxCoeff());
}

Table mode_table(const ModalSummary& s) {
  Table table{"modes", ""};
  table.column({"mode", "mode"})
      .column({"f [Hz]", "frequency_hz", "{:.9g}"})
      .column({"mesh error", "discretisation_error_estimate", "{:.0e}"})
      .column({"exact error", "exact_relative_error", "{:+.0e}"})
      .column({"digits", "digits", "{:.0f}"})
      .column({"effect. mass [kg]", "effective_mass_kg", "{:.4g}"})
      .column({"[%]", "effective_mass_percent", "{:.2f}"})
      .column({"release displ. [%]", "release_displacement_percent", "{:.4g}"})
      .column({"accel. [m/s2 /mm]", "release_acceleration_m_per_s2_per_mm", "{:.4g}"})
      .column({"exact MAC", "mac", "{:.4f}"})
      .column({"damping [%]", "damping_ratio_percent", "{:.4g}"});
  const VectorXd frequency = s.frequency_hz(), error = s.exact_error(),
                 acceleration = release_acceleration(s);
  const VectorXd mass =
      s.effective_mass.unaryExpr([&](double value) { return rounded_among(value, s.effective_mass); });
  for (Index i = 0; i < s.modes.size(); ++i) {
    const bool rigid = i < s.modes.rigid;
    table.row({fmt::format("{}{}", i + 1, rigid ? " rigid" : ""), frequency[i], s.discretisation_error[i],
               error[i], rigid ? std::nan("") : s.modes.digits(i), mass[i], 100.0 * mass[i] / s.total_mass,
               100.0 * rounded_among(s.release_amplitude[i], s.release_amplitude),
               1e-3 * rounded_among(acceleration[i], acceleration), s.mac[i], 100.0 * s.damping_ratio[i]});
  }
  table.note =
      "mesh error: relative, estimated from finer meshes; exact: against the continuum, where its "
      "solution is known. digits: significant digits on which solver and Rayleigh quotient agree. ";
  if (s.total_mass > 0.0)
    table.note +=
        fmt::format("effect. mass: participating when the base moves, {:.1f} % of {:.6g} kg in these modes. ",
                    100.0 * s.effective_mass.sum() / s.total_mass, s.total_mass);
  table.note += fmt::format(
      "release: share of each mode in displacement and acceleration of '{}' after a static deflection there.",
      s.observed.name);
  return table;
}

Table complex_table(const fem::ComplexModes& modes) {
  Table table{"complex_modes", "With the dashpots (complex modes)"};
  table.column({"mode", "mode"})
      .column({"|lambda| / 2 pi [Hz]", "frequency_hz", "{:.9g}"})
      .column({"damped f [Hz]", "damped_frequency_hz", "{:.9g}"})
      .column({"damping [%]", "damping_ratio_percent", "{:.6g}"})
      .column({"residual", "residual", "{:.1e}"});
  for (Index i = 0; i < modes.size(); ++i)
    table.row({fmt::format("{}", i + 1), modes.frequency_hz()[i], modes.damped_frequency_hz()[i],
               100.0 * modes.damping_ratio()[i], modes.residual[i]});
  return table;
}

Json modal_values(const ModalSummary& s) {
  Json json{{"elements", s.elements},
            {"degrees_of_freedom", s.degrees_of_freedom},
            {"total_mass_kg", s.total_mass},
            {"observed_point", {{"name", s.observed.name}, {"position_m", s.observed.position}}},
            {"static_stiffness_n_per_m", number_or_null(s.static_stiffness)},
            {"modes", Json::array()}};
  const VectorXd frequency = s.frequency_hz(), error = s.exact_error(),
                 acceleration = release_acceleration(s);
  for (Index i = 0; i < s.modes.size(); ++i) {
    const bool rigid = i < s.modes.rigid;
    json["modes"].push_back(
        {{"frequency_hz", frequency[i]},
         {"rayleigh_quotient_frequency_hz", s.modes.rayleigh_angular_frequency[i] / (2.0 * std::numbers::pi)},
         {"residual", s.modes.residual[i]},
         {"digits", rigid ? Json(nullptr) : Json(s.modes.digits(i))},
         {"rigid", rigid},
         {"discretisation_error_estimate", number_or_null(s.discretisation_error[i])},
         {"exact_frequency_hz", number_or_null(s.exact_frequency_hz[i])},
         {"exact_relative_error", number_or_null(error[i])},
         {"mac_exact", number_or_null(s.mac[i])},
         {"effective_mass_kg", s.effective_mass[i]},
         {"effective_mass_fraction", s.effective_mass[i] / s.total_mass},
         {"release_displacement_fraction", number_or_null(s.release_amplitude[i])},
         {"release_acceleration_per_displacement_per_s2", number_or_null(acceleration[i])},
         {"damping_ratio", number_or_null(s.damping_ratio[i])}});
  }
  if (!s.complex) return json;
  json["complex_modes"] = Json::array();
  for (Index i = 0; i < s.complex->size(); ++i)
    json["complex_modes"].push_back({{"frequency_hz", s.complex->frequency_hz()[i]},
                                     {"damped_frequency_hz", s.complex->damped_frequency_hz()[i]},
                                     {"damping_ratio", s.complex->damping_ratio()[i]},
                                     {"eigenvalue_real_rad_per_s", s.complex->eigenvalue[i].real()},
                                     {"eigenvalue_imaginary_rad_per_s", s.complex->eigenvalue[i].imag()},
                                     {"residual", s.complex->residual[i]}});
  return json;
}

// Of a structure without a mesh: the unknowns by their labels, phi^T M phi = 1.
Attachment shapes_file(const std::vector<std::string>& labels, const Eigen::MatrixXd& shapes) {
  Table table{"mode_shapes", ""};
  Column unknown{"unknown", "unknown"};
  unknown.cells.assign(labels.begin(), labels.end());
  table.column(unknown);
  for (Index i = 0; i < shapes.cols(); ++i) {
    Column mode{fmt::format("mode {}", i + 1), fmt::format("mode_{}", i + 1)};
    mode.cells.assign(shapes.col(i).begin(), shapes.col(i).end());
    table.column(mode);
  }
  return {{"mode_shapes.csv"}, [csv = to_csv(table)](const std::filesystem::path& folder) {
            write_file(folder / "mode_shapes.csv", csv);
          }};
}

// A picture of a million elements shows no more than one of two thousand, and takes a minute.
std::shared_ptr<const ModeDrawing> drawing(const Experiment& experiment, const ModalSummary& s) {
  if (experiment.elements <= most_drawn_elements)
    return std::make_shared<ModeDrawing>(
        ModeDrawing{experiment.structure, s.system, s.modes.shape, s.frequency_hz()});
  fem::StructuralSystem system = fem::assemble(experiment.structure, most_drawn_elements, {s.observed});
  const Eigen::MatrixXd shapes = fem::modes(system, std::min(s.modes.size(), system.size())).shape;
  const VectorXd frequencies = s.frequency_hz().head(shapes.cols());
  return std::make_shared<ModeDrawing>(
      ModeDrawing{experiment.structure, std::move(system), shapes, frequencies});
}

/// Tables modes and complex_modes, results.json with modes[], the figure mode_shapes, and meshes for
/// ParaView.
/// @param surface draw the real sections instead of a line.
Results report(const Experiment& experiment, const ModalSummary& summary, bool surface) {
  Results results = begin_modes_report(experiment, summary.modes.size(), static_cast<Index>(summary.elements),
                                       summary.degrees_of_freedom);
  results.values = modal_values(summary);
  results.table(mode_table(summary));
  if (summary.complex) results.table(complex_table(*summary.complex));
  std::vector<std::string> notes = summary.notes;
  if (experiment.elements > most_drawn_elements)
    notes.push_back(fmt::format("Pictures show the same beam with {} elements.", most_drawn_elements));
  results.notes(notes);

  if (const fem::MatrixSystem* const matrices = experiment.structure.matrices()) {
    results.attachments.push_back(shapes_file(matrices->labels, summary.modes.shape));
    return results;
  }
  draw_modes(experiment, drawing(experiment, summary), surface, results);
  return results;
}

// The modes of a plane frame or a space frame, how far to trust them, and what `beamid frame` and `beamid
// modes` print and write.

/// All (k).
struct FrameModes {
  fem::StructuralSystem system;
  fem::Modes modes;
  /// Relative, NaN where not known: |f_h - f_2h| / 10.3 / f, whose 10.3 would be 15 for an error of h^4; / 3
  /// with lumped mass, which errs by h^2, and of modes that the coarser mesh does not resolve.
  Eigen::VectorXd discretisation_error;
  std::string axes;  ///< along which it moves, "xy" or "xyz"
  Eigen::MatrixXd
      effective_mass;       ///< (k x axes) (phi^T M r)^2 under a motion of the base, phi^T M phi = 1 [kg]
  double total_mass = 0.0;  ///< [kg]
  std::vector<std::string> notes;  ///< what speaks against them, a sentence each
};

/// @param count of modes, cut to what the mesh has.
/// @throws std::invalid_argument when the frame is impossible; std::runtime_error when its modes are not
/// found.
FrameModes frame_modes(const fem::Structure& frame, int elements_per_member, Eigen::Index count,
                       const Progress& progress);

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

/// Table modes, results.json with modes[], the figure mode_shapes, and meshes for ParaView.
/// @param surface draw the real sections of a space frame instead of lines
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
  draw_modes(experiment, drawn, surface, results);
  return results;
}

}  // namespace

Results modes_study(const Experiment& experiment, Eigen::Index count, bool surface,
                    const Progress& progress) {
  const fem::Structure& structure = experiment.structure;
  if (structure.frame() || structure.space_frame())
    return report(experiment, frame_modes(structure, experiment.elements, count, progress), surface);
  return report(experiment, summarise_modes(experiment, count, progress), surface);
}

}  // namespace beamid::experiments
