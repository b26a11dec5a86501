// Tables of the five beams.
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/studies/paper/report.hpp"

namespace beamid::experiments::paper {
namespace {

constexpr double not_applicable = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Table table_1(const Outcome& outcome) {
  Table table{"table_1", "Table 1. The five beams: modal analysis of the tip acceleration"};
  table.column({"beam", "beam"})
      .column({"tip mass [kg]", "tip_mass_kg", "{:.4f}"})
      .column({"exact f1 [Hz]", "frequency_hz", "{:.6f}"})
      .column({"f1 [Hz]", "modal_analysis_frequency_hz", "{:.6f}"})
      .column({"assumed xi1 [%]", "assumed_damping_ratio_percent", "{:.3f}"})
      .column({"xi1 [%]", "modal_analysis_damping_ratio_percent", "{:.4f}"})
      .column({"xi1 by decrement [%]", "decrement_damping_ratio_percent", "{:.4f}"});
  for (const BeamOutcome& o : outcome.beams)
    table.row({o.beam.test.name, o.beam.test.tip_mass, o.beam.exact_frequency_hz,
               o.analysis.mode.frequency_hz, 100.0 * o.beam.test.first_damping_ratio,
               100.0 * o.analysis.mode.damping_ratio, 100.0 * o.analysis.decrement.damping_ratio});
  table.note =
      "Damping ratios are assumed (the paper's own table is not available; its text states that all are "
      "below 0.5 %). f1 and xi1: eigensystem realisation polished by least squares; by decrement: "
      "logarithmic "
      "decrement.";
  return table;
}

Table table_3(const Outcome& outcome) {
  Table table{"table_3", "Table 3. Identified parameters of the five beams"};
  table.column({"beam", "beam"})
      .column({"filter", "filter"})
      .column({"K [N/m]", "stiffness_n_per_m", "{:.3f}"})
      .column({"+- [N/m]", "stiffness_standard_deviation_n_per_m", "{:.3f}"})
      .column({"C [N s/m]", "damping_n_s_per_m", "{:.5f}"})
      .column({"+- [N s/m]", "damping_standard_deviation_n_s_per_m", "{:.5f}"})
      .column({"xi [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"error K [%]", "stiffness_error_percent", "{:+.4f}"})
      .column({"error C [%]", "damping_error_percent", "{:+.3f}"});
  for (const BeamOutcome& o : outcome.beams) {
    const Oscillator& reference = o.beam.reference;
    table.row({o.beam.test.name, "reference", reference.stiffness, not_applicable, reference.damping,
               not_applicable, 100.0 * reference.damping_ratio(), not_applicable, not_applicable});
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const Identification& found = o.identified[i];
      table.row({o.beam.test.name, variants[i].label, found.found.stiffness, found.stiffness_deviation,
                 found.found.damping, found.damping_deviation, 100.0 * found.found.damping_ratio(),
                 stiffness_error(found.found, reference), damping_error(found.found, reference)});
    }
  }
  table.note =
      "Reference: Rayleigh's mass (static shape) with the exact first mode, K = Meq w1^2, C = 2 xi1 w1 "
      "Meq. +-: one standard deviation as the filter reports it; on integrated channels, whose noise is "
      "coloured, it is only a rough guide (the trials below show the real spread).";
  return table;
}

Table table_4(const Outcome& outcome) {
  Table table{"table_4", "Table 4. K/M of the filters against w^2 of the modal analysis"};
  table.column({"beam", "beam"}).column({"w^2 [rad2/s2]", "angular_frequency_squared_rad2_per_s2", "{:.4f}"});
  const char* keys[] = {"ekf_forward_euler", "ekf_exponential", "ukf_forward_euler", "ukf_exponential"};
  for (std::size_t i = 0; i < variants.size(); ++i)
    table.column(
        {std::string(variants[i].label) + " [rad2/s2]", std::string(keys[i]) + "_rad2_per_s2", "{:.4f}"});
  for (const BeamOutcome& o : outcome.beams) {
    const double omega = 2.0 * std::numbers::pi * o.analysis.mode.frequency_hz;
    std::vector<Cell> row{o.beam.test.name, omega * omega};
    for (const Identification& found : o.identified)
      row.emplace_back(found.found.stiffness / found.found.mass);
    table.row(row);
  }
  return table;
}

Table table_5(const Outcome& outcome) {
  Table table{"table_5", "Table 5. Error of C against xi sqrt(Meq): the law, and the filters"};
  table.column({"beam", "beam"})
      .column({"xi sqrt(Meq) [kg^1/2]", "damping_ratio_times_root_mass_sqrt_kg", "{:.6f}"})
      .column({"law, forward Euler [%]", "predicted_damping_error_percent", "{:+.3f}"})
      .column({"EKF, forward Euler [%]", "ekf_forward_euler_damping_error_percent", "{:+.3f}"})
      .column({"UKF, forward Euler [%]", "ukf_forward_euler_damping_error_percent", "{:+.3f}"})
      .column({"EKF, exact [%]", "ekf_exponential_damping_error_percent", "{:+.3f}"})
      .column({"UKF, exact [%]", "ukf_exponential_damping_error_percent", "{:+.3f}"});
  for (const BeamOutcome& o : outcome.beams) {
    const Oscillator& reference = o.beam.reference;
    const auto error = [&](std::size_t i) { return damping_error(o.identified[i].found, reference); };
    table.row({o.beam.test.name, reference.damping_ratio() * std::sqrt(reference.mass),
               damping_error(o.predicted[0], reference), error(0), error(2), error(1), error(3)});
  }
  table.note =
      "The law is the closed form's exact value; to first order it is sqrt(K) dt / (2 xi sqrt(Meq)).";
  return table;
}

Table trials_table(const Outcome& outcome) {
  Table table{"trials", "Seeded repetitions against the Cramer-Rao bound (EKF, exact)"};
  table.column({"beam", "beam"})
      .column({"trials", "trials", "{:.0f}"})
      .column({"diverged", "diverged", "{:.0f}"})
      .column({"mean K [%]", "stiffness_mean_error_percent", "{:+.4f}"})
      .column({"mean C [%]", "damping_mean_error_percent", "{:+.4f}"})
      .column({"rms C [%]", "damping_rms_error_percent", "{:.4f}"})
      .column({"bound C [%]", "damping_bound_percent", "{:.4f}"})
      .column({"rms / bound", "damping_bound_ratio", "{:.3f}"});
  for (const BeamOutcome& o : outcome.beams) {
    const TrialStatistics& t = o.trials;
    table.row({o.beam.test.name, static_cast<double>(t.trials), static_cast<double>(t.diverged),
               t.stiffness_mean_percent, t.damping_mean_percent, t.damping_rms_percent,
               t.damping_bound_percent, t.damping_bound_ratio()});
  }
  table.note =
      "The bound: white noise of 0.05 m/s2 on the acceleration itself, all 25 s, initial state unknown, no "
      "prior. The distance to it is the price of filtering and of the three cycles omitted.";
  return table;
}

Table reduction_table(const Outcome& outcome) {
  Table table{"equivalent_mass", "Rayleigh's equivalent mass and what it costs"};
  table.column({"beam", "beam"})
      .column({"Meq [kg]", "equivalent_mass_kg", "{:.6f}"})
      .column({"3EI/L^3 [N/m]", "static_tip_stiffness_n_per_m", "{:.3f}"})
      .column({"Meq w1^2 [N/m]", "reference_stiffness_n_per_m", "{:.3f}"})
      .column({"difference [%]", "stiffness_difference_percent", "{:+.3f}"});
  for (const BeamOutcome& o : outcome.beams) {
    const double tip_stiffness = steel_beam(o.beam.test).tip_stiffness();
    table.row({o.beam.test.name, o.beam.model.equivalent_mass, tip_stiffness, o.beam.reference.stiffness,
               percent(o.beam.reference.stiffness, tip_stiffness)});
  }
  table.note =
      "From free decay only K/M and C/M can be determined. Rayleigh's mass is too small for the true first "
      "mode; "
      "an identified K is too small against 3EI/L^3 by as much. This is kept apart from the errors above.";
  return table;
}

}  // namespace beamid::experiments::paper
