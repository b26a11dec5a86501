#include "experiments/studies/prepare/preparation_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

// A record before and after its preparation.

/// The row of that channel; 0 where all are forces.
Eigen::Index motion_row(const Record& record);

Panel time_panel(const Record& record, const std::string& title, Colour colour) {
  const Eigen::Index row = motion_row(record);
  const Channel& channel = record.channels[static_cast<std::size_t>(row)];
  return Panel{title, {"time [s]"}, {axis_label(channel.quantity)}}
      .line("", record.time, record.samples.row(row).transpose(), colour)
      .across(record.time[0], record.time[record.size() - 1])
      .key(Legend::none);
}

std::optional<Panel> prepared_spectrum(const Record& record, const std::string& label, Colour colour) {
  double interval = 0;
  try {
    interval = even_interval(record);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  const Eigen::Index row = motion_row(record);
  return spectrum_panel({{label, record.samples.row(row).transpose(), colour}}, interval,
                        axis_label(record.channels[static_cast<std::size_t>(row)].quantity), 5);
}

Eigen::Index motion_row(const Record& record) {
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (!is_input(record.channels[i].quantity)) return static_cast<Eigen::Index>(i);
  return 0;
}

/// The first channel that is no force in time, and its spectrum where it is evenly sampled.
Figure preparation_figure(const PreparedRecord& prepared) {
  Figure figure{"before_and_after", {}};
  Panel before = time_panel(prepared.raw, "as the file holds it", Colour::grey),
        after = time_panel(prepared.record, "prepared", Colour::blue);
  auto raw = prepared_spectrum(prepared.raw, "as the file holds it", Colour::grey);
  const auto spectrum = prepared_spectrum(prepared.record, "prepared", Colour::blue);
  const bool alike = before.y_axis.label == after.y_axis.label;
  if (alike) {  // the same quantity: one scale for both
    Extent both;
    for (const Panel* panel : {&before, &after}) both.add(panel->curves[0].y, false);
    const double margin = 0.05 * (both.high - both.low);
    if (!both.empty() && margin > 0)
      for (Panel* panel : {&before, &after}) panel->up(both.low - margin, both.high + margin);
  }
  figure.panels = {before, after};
  if (raw && spectrum && alike) {
    raw->title = "spectra";
    raw->curves.push_back(spectrum->curves[0]);
    raw->legend = Legend::below;
    figure.panels.push_back(*raw);
  } else {
    for (const auto& [panel, title] :
         {std::pair{raw, "spectrum as the file holds it"}, {spectrum, "prepared"}})
      if (panel) {
        figure.panels.push_back(*panel);
        figure.panels.back().title = title;
      }
  }
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = 40 + 250 * figure.rows;
  figure.caption = "The record as the file holds it and as it was prepared, with their amplitude spectra.";
  return figure;
}

using Json = nlohmann::ordered_json;
constexpr double no_reported_value = std::numeric_limits<double>::quiet_NaN();

double in_degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

Json values(const StepCost& cost, const PreparationCost& all) {
  const double damped =
      2 * std::numbers::pi * all.frequency_hz * std::sqrt(1 - all.damping_ratio * all.damping_ratio);
  const auto change = [](const ModalChange& found) -> Json {
    if (std::isnan(found.frequency)) return nullptr;
    return {{"frequency_percent", 100 * found.frequency},
            {"damping_ratio_percent", 100 * found.damping_ratio}};
  };
  Json json{{"gain", cost.gain()},
            {"phase_deg", in_degrees(cost.phase())},
            {"delay_s", -cost.phase() / damped},
            {"exact_when_settled", cost.exact},
            {"transient_begin_s", cost.transient_begin},
            {"transient_end_s", cost.transient_end},
            {"change_settled", change(cost.settled)},
            {"change_of_all", change(cost.whole)}};
  json["decrement_damping_ratio_percent"] =
      std::isnan(cost.decrement_damping) ? Json(nullptr) : Json(100 * cost.decrement_damping);
  return json;
}

std::string first_words(const PreparedRecord& prepared, const std::string& name) {
  const Record &raw = prepared.raw, &left = prepared.record;
  return fmt::format(
      "{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz; prepared: {} from {:.4f} to {:.4f} s at "
      "{:.2f} Hz.",
      name, raw.size(), raw.time[0], raw.time[raw.size() - 1], 1 / raw.interval(), left.size(), left.time[0],
      left.time[left.size() - 1], 1 / left.interval());
}

/// "a clean decay of its dominant mode, 11.2 Hz, ..."; empty where there is no change to tell.
std::string cost_words(const DominantCost& found, const RecordFormat& format) {
  if (!found.cost || std::isnan(found.cost->together.front().whole.frequency)) return "";
  const ModalChange& change = found.cost->together.front().whole;
  return fmt::format(
      "a clean decay of its dominant mode, {:.4g} Hz, all steps together change the frequency by {:+.4f} % "
      "and the damping ratio by {:+.3f} %{}.",
      found.cost->frequency_hz, std::abs(change.frequency) < 5e-7 ? 0 : 100 * change.frequency,
      std::abs(change.damping_ratio) < 5e-6 ? 0 : 100 * change.damping_ratio,
      format.preparation.front().place.file.empty() ? "" : "; `beamid prepare` lists each");
}

/// Evenly sampled stamps are written as such, whatever their file rounded them to; instants at which a sample
/// is missing are left out.
Record written(Record record) {
  if (evenly_sampled(record))
    record.time = Eigen::VectorXd::LinSpaced(record.size(), record.time[0], record.time[record.size() - 1]);
  std::vector<Eigen::Index> whole;
  for (Eigen::Index k = 0; k < record.size(); ++k)
    if (record.samples.col(k).allFinite()) whole.push_back(k);
  record.time = record.time(whole).eval();
  record.samples = record.samples(Eigen::all, whole).eval();
  return record;
}

}  // namespace

