#include "experiments/studies/track/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "experiments/identify/tracking/tracking.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

// The picture of what was tracked.

using Eigen::Index, Eigen::VectorXd;

constexpr double curve_gap = std::numeric_limits<double>::quiet_NaN();

// A horizontal stroke over each plateau, with gaps between them.
template <class Value>
Curve strokes(const Tracking& found, const char* label, Value value) {
  const auto count = static_cast<Index>(found.plateaus.size());
  Curve curve{label, VectorXd(3 * count), VectorXd(3 * count), CurveStyle::line, {}, {}, Colour::vermillion};
  for (Index i = 0; i < count; ++i) {
    const Plateau& plateau = found.plateaus[static_cast<std::size_t>(i)];
    const double y = value(plateau);
    curve.x.segment(3 * i, 3) << plateau.from, plateau.to, plateau.to;
    curve.y.segment(3 * i, 3) << y, y, curve_gap;
  }
  return curve;
}

// Ticks at the alarms, along the lower edge.
Curve ticks(const Tracking& found, double height) {
  const auto count = static_cast<Index>(found.alarms.size());
  Curve curve{"filter re-initialised",
              VectorXd(count),
              VectorXd::Constant(count, height),
              CurveStyle::points,
              {},
              {},
              Colour::black};
  for (Index i = 0; i < count; ++i) curve.x[i] = found.time[found.alarms[static_cast<std::size_t>(i)]];
  return curve;
}

// Without what is hardly known: where the interval of the damping ratio is wider than three times the ratio
// itself.
VectorXd informed(const Tracking& found, const VectorXd& values) {
  constexpr double widest = 3;
  return (2 * quantile_95 * found.damping_ratio_deviation.array() <
          widest * found.damping_ratio.array().abs())
      .select(values.array(), curve_gap);
}

/// Signal, frequency with its band and the plateaus' means, damping ratio, against time.
Figure tracking_figure(const Tracking& found, const Channel& channel) {
  const double begin = found.time[0], end = found.time[found.time.size() - 1];
  Figure figure{"tracking", {}, 3, 1};
  Panel signal = Panel{"", {"time [s]"}, {axis_label(channel.quantity)}}.line("low-passed", found.time,
                                                                              found.signal, Colour::grey);
  signal.legend = Legend::none;

  const auto known = [&](const VectorXd& values) { return informed(found, values); };
  Panel frequency{"", {"time [s]"}, {"frequency [Hz]"}};
  const VectorXd wide = (quantile_95 * found.frequency_deviation).array().exp();
  frequency
      .band("smoothed, 95 %", found.time, found.frequency_hz.cwiseQuotient(wide),
            found.frequency_hz.cwiseProduct(wide), Colour::blue)
      .line("smoothed", found.time, found.frequency_hz, Colour::blue);
  double low = found.band_hz.first, high = found.band_hz.second;
  if (!found.plateaus.empty()) {
    const auto [least, most] = std::minmax_element(
        found.plateaus.begin(), found.plateaus.end(),
        [](const Plateau& a, const Plateau& b) { return a.frequency_hz < b.frequency_hz; });
    low = std::max(low, 0.93 * least->frequency_hz), high = std::min(high, 1.07 * most->frequency_hz);
    frequency.curves.push_back(
        strokes(found, "mean of a plateau", [](const Plateau& p) { return p.frequency_hz; }));
  }
  if (!found.alarms.empty()) frequency.curves.push_back(ticks(found, low + 0.02 * (high - low)));
  frequency.up(low, high).legend = Legend::none;

  Panel damping{"", {"time [s]"}, {"damping ratio [%]"}};
  const VectorXd half = quantile_95 * found.damping_ratio_deviation;
  damping
      .band("smoothed, 95 %", found.time, known(100 * (found.damping_ratio - half)),
            known(100 * (found.damping_ratio + half)), Colour::blue)
      .line("smoothed", found.time, known(100 * found.damping_ratio), Colour::blue);
  double most = 0.2;
  for (const Plateau& p : found.plateaus) most = std::max(most, 250 * p.damping_ratio);
  damping.up(-0.5 * most, most);
  if (!found.plateaus.empty())
    damping.curves.push_back(
        strokes(found, "mean of a plateau", [](const Plateau& p) { return 100 * p.damping_ratio; }));
  if (!found.alarms.empty()) damping.curves.push_back(ticks(found, -0.47 * most));
  figure.panels = {signal, frequency, damping};
  for (Panel& panel : figure.panels) panel.across(begin, end);
  figure.caption =
      "Signal, frequency and damping ratio in time. Where the record holds no information about the damping "
      "ratio its curve is omitted.";
  return figure;
}

using Json = nlohmann::ordered_json;

