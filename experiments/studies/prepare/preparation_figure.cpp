#include "experiments/studies/prepare/preparation_figure.hpp"

#include <optional>
#include <stdexcept>

#include "experiments/record/axis_label.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/signal_panels.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

Eigen::Index motion_row(const Record& record) {
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (!is_input(record.channels[i].quantity)) return static_cast<Eigen::Index>(i);
  return 0;
}

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

}  // namespace beamid::experiments
