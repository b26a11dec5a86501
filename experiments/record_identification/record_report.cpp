#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/discretisation_bias.hpp"
#include "experiments/record_identification/record_figures.hpp"
#include "experiments/record_identification/record_values.hpp"

namespace beamid::experiments {
namespace {

// Decimals that show two significant digits of a standard deviation.
int decimals(double deviation) {
  if (!(deviation > 0.0) || !std::isfinite(deviation)) return 6;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(deviation))), 0, 12);
}

Table parameter_table(const RecordIdentification& r) {
  Table table{"parameters", ""};
  table.column({"", "parameter"})
      .column({"estimate", "estimate", "{}"})
      .column({"95 % from", "lower_95", "{}"})
      .column({"to", "upper_95", "{}"})
      .column({"modal analysis", "modal_analysis", "{}"})
      .column({"difference [%]", "difference_percent", "{:+.3f}"});
  for (const Parameter& p : parameters(r)) {
    const int digits = decimals(p.shown * p.deviation);
    const auto shown = [&](double value) { return fmt::format("{:.{}f}", p.shown * value, digits); };
    table.row({p.name, shown(p.estimate), shown(p.lower_95()), shown(p.upper_95()), shown(p.modal),
               percent(p.estimate, p.modal)});
  }
  table.note = fmt::format(
      "Intervals take the mass as known: Meq = {:.4f} kg; a mass wrong by 1 % makes K and C wrong by 1 %. "
      "Modal analysis: eigensystem realisation polished by least squares, without the beam.",
      r.identification.found.mass);
  return table;
}

std::string verdict(const filters::InnovationConsistency& c) {
  if (c.white() && c.size_is_steady()) return "white and of steady size, as they should be";
  const char* what = c.white()            ? "white, but their size changes along the record"
                     : c.size_is_steady() ? "of steady size, but not white"
                                          : "neither white nor of steady size";
  return std::string(what) +
         ". The record then holds motion that the model does not (other modes, damping that depends on "
         "amplitude), and the intervals are a lower limit of the doubt";
}

std::string consistency_text(const RecordIdentification& r) {
  if (!r.consistency) return "The record is too short to test the innovations.";
  const auto& c = *r.consistency;
  return fmt::format(
      "Innovations: mean normalised square {:.3f} (95 % of consistent filters: {:.3f} to {:.3f}), over ten "
      "windows {:.2f} to {:.2f} ({:.2f} to {:.2f}), correlation of successive ones {:+.2f}, Ljung-Box p = "
      "{:.2g}: {}.",
      c.mean_normalised_square, c.lower_95, c.upper_95, c.windows.minCoeff(), c.windows.maxCoeff(),
      c.window_lower_95, c.window_upper_95, c.lag_one_correlation, c.whiteness_p_value, verdict(c));
}

std::string noise_text(const Record& record, const RecordIdentification& r) {
  std::string text = "Noise (standard deviation):";
  for (Eigen::Index i = 0; i < r.noise_deviation.size(); ++i)
    text += fmt::format("{} {} {:.4g} {}", i ? "," : "", to_string(record.channels[i].quantity),
                        r.noise_deviation[i], si_unit(record.channels[i].quantity));
  text += r.noise_from_record ? ", all that the modal analysis leaves of the record." : ", as configured.";
  if (r.interval_factor > 1.0)
    text += fmt::format(" Near the mode it is denser than that: intervals are widened by {:.2f}.",
                        r.interval_factor);
  return text;
}

std::string companion_text(const RecordIdentification& r) {
  std::string text;
  for (const CompanionMode& mode : r.modal.companions)
    text += fmt::format(
        "{}Beside the mode there is another at {:.2f} Hz with {:.0f} % of its amplitude. A model of one "
        "mode takes its decay and beat for damping: trust the modal analysis, which fits both, or a window "
        "where it has died out.",
        text.empty() ? "" : " ", mode.frequency_hz, 100.0 * mode.amplitude / r.modal.amplitude);
  return text;
}

}  // namespace

Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const RecordIdentification& r) {
  Results results;
  results.command = "identify";
  results.configuration = configuration(experiment, record, r, record_name);
  results.values = values(r, record);
  results.heading(experiment.title.empty() ? record_name : experiment.title);
  results.paragraph(fmt::format(
      "{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz. {} on {}, discretisation {}, {} passes.",
      record_name, record.size(), record.time[0], record.time[record.size() - 1], 1.0 / record.interval(),
      experiment.filter.name, experiment.model.name, experiment.discretisation, r.settings.passes));
  if (const auto& failure = r.identification.run.failure) {
    results.paragraph(fmt::format("Diverged at sample {}, {:.4f} s: {} (smallest eigenvalue {:.3g}).",
                                  failure->step, failure->time, failure->reason,
                                  failure->smallest_eigenvalue));
    return results;
  }
  if (lost(r.identification, r.modal.frequency_hz))
    results.paragraph(
        fmt::format("DIVERGED: the filter has lost the motion. Its stiffness or damping is not positive, or "
                    "its frequency is far from "
                    "the {:.4f} Hz of the modal analysis. Look at [prior] and [noise] in the experiment "
                    "file; below is where it ended.",
                    r.modal.frequency_hz));
  results.table(parameter_table(r));
  results.paragraph(consistency_text(r));
  results.paragraph(noise_text(record, r));
  results.paragraph(fmt::format(
      "The finite-element beam as described has its first mode at {:.3f} Hz; the record's is {:+.1f} % "
      "from it.",
      r.beam_frequency_hz, percent(r.identification.found.frequency_hz(), r.beam_frequency_hz)));
  if (const std::string text = companion_text(r); !text.empty()) results.paragraph(text);
  results.figures = figures(record, r);
  return results;
}

}  // namespace beamid::experiments