Table plateau_table(const Tracking& found) {
  Table table{"plateaus", "Plateaus"};
  table.column({"plateau", "plateau", "{:.0f}"})
      .column({"from [s]", "from_s", "{:.3f}"})
      .column({"to [s]", "to_s", "{:.3f}"})
      .column({"f [Hz]", "frequency_hz"})
      .column({"95 % +-", "frequency_half_interval_hz"})
      .column({"damping ratio [%]", "damping_ratio_percent"})
      .column({"95 % +- ", "damping_ratio_half_interval_percent"})
      .column({"K / K1", "relative_stiffness", "{:.4f}"})
      .column({"modal analysis [Hz]", "modal_frequency_hz", "{:.3f}"})
      .column({"and [%]", "modal_damping_ratio_percent", "{:.3f}"})
      .column({"walk [1/sqrt(s)]", "walk_per_sqrt_s", "{:.2g}"});
  for (std::size_t i = 0; i < found.plateaus.size(); ++i) {
    const Plateau& p = found.plateaus[i];
    const double ratio = p.frequency_hz / found.plateaus.front().frequency_hz;
    const double f = quantile_95 * p.frequency_deviation_hz,
                 d = 100 * quantile_95 * p.damping_ratio_deviation;
    table.row({static_cast<double>(i + 1), p.from, p.to, Rounded{p.frequency_hz, f}, Rounded{f, f},
               Rounded{100 * p.damping_ratio, d}, Rounded{d, d}, ratio * ratio, p.modal_frequency_hz,
               100 * p.modal_damping_ratio, p.walk});
  }
  table.note =
      "Frequency and damping ratio are means over the plateau. Intervals include the drift within it. Where "
      "it exceeds three standard deviations or another mode rings beside, they include the difference from "
      "the "
      "modal analysis, which takes the plateau for a free decay. A damping ratio below zero: the motion "
      "grew. K1 is the stiffness on the "
      "first plateau, the mass being the same.";
  return table;
}

Table change_table(const std::vector<PlateauChange>& between) {
  Table table{"changes", "Changes"};
  table.column({"after [s]", "from_s", "{:.3f}"})
      .column({"before [s]", "to_s", "{:.3f}"})
      .column({"stiffness by [%]", "stiffness_percent"})
      .column({"95 % +- [%]", "stiffness_half_interval_percent"})
      .column({"of", "of"});
  for (const PlateauChange& change : between) {
    const double half = 100 * quantile_95 * change.stiffness_deviation;
    table.row({change.from, change.to, Rounded{100 * change.stiffness, half}, Rounded{half, half},
               std::string(change.of_stiffness() ? "stiffness" : "motion only")});
  }
  return table;
}

Attachment history(const Tracking& found) {
  std::vector<Index> plateau(static_cast<std::size_t>(found.time.size()), 0);
  for (std::size_t i = 0; i < found.plateaus.size(); ++i)
    std::fill(plateau.begin() + found.plateaus[i].first, plateau.begin() + found.plateaus[i].last + 1,
              static_cast<Index>(i + 1));
  std::string text =
      "time_s,signal,frequency_hz,frequency_lower_95_hz,frequency_upper_95_hz,damping_ratio,"
      "damping_ratio_deviation,plateau\n";
  for (Index k = 0; k < found.time.size(); ++k) {
    const double f = found.frequency_hz[k], wide = std::exp(quantile_95 * found.frequency_deviation[k]);
    for (const double value : {found.time[k], found.signal[k], f, f / wide, f * wide, found.damping_ratio[k],
                               found.damping_ratio_deviation[k]})
      text += csv_field(value) + ",";
    text += std::to_string(plateau[static_cast<std::size_t>(k)]) + "\n";
  }
  return {{"history.csv"},
          [text](const std::filesystem::path& folder) { write_file(folder / "history.csv", text); }};
}

// Modes that beat with the one that is followed.
std::string companions(const Tracking& found) {
  std::string list;
  for (std::size_t i = 0; i < found.plateaus.size(); ++i) {
    std::string modes;
    for (const double f : found.plateaus[i].companions_hz)
      modes += fmt::format("{}{:.1f}", modes.empty() ? "" : ", ", f);
    if (!modes.empty()) list += fmt::format("{}{} Hz on plateau {}", list.empty() ? "" : "; ", modes, i + 1);
  }
  if (list.empty()) return {};
  return "Other modes ring beside it: " + list +
         ". The history of frequency and damping ratio shows the beat with them; the mean over a plateau "
         "does not, but for its ends.";
}

Json interval(double estimate, double deviation) {
  return {{"estimate", estimate},
          {"standard_deviation", deviation},
          {"lower_95", estimate - quantile_95 * deviation},
          {"upper_95", estimate + quantile_95 * deviation}};
}

