#include "experiments/studies/compare/clock_report.hpp"

namespace beamid::experiments {

void add_clocks(Results& results, const Comparison& comparison) {
  const std::vector<OwnClock>& clocks = comparison.compared.clocks;
  if (clocks.empty()) return;
  Table table{"clocks", "Channels with a clock of their own"};
  table.column({"channel", "channel"})
      .column({"lag [ms]", "lag_ms", "{:.4f}"})
      .column({"deviation [ms]", "deviation_ms", "{:.2g}"})
      .column({"intervals", "intervals", "{:.2f}"});
  results.values["clocks"] = nlohmann::ordered_json::array();
  const double interval = comparison.analysis.record.interval();
  for (const OwnClock& clock : clocks) {
    const std::string& name =
        comparison.compared.record.channels[static_cast<std::size_t>(clock.channel)].name;
    table.row({name, 1e3 * clock.lag, 1e3 * clock.deviation, clock.lag / interval});
    results.values["clocks"].push_back(
        {{"channel", name}, {"lag_s", clock.lag}, {"standard_deviation_s", clock.deviation}});
  }
  table.note =
      "Behind the other channels; below 0 ahead of them. Found with the parameters, whose deviations allow "
      "for them. The record is used and drawn on one clock.";
  results.table(table);
}

}  // namespace beamid::experiments
