#include "experiments/studies/continuum/modal_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/results/file.hpp"
#include "experiments/studies/continuum/mode_drawing.hpp"
#include "experiments/studies/continuum/mode_trust.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

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
  draw_modes(drawing(experiment, summary), surface, results);
  return results;
}

}  // namespace beamid::experiments
