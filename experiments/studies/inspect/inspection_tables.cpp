#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/inspect/inspection_report.hpp"

namespace beamid::experiments {

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
      "Offset: the median. Drift: change of a fitted line over the record. Noise: standard deviation of what "
      "is as broad as white noise in the quietest quarter. f: the strongest frequency.";
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
