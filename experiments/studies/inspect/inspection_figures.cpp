#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/results/figure.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd figure_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void add_panels(const Inspection& found, const InspectedChannel& channel, Figure& figure) {
  const VectorXd time = figure_vector(found.time), samples = figure_vector(channel.samples);
  const std::string unit = channel.unit.empty() ? "" : " [" + channel.unit + "]";
  Panel history{"", {found.has_time ? "time [s]" : "sample"}, {title(channel) + unit}};
  history.line("", time, samples, Colour::blue).across(time[0], time[time.size() - 1]).key(Legend::none);
  if (!channel.events.empty() && !spiky(channel)) {
    VectorXd at(channel.events.size()), value(channel.events.size());
    for (Index k = 0; k < at.size(); ++k) {
      const SignalEvent& event = channel.events[static_cast<std::size_t>(k)];
      at[k] = time[event.sample], value[k] = channel.offset + event.size;
    }
    history.open_points("event", at, value, Colour::vermillion);
  }
  figure.panels.push_back(thinned(std::move(history)));

  VectorXd filled = samples;
  for (Index k = 0; k < filled.size(); ++k)
    if (!std::isfinite(filled[k])) filled[k] = channel.offset;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  Panel spectrum = spectrum_panel({{"", filled}}, interval > 0 ? interval : 1.0, title(channel) + unit)
                       .value_or(Panel{"", {"frequency [Hz]"}, {"no motion"}});
  if (!found.has_time) spectrum.x_axis.label = "frequency [1/sample]";
  figure.panels.push_back(thinned(std::move(spectrum)));
}

}  // namespace

std::vector<Figure> inspection_figures(const Inspection& found) {
  constexpr std::size_t rows = 4;
  std::vector<Figure> all;
  std::vector<const InspectedChannel*> shown;
  for (const InspectedChannel& channel : found.channels)
    if (channel.greatest > channel.least && found.time.size() >= 16) shown.push_back(&channel);
  for (std::size_t first = 0; first < shown.size(); first += rows) {
    const std::size_t count = std::min(rows, shown.size() - first);
    Figure figure{
        first == 0 ? "record" : fmt::format("record_{}", first / rows + 1), {}, static_cast<int>(count), 2};
    figure.width = 1000;
    figure.caption = "The channels as the file holds them, and their amplitude spectra.";
    for (std::size_t k = 0; k < count; ++k) add_panels(found, *shown[first + k], figure);
    all.push_back(std::move(figure));
  }
  return all;
}

Table channel_table(const Inspection& found) {
  Table table{"channels", "Channels"};
  table.column({"column", "column", "{:.0f}"})
      .column({"name", "name"})
      .column({"unit", "unit"})
      .column({"least", "least", "{:.4g}"})
      .column({"greatest", "greatest", "{:.4g}"})
      .column({"offset", "offset", "{:.3g}"})
      .column({"drift", "drift", "{:.2g}"})
      .column({"noise", "noise", "{:.2g}"})
      .column({"SNR [dB]", "signal_to_noise_db", "{:.1f}"})
      .column({found.has_time ? "f [Hz]" : "f [1/sample]", "frequency_hz", "{:.4g}"})
      .column({"events", "events", "{:.0f}"});
  for (const InspectedChannel& c : found.channels) {
    const double none = std::nan("");
    table.row({static_cast<double>(c.column), title(c), unit_text(c), c.least, c.greatest, c.offset, c.drift,
               c.noise, c.defects.dead ? none : c.signal_to_noise_db,
               c.frequency_hz > 0 ? c.frequency_hz : none, static_cast<double>(c.events.size())});
  }
  table.note =
      "Offset: the median. Drift: change of a fitted line over the record. Noise: standard deviation of the "
      "broadband part in the quietest quarter of the record. f: the strongest frequency.";
  return table;
}

Table event_table(const Inspection& found) {
  constexpr std::size_t most = 20;
  Table table{"events", "Events"};
  table.column({"channel", "channel"})
      .column({found.has_time ? "time [s]" : "sample", "time_s", "{:.4f}"})
      .column({"size", "size", "{:.4g}"})
      .column({"unit", "unit"})
      .column({"looks like", "kind"});
  std::size_t left_out = 0;
  for (const InspectedChannel& c : found.channels)
    for (std::size_t k = 0; k < c.events.size() && !spiky(c); ++k) {
      if (k >= most) {
        ++left_out;
        continue;
      }
      const SignalEvent& event = c.events[k];
      table.row({title(c), found.time[static_cast<std::size_t>(event.sample)], event.size, unit_text(c),
                 std::string(event.pulse ? "a pulse: a hit" : "a rise: a hit or a release")});
    }
  if (left_out > 0) table.note = fmt::format("{} more are in results.json.", left_out);
  return table;
}

}  // namespace beamid::experiments