Json tracking_values(const Tracking& found, const std::vector<PlateauChange>& between) {
  Json json{{"band_hz", {found.band_hz.first, found.band_hz.second}},
            {"history_interval_s", found.interval},
            {"noise_si", found.noise},
            {"sway_si", found.sway},
            {"alarm_threshold", found.threshold},
            {"alarm_samples", found.test_samples}};
  json["alarms_s"] = Json::array();
  for (const Index k : found.alarms) json["alarms_s"].push_back(found.time[k]);
  json["plateaus"] = json["changes"] = Json::array();
  for (const Plateau& p : found.plateaus) {
    json["plateaus"].push_back({{"window_s", {p.from, p.to}},
                                {"frequency_hz", interval(p.frequency_hz, p.frequency_deviation_hz)},
                                {"damping_ratio", interval(p.damping_ratio, p.damping_ratio_deviation)},
                                {"modal_frequency_hz", p.modal_frequency_hz},
                                {"modal_damping_ratio", p.modal_damping_ratio},
                                {"companions_hz", p.companions_hz},
                                {"amplitude_si", {p.amplitude_from, p.amplitude_to}},
                                {"noise_si", p.noise},
                                {"walk_per_sqrt_s", p.walk},
                                {"force_si", p.force}});
    Json& noise = json["plateaus"].back()["noise_relative_deviation"];
    if (std::isfinite(p.noise_relative_deviation)) noise = p.noise_relative_deviation;
  }
  for (const PlateauChange& change : between)
    json["changes"].push_back(
        {{"window_s", {change.from, change.to}},
         {"relative_stiffness_change", interval(change.stiffness, change.stiffness_deviation)},
         {"of", change.of_stiffness() ? "stiffness" : "motion"}});
  return json;
}

}  // namespace

bool PlateauChange::of_stiffness() const {
  return std::abs(stiffness) > 3.0 * stiffness_deviation;
}

std::vector<PlateauChange> changes(const Tracking& found) {
  std::vector<PlateauChange> result;
  for (std::size_t i = 1; i < found.plateaus.size(); ++i) {
    const Plateau &before = found.plateaus[i - 1], &after = found.plateaus[i];
    const double ratio = std::pow(after.frequency_hz / before.frequency_hz, 2);
    const double deviation = 2.0 * ratio *
                             std::hypot(after.frequency_deviation_hz / after.frequency_hz,
                                        before.frequency_deviation_hz / before.frequency_hz);
    result.push_back({before.to, after.from, ratio - 1.0, deviation});
  }
  return result;
}

Results report(const TrackSettings& settings, const Record& record, const Channel& channel,
               const std::string& record_name, const Tracking& found) {
  const std::vector<PlateauChange> between = changes(found);
  Results results;
  results.command = "track";
  results.configuration = {{"record", record_name},
                           {"channel", channel.name},
                           {"quantity", to_string(channel.quantity)},
                           {"sampling_rate_hz", 1.0 / record.interval()},
                           {"band_hz", {found.band_hz.first, found.band_hz.second}},
                           {"false_alarms", settings.false_alarms},
                           {"shortest_cycles", settings.shortest_cycles}};
  results.configuration["walk_per_sqrt_s"] = settings.walk ? Json(*settings.walk) : Json("likelihood");
  results.values = tracking_values(found, between);
  results.heading(record_name);
  results.paragraph(
      fmt::format("{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz. One mode from {:.4g} to {:.4g} Hz "
                  "({}) is tracked at {:.1f} Hz. The random walk of its stiffness and damping is {}.",
                  record_name, record.size(), record.time[0], record.time[record.size() - 1],
                  1.0 / record.interval(), found.band_hz.first, found.band_hz.second,
                  settings.band_hz ? "as given" : "from the record", 1.0 / found.interval,
                  settings.walk ? fmt::format("{:g} per square root of a second, as given", *settings.walk)
                                : std::string("the most likely one on each plateau")));
  if (found.sway > 0)
    results.paragraph(
        fmt::format("Below the band the signal sways by {:.2g} {} (root mean square), {:.2g} times the "
                    "noise: that was taken out, with two cycles at each end.",
                    found.sway, si_unit(channel.quantity), found.sway / found.noise));
  results.table(plateau_table(found));
  if (const std::string text = companions(found); !text.empty()) results.paragraph(text);
  for (std::size_t i = 0; i < found.plateaus.size(); ++i)
    if (const std::string& text = found.plateaus[i].one_or_two; !text.empty())
      results.object({"close_modes", text + " Its damping ratio is not determined."},
                     fmt::format("plateau {}: ", i + 1), true);
  if (!found.beat.empty()) results.object({"close_modes", found.beat}, "", true);
  if (!between.empty()) results.table(change_table(between));
  results.paragraph(fmt::format(
      "{} alarms: the squares of {} innovations in succession above {:.1f}, which in a record without "
      "changes and with white noise of {:.3g} {} happens with a probability below {:g}. Alarms nearer to "
      "each other than {:g} cycles belong to one change. During the change history.csv has wide intervals.",
      found.alarms.size(), found.test_samples, found.threshold, found.noise, si_unit(channel.quantity),
      settings.false_alarms, settings.shortest_cycles));
  results.figures.push_back(tracking_figure(found, channel));
  results.attachments.push_back(history(found));
  return results;
}

}  // namespace beamid::experiments
