// Tables of the simulated oscillator.
#include <limits>

#include "experiments/studies/paper/report.hpp"

namespace beamid::experiments::paper {
namespace {

constexpr double no_entry = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Table table_2(const Outcome& outcome) {
  Table table{"table_2", "Table 2. Errors on the simulated oscillator: published, and found here"};
  table.column({"discretisation", "discretisation"})
      .column({"published |K| [%]", "published_stiffness_error_percent", "{:.2f}"})
      .column({"published |C| [%]", "published_damping_error_percent", "{:.2f}"})
      .column({"EKF K [%]", "ekf_stiffness_error_percent", "{:+.5g}"})
      .column({"EKF C [%]", "ekf_damping_error_percent", "{:+.5g}"})
      .column({"UKF K [%]", "ukf_stiffness_error_percent", "{:+.5g}"})
      .column({"UKF C [%]", "ukf_damping_error_percent", "{:+.5g}"});
  for (const SchemeOutcome& o : outcome.schemes) {
    const bool published = o.scheme == "forward_euler";
    table.row({o.scheme, published ? published_stiffness_error_percent : no_entry,
               published ? published_damping_error_percent : no_entry,
               stiffness_error(o.ekf.found, outcome.truth), damping_error(o.ekf.found, outcome.truth),
               stiffness_error(o.ukf.found, outcome.truth), damping_error(o.ukf.found, outcome.truth)});
  }
  table.note =
      "K = 515.8 N/m, M = 3.0 kg, damping ratio 10 %, 5 s at 1 kHz, noise-free; displacement and velocity "
      "observed, R = 1e-5 I, P0 = diag(1, 1, 1e5, 1e5), K0 = 300 N/m, C0 = 2 N s/m, released from 1 m (not "
      "printed in the paper).";
  return table;
}

Table bias_table(const Outcome& outcome) {
  Table table{"discretisation_bias", "What the discretisation alone does: closed form, and the filter"};
  table.column({"discretisation", "discretisation"})
      .column({"closed form K [%]", "predicted_stiffness_error_percent", "{:+.8g}"})
      .column({"EKF K [%]", "stiffness_error_percent", "{:+.8g}"})
      .column({"closed form C [%]", "predicted_damping_error_percent", "{:+.8g}"})
      .column({"EKF C [%]", "damping_error_percent", "{:+.8g}"});
  for (const SchemeOutcome& o : outcome.schemes)
    table.row({o.scheme, stiffness_error(o.predicted, outcome.truth),
               stiffness_error(o.displacement_only.found, outcome.truth),
               damping_error(o.predicted, outcome.truth),
               damping_error(o.displacement_only.found, outcome.truth)});
  table.note =
      "As table 2, but displacement alone observed, R = 1e-12 and two passes: no other cause remains.";
  return table;
}

}  // namespace beamid::experiments::paper