DominantCost dominant_cost(const PreparedRecord& prepared, const RecordFormat& format) {
  try {
    const Record record = analysable(prepared.record).record;
    const ModalEstimate mode =
        dominant_mode(record.samples.row(motion_row(record)).transpose(), even_interval(record));
    if (!(mode.damping_ratio > 0 && mode.damping_ratio < 1))
      return {{},
              fmt::format("the dominant mode's damping ratio, {:.3g}, is no decay's", mode.damping_ratio)};
    return {preparation_cost(format.preparation, prepared.raw, mode.frequency_hz, mode.damping_ratio,
                             format.window),
            ""};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

Table cost_table(const PreparationCost& cost) {
  Table table{"preparation", ""};
  table.column({"step", "step"})
      .column({"gain", "gain", "{:.5g}"})
      .column({"phase [deg]", "phase_deg", "{:.2f}"})
      .column({"transients [s]", "transients_s"})
      .column({"settled: f [%]", "settled_frequency_change_percent", "{:+.4f}"})
      .column({"damping [%]", "settled_damping_ratio_change_percent", "{:+.3f}"})
      .column({"whole: f [%]", "frequency_change_percent", "{:+.4f}"})
      .column({"damping [%]", "damping_ratio_change_percent", "{:+.3f}"})
      .column({"decrement [%]", "decrement_damping_ratio_change_percent", "{:+.3f}"});
  const auto add = [&](const StepCost& c, const std::string& name) {
    const double known = c.acts ? 1 : no_reported_value;
    // What would print as -0.0000 is no change.
    const auto percent = [&](double x, double least) { return known * (std::abs(x) < least ? 0 : 100 * x); };
    const std::string ends = c.transient_end > 0
                                 ? fmt::format("{:.3g}, {:.3g}", c.transient_begin, c.transient_end)
                                 : fmt::format("{:.3g}", c.transient_begin);
    table.row({name, known * c.gain(), known * in_degrees(c.phase()), c.acts ? ends : "-",
               percent(c.settled.frequency, 5e-7), percent(c.settled.damping_ratio, 5e-6),
               percent(c.whole.frequency, 5e-7), percent(c.whole.damping_ratio, 5e-6),
               percent(c.decrement_damping, 5e-6)});
  };
  for (std::size_t i = 0; i < cost.steps.size(); ++i)
    add(cost.steps[i], fmt::format("{}. {}", i + 1, cost.steps[i].step));
  for (const StepCost& together : cost.together) add(together, "all: " + together.step);
  table.note = fmt::format(
      "What the steps make of a clean decay at {:.4f} Hz with a damping ratio of {:.4f} %, the mode that "
      "dominates the prepared record, begun abruptly. Gain and phase: closed form. Changes of frequency and "
      "damping ratio: a least-squares fit where transients are below 1e-3 (settled) and over all that "
      "remains (whole), and the logarithmic decrement over the whole.",
      cost.frequency_hz, 100 * cost.damping_ratio);
  return table;
}

Json values(const RecordFormat& format, const DominantCost& found) {
  Json json{{"steps", Json::array()}};
  for (std::size_t i = 0; i < format.preparation.size(); ++i) {
    const Choice& choice = format.preparation[i];
    Json step{{"step", choice.name}};
    for (const auto& [name, value] : choice.options.values())
      std::visit([&, key = name](const auto& v) { step["options"][key] = v; }, value);
    if (found.cost && found.cost->steps[i].acts) step["cost"] = values(found.cost->steps[i], *found.cost);
    json["steps"].push_back(step);
  }
  if (!found.cost) {
    json["no_cost"] = found.reason;
    return json;
  }
  json["frequency_hz"] = found.cost->frequency_hz;
  json["damping_ratio"] = found.cost->damping_ratio;
  for (const StepCost& together : found.cost->together) {
    Json one{{"channel", together.step}};
    one.update(values(together, *found.cost));
    json["together"].push_back(one);
  }
  return json;
}

void lead_with(Results& results, const std::string& record_name, const Record& record) {
  auto& report = results.report;
  const auto says = [](const auto& part, const std::string& text) {
    const auto* said = std::get_if<Paragraph>(&part);
    return said && said->severity != Severity::none && said->text == text;
  };
  const auto leads = [](const auto& part) {
    const auto* said = std::get_if<Paragraph>(&part);
    return std::holds_alternative<Heading>(part) || (said && said->severity > Severity::note);
  };
  for (const Objection& one : record.objections) {
    const std::string text = record_name.empty() ? one.text : record_name + ": " + one.text;
    if (std::any_of(report.begin(), report.end(), [&](const auto& part) { return says(part, text); }))
      continue;
    const auto place = std::find_if_not(report.begin(), report.end(), leads);
    report.insert(place, Paragraph{text, Severity::warning, false, one});
  }
}

namespace {

/// The record's remarks that the report does not hold yet, in one text.
std::string new_remarks(const Results& results, const Record& record) {
  std::string text;
  for (const std::string& remark : record.remarks) {
    const bool printed = std::ranges::any_of(results.report, [&](const auto& part) {
      const auto* paragraph = std::get_if<Paragraph>(&part);
      return paragraph && paragraph->text == remark;
    });
    if (!printed) text += (text.empty() ? "" : " ") + remark;
  }
  return text;
}

}  // namespace

void add_preparation(Results& results, const PreparedRecord& prepared, const RecordFormat& format) {
  lead_with(results, "", prepared.record);
  std::string text = new_remarks(results, prepared.record);
  if (!format.preparation.empty()) {
    const DominantCost found = dominant_cost(prepared, format);
    results.values["preparation"] = values(format, found);
    if (const std::string cost = cost_words(found, format); !cost.empty()) text += " On " + cost;
  }
  if (!text.empty()) results.paragraph("Record: " + text);
}

void add_cost(Results& results, const std::string& record_name, const PreparedRecord& prepared,
              const RecordFormat& format) {
  lead_with(results, record_name, prepared.record);
  std::string text = new_remarks(results, prepared.record);
  if (!text.empty()) results.paragraph(fmt::format("Record {}: {}", record_name, text));
  if (format.preparation.empty()) return;
  const DominantCost found = dominant_cost(prepared, format);
  Json one{{"record", record_name}};
  one.update(values(format, found));
  results.values["preparations"].push_back(std::move(one));
  if (const std::string cost = cost_words(found, format); !cost.empty())
    results.paragraph(fmt::format("{}, prepared: on {}", record_name, cost));
}

Results report(const PreparedRecord& prepared, const RecordFormat& format, const std::string& title,
               const std::string& record_name) {
  Results results;
  results.command = "prepare";
  results.configuration = {{"title", title}, {"record", record_name}};
  if (format.window) results.configuration["window_s"] = {format.window->first, format.window->second};
  results.heading(title.empty() ? record_name : title);
  results.paragraph(first_words(prepared, record_name));
  for (std::size_t i = 0; i < prepared.record.remarks.size(); ++i)
    results.paragraph(fmt::format("{}. {}", i + 1, prepared.record.remarks[i]));
  lead_with(results, "", prepared.record);
  const DominantCost found = dominant_cost(prepared, format);
  results.values["preparation"] = values(format, found);
  results.values["samples"] = prepared.record.size();
  results.values["sampling_rate_hz"] = 1 / prepared.record.interval();
  if (found.cost)
    results.table(cost_table(*found.cost));
  else
    results.paragraph("No cost is given, as there is no mode to give it for: " + found.reason + ".");
  results.figures.push_back(preparation_figure(prepared));
  results.attachments.push_back(
      {{"prepared.csv"}, [record = written(prepared.record)](const std::filesystem::path& folder) {
         write_record(record, folder / "prepared.csv");
       }});
  return results;
}

}  // namespace beamid::experiments
