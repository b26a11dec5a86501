
#include "experiments/studies/identify/report.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/figure.hpp"

namespace beamid::experiments {
namespace {

// Pictures of an identification: measured against reproduced motion, and convergence with its band.

using Eigen::Index, Eigen::VectorXd;

constexpr const char* reproduced_label = "reproduced with the identified K and C";

Figure reproduction(const Record& record, const RecordIdentification& found, Index row) {
  const Channel& channel = record.channels[static_cast<std::size_t>(row)];
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double cycles = begin + 6.0 / found.identification.found.frequency_hz();
  const std::string label = axis_label(channel.quantity);
  const VectorXd measured = record.samples.row(row), again = found.reproduced.row(row);
  Panel whole = reproduction_panel("the whole window", record.time, measured,
                                   {{reproduced_label, again, Colour::sky}}, label);
  Figure figure{row == 0 ? "reproduction" : fmt::format("reproduction_{}", row + 1), {}, 0, 1};
  if (cycles < 0.8 * end + 0.2 * begin) {  // else both panels would show the same
    Panel first = whole;
    first.title = "first six cycles";
    first.across(begin, cycles).key(Legend::none);
    figure.panels.push_back(thinned(std::move(first)));
  }
  figure.panels.push_back(thinned(std::move(whole)));
  figure.panels.push_back(
      thinned(residual_panel("measured minus reproduced", record.time, measured - again, label)));
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = 60 + 250 * figure.rows;
  figure.caption = fmt::format("Record ({}), free decay with the identified K and C, and the residual.",
                               channel_title(channel));
  return figure;
}

// Of the first channel: what the model leaves out stands alone, higher modes and coloured noise among it.
std::optional<Figure> spectrum(const Record& record, const RecordIdentification& found) {
  constexpr double multiples = 8;  // of the mode's frequency: a cantilever's second mode is at 6.3
  auto panel = spectrum_panel({{"measured", record.samples.row(0).transpose(), Colour::grey},
                               {reproduced_label, found.reproduced.row(0).transpose(), Colour::blue}},
                              record.interval(), axis_label(record.channels[0].quantity));
  if (!panel) return std::nullopt;
  panel->across(0,
                std::min(panel->x_axis.range->second, multiples * found.identification.found.frequency_hz()));
  Figure figure{"spectrum", {thinned(std::move(*panel))}};
  figure.caption = fmt::format("Amplitude spectra of the record ({}) and of its reproduction.",
                               channel_title(record.channels[0]));
  return figure;
}

// Estimate and 95 % band of one quantity over time, in the last pass, with the axis around its final value.
Panel history(const Record& record, const VectorXd& estimate, const VectorXd& deviation, double modal,
              const char* label, double half_range) {
  const VectorXd half = quantile_95 * deviation;
  Panel panel = Panel{"", {"time [s]"}, {label}}
                    .across(record.time[0], record.time[record.size() - 1])
                    .band("95 %, as in the table", record.time, estimate - half, estimate + half)
                    .line("filter", record.time, estimate, Colour::blue);
  if (std::isfinite(modal)) panel.level("modal analysis", modal);
  // the last pass begins with a band of its own, which is to fill the panel
  const double last = estimate[estimate.size() - 1], shown = std::min(half_range, 1.3 * half.maxCoeff());
  return thinned(std::move(panel.up(last - shown, last + shown)));
}

Index samples_traced(const filters::FilterRun& run) {
  return run.failure ? std::min<Index>(run.failure->step, run.means.cols()) : run.means.cols();
}

Figure convergence(const Record& record, const RecordIdentification& found) {
  const filters::FilterRun& run = found.identification.run;  // its traced entries are K and C
  const Index count = samples_traced(run);
  VectorXd frequency(count), frequency_deviation(count), ratio(count), ratio_deviation(count);
  const double frequency_factor = found.frequency_factor(), damping_factor = found.damping_factor();
  for (Index k = 0; k < count; ++k) {
    const Oscillator now{found.identification.found.mass, run.means(0, k), run.means(1, k)};
    frequency[k] = now.frequency_hz();
    frequency_deviation[k] = frequency_factor * 0.5 * frequency[k] * run.deviations(0, k) / now.stiffness;
    ratio[k] = 100.0 * now.damping_ratio();
    ratio_deviation[k] =
        damping_factor * 100.0 * run.deviations(1, k) / (2.0 * std::sqrt(now.stiffness * now.mass));
  }
  const double last_ratio = ratio[count - 1], absent = found.modal_failure.empty() ? 0.0 : std::nan("");
  Figure figure{"convergence", {}, 2, 1};
  figure.panels = {history(record, frequency, frequency_deviation, absent + found.modal.frequency_hz,
                           "frequency [Hz]", 0.02 * frequency[count - 1]),
                   history(record, ratio, ratio_deviation, absent + 100.0 * found.modal.damping_ratio,
                           "damping ratio [%]", std::abs(last_ratio))};
  figure.caption = "Frequency and damping ratio as the filter's last pass goes through the record.";
  return figure;
}

std::vector<Figure> figures(const Record& record, const RecordIdentification& found) {
  std::vector<Figure> result;
  for (Index row = 0; row < found.reproduced.rows(); ++row)
    result.push_back(reproduction(record, found, row));
  if (found.reproduced.size() > 0)
    if (auto shown = spectrum(record, found)) result.push_back(std::move(*shown));
  if (samples_traced(found.identification.run) > 0) result.push_back(convergence(record, found));
  return result;
}

// Of one mode without a mass: frequency and damping ratio alone.
constexpr std::size_t without_mass = 2;

Table parameter_table(const Experiment& experiment, const RecordIdentification& found) {
  Table table{"parameters", ""};
  table.column({"", "parameter"})
      .column({"estimate", "estimate", "{}"})
      .column({"95 % from", "lower_95", "{}"})
      .column({"to", "upper_95", "{}"})
      .column({"modal analysis", "modal_analysis", "{}"})
      .column({"difference [%]", "difference_percent", "{:+.3f}"});
  const bool batch = found.batch && found.batch->identification;
  std::vector<Parameter> together;
  if (batch) {
    table.column({"batch estimate", "batch_estimate"})
        .column({"batch 95 % from", "batch_lower_95"})
        .column({"batch to", "batch_upper_95"});
    together = parameters(found, *found.batch->identification);
  }
  for (const Parameter& p : parameters(found)) {
    if (!experiment.mass_is_stated && table.rows() == without_mass) break;
    const auto shown = [&](double value) { return Rounded{p.shown * value, p.shown * p.deviation}; };
    std::vector<Cell> cells{
        p.name,         shown(p.estimate),           shown(p.lower_95()), shown(p.upper_95()),
        shown(p.modal), percent(p.estimate, p.modal)};
    if (batch) {
      const Parameter& b = together[table.rows()];
      for (const double value : {b.estimate, b.lower_95(), b.upper_95()}) cells.emplace_back(shown(value));
    }
    table.row(cells);
  }
  if (!experiment.mass_is_stated) {
    table.note =
        "Stiffness and damping need the mass that moves: --mass KG. Modal analysis: eigensystem realisation "
        "polished by least squares.";
    return table;
  }
  table.note = fmt::format(
      "Intervals take the mass as known: Meq = {:.4f} kg; a mass wrong by 1 % makes K and C wrong by 1 %. "
      "Modal analysis: eigensystem realisation polished by least squares, without the beam.",
      found.identification.found.mass);
  return table;
}

// "the damping ratio from 1.45 to 1.28 %", or what else varies from the first to the last section.
std::string variation_text(const AmplitudeSections& by) {
  const auto ends = [](const SectionTrend& trend, double factor) {
    return fmt::format("from {:.5g} to {:.5g}", factor * trend.values[0],
                       factor * trend.values[trend.values.size() - 1]);
  };
  std::string text;
  if (by.damping.varies()) text = "the damping ratio goes " + ends(by.damping, 100.0) + " %";
  if (by.frequency.varies())
    text += (text.empty() ? "the frequency goes " : ", the frequency ") + ends(by.frequency, 1.0) + " Hz";
  return text;
}

// What the motion is that the model does not have, as far as a test tells.
bool has_second_mode(const RecordIdentification& found) {
  return !found.modal.companions.empty() && found.modal_failure.empty();
}

bool varies_with_amplitude(const RecordIdentification& found) {
  return found.sections.damping.varies() || found.sections.frequency.varies();
}

std::string unmodelled_text(const RecordIdentification& found) {
  const AmplitudeSections& by = found.sections;
  if (varies_with_amplitude(found))
    return fmt::format(
        ". With the amplitude {} (fits in {} sections). The intervals were widened to cover 95 % of the "
        "decay: by {:.3g} (frequency, K) and {:.3g} (damping)",
        variation_text(by), by.sections.size(), found.frequency_factor(), found.damping_factor());
  if (has_second_mode(found)) {
    const double off = std::abs(found.identification.found.damping_ratio() - found.modal.damping_ratio) /
                       (quantile_95 * found.damping_factor() * found.identification.damping_ratio_deviation);
    return fmt::format(
        ". The record holds another mode: the modal analysis, which fits both, differs by {:.2g} of the "
        "interval of the damping ratio",
        off);
  }
  return ". The record contains motion that the model lacks. The intervals include the part near the mode";
}

// White innovations, with neither a second mode nor variation with the amplitude: their size is the noise's.
bool shows_noise_alone(const RecordIdentification& found) {
  return found.consistency->white() && !has_second_mode(found) && !varies_with_amplitude(found);
}

std::string verdict(const RecordIdentification& found) {
  const filters::InnovationConsistency& c = *found.consistency;
  if (c.white() && c.size_is_steady())
    return found.judgement.objections.empty()
               ? "white and stationary: consistent"
               : "white and stationary, as they also are with a wrong discretisation or mass";
  if (c.windows.maxCoeff() < c.window_lower_95)
    return "smaller all along than they should be. The noise assumed is larger than the record's, and the "
           "intervals are too wide";
  if (shows_noise_alone(found)) {
    const double size = c.mean_normalised_square, least = c.windows.minCoeff(), most = c.windows.maxCoeff();
    if (least > c.window_upper_95 && least >= size * c.window_lower_95 && most <= size * c.window_upper_95)
      return fmt::format(
          "white and stationary, but about {:.4g} times too large: the noise {} is too small by a factor of "
          "{:.2g} (its root)",
          size, found.noise_from_record[0] ? "estimated" : "stated", std::sqrt(size));
    if (most <= c.window_upper_95)
      return "white, but smaller than they should be in part of the record. The noise is smaller there than "
             "assumed; unmodelled motion does not show";
  }
  const char* what = c.white()            ? "white, but their size changes along the record"
                     : c.size_is_steady() ? "stationary, but not white"
                                          : "neither white nor stationary";
  return what + unmodelled_text(found);
}

std::string consistency_text(const RecordIdentification& found) {
  if (!found.consistency) return "The record is too short to test the innovations.";
  const auto& c = *found.consistency;
  return fmt::format(
      "Innovations: mean normalised square {:.3f} (95 % of consistent filters: {:.3f} to {:.3f}), over ten "
      "windows {:.2f} to {:.2f} ({:.2f} to {:.2f}), correlation of successive ones {:+.2f}, Ljung-Box p = "
      "{:.2g}: {}.",
      c.mean_normalised_square, c.lower_95, c.upper_95, c.windows.minCoeff(), c.windows.maxCoeff(),
      c.window_lower_95, c.window_upper_95, c.lag_one_correlation, c.whiteness_p_value, verdict(found));
}

std::string noise_source(const RecordIdentification& found, Eigen::Index i) {
  if (!found.noise_from_record[static_cast<std::size_t>(i)]) return "as configured";
  if (found.noise_method == "before_event") return "as before the first event";
  if (found.noise_method == "likelihood") {
    const bool known = found.noise_relative_deviation.size() > 0;
    return known && std::isfinite(found.noise_relative_deviation[i])
               ? fmt::format("the likeliest, known to {:.2g} %", 100 * found.noise_relative_deviation[i])
               : "the likeliest";
  }
  return found.modal_failure.empty() ? "the residual of the modal analysis"
                                     : "the residual of the filter's own motion";
}

std::string batch_text(const RecordIdentification& found) {
  const filters::BatchEstimate& estimate = found.batch->estimate;
  std::string text =
      "Batch: output-error maximum likelihood, all samples at once, without prior; intervals as the "
      "filter's.";
  if (estimate.status != filters::BatchStatus::converged)
    text += " It did not converge: " + estimate.reason + ".";
  return text;
}

std::string noise_text(const Record& record, const RecordIdentification& found) {
  std::string text = "Noise (standard deviation):";
  for (Eigen::Index i = 0; i < found.noise_deviation.size(); ++i)
    text +=
        fmt::format("{} {} {:.4g} {}, {}", i ? ";" : "", to_string(record.channels[i].quantity),
                    found.noise_deviation[i], si_unit(record.channels[i].quantity), noise_source(found, i));
  text += ".";
  const NoiseNearMode& near = found.near_mode;
  const double density = near.deviation / found.noise_deviation[0];
  text += fmt::format(
      " Near the mode the noise density, from {} spectral lines, is {:.2f} times that of white noise of this "
      "level: intervals are {}.",
      near.lines, density,
      found.interval_factor > 1.0 ? fmt::format("widened by {:.2f}", found.interval_factor) : "the filter's");
  constexpr double few = 10;
  if (near.freedom < few)
    text += fmt::format(
        " That is few: the density is known to {:.0f} % only, and a longer record would have shorter "
        "intervals, better known.",
        100.0 * std::sqrt(2.0 / near.freedom));
  return text;
}

// "is 1.3 % higher"
std::string difference_words(double percent_off) {
  constexpr double printed = 0.05;
  if (std::abs(percent_off) < printed) return "agrees within 0.05 %";
  return fmt::format("is {:.1f} % {}", std::abs(percent_off), percent_off > 0 ? "higher" : "lower");
}

std::string companion_text(const RecordIdentification& found) {
  std::string text;
  for (const CompanionMode& mode : found.modal.companions)
    text += fmt::format(
        "{}Beside the mode there is another at {:.2f} Hz with {:.0f} % of its amplitude. A model of one "
        "mode takes its decay and beat for damping: trust the modal analysis, which fits both, or a window "
        "where it has died out.",
        text.empty() ? "" : " ", mode.frequency_hz, 100.0 * mode.amplitude / found.modal.amplitude);
  return text;
}

}  // namespace

Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const RecordIdentification& found) {
  Results results;
  results.command = "identify";
  results.configuration = configuration(experiment, record, found, record_name);
  results.values = values(found, record);
  if (!experiment.is_described) results.values.erase("beam_frequency_hz");
  if (!experiment.mass_is_stated)
    for (const char* key : {"stiffness_n_per_m", "damping_n_s_per_m", "equivalent_mass_kg", "covariance"})
      results.values.erase(key);
  const Record placed = with_places(record, experiment);
  results.values["channels"] = channel_values(placed);
  results.heading(experiment.title.empty() ? record_name : experiment.title);
  for (const Objection& one : found.judgement.objections)
    results.object(one, {},
                   found.judgement.verdict != ComparedRun::Status::converged &&
                       &one == &found.judgement.objections.front());
  results.paragraph(fmt::format(
      "{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz. {} on {}, discretisation {}, {} pass{}.",
      record_name, record.size(), record.time[0], record.time[record.size() - 1], 1.0 / record.interval(),
      experiment.filter.name, experiment.model.name, experiment.discretisation, found.passes,
      found.passes == 1 ? "" : "es"));
  if (experiment.is_described &&
      (record.channels.size() > 1 || !experiment.structure.has_positions() ||
       *placed.channels[0].position != fem::natural_point(experiment.structure).position))
    results.paragraph("Stiffness, damping and mass are those of the motion at the first channel. Channels: " +
                      channels_text(placed) + ".");
  if (found.identification.run.failure) return results;
  if (!TerminalOnly::holds())
    results.arrays = {{"", "innovations", found.identification.run.innovations},
                      {"", "reproduced", found.reproduced},
                      {"", "time_s", record.time.transpose()}};
  results.table(parameter_table(experiment, found));
  if (found.batch) results.paragraph(batch_text(found));
  results.notes(found.remarks);
  const bool consistent =
      found.consistency && found.consistency->white() && found.consistency->size_is_steady();
  if (consistent || !found.consistency)
    results.paragraph(consistency_text(found));
  else
    results.limitation(consistency_text(found));
  const std::vector<std::string> names = record.channel_names();
  if (found.diagnostics) results.paragraph(words(*found.diagnostics, names));
  if (const std::string text = failures_paragraph(found.identification.run.events); !text.empty())
    results.limitation(text);
  results.paragraph(noise_text(record, found));
  if (experiment.is_described)
    results.paragraph(fmt::format(
        "The finite-element beam as described has its first mode at {:.3f} Hz; the measured frequency {}.",
        found.beam_frequency_hz,
        difference_words(percent(found.identification.found.frequency_hz(), found.beam_frequency_hz))));
  if (const std::string text = companion_text(found); !text.empty()) results.paragraph(text);
  results.draw([&] { return figures(record, found); });
  std::vector<std::string> titles;
  for (const Channel& channel : record.channels) titles.push_back(channel_title(channel));
  if (found.diagnostics) results.draw([&] { return figures(*found.diagnostics, titles); });
  if (!found.smoothed.empty()) {
    const SmoothedRecord smoothed{record.time, found.model, found.identification.run.filtered,
                                  found.smoothed};
    results.figures.push_back(smoothed_figure(smoothed, found.identification.found.frequency_hz()));
    results.attachments.push_back(smoothed_history(smoothed));
  }
  return results;
}

}  // namespace beamid::experiments
